#!/usr/bin/env python3
"""A person takes over while the cleaner has a goal: the cleaner yields, and reaches its goal afterwards."""

import math
import unittest

import rospy
import rostest
from cleaners import Cleaner, Person, go_to
from simulators import Heard, Simulator, shared

from rumba_msg.msg import CleanGoal, MissionStatus, Outcome


class CleanerTeleopTest(unittest.TestCase):
    """One simulator of the studio and one cleaner; each test begins with the robot on its dock."""

    @classmethod
    def setUpClass(cls):
        fixture = shared(cls)
        cls.cleaner = Cleaner(fixture)
        cls.simulator = Simulator(fixture, '_map:=studio', '_speed:=10')
        cls.cleaner.connect()

    def setUp(self):
        self.simulator.does('reset')
        self.person = Person(self)
        self.truth = Heard(self, '/rumba/ground_truth')
        self.battery = Heard(self, '/rumba/battery_status')

    def yields(self):
        """Wait until the cleaner says that it yields; returns that message."""
        return self.cleaner.status.fresh(lambda message: message.state == MissionStatus.YIELDING)

    def test_a_mission_yields_to_a_person_and_then_goes_on_to_its_target(self):
        goal = self.cleaner.send('clean', CleanGoal(target_coverage=0.15))
        self.battery.fresh(lambda message: not message.brushes_up)
        self.person.press(0.1, 1.0)
        self.assertEqual(self.yields().strategy, 'boustrophedon')
        self.simulator.does('rumba/set_brushes_up', True)
        self.cleaner.commands.messages.clear()
        begin = self.truth.fresh(lambda message: message.twist.twist.angular.z > 0.5).header.stamp
        self.truth.find(lambda message: (message.header.stamp - begin).to_sec() > 10.0)
        self.assertEqual(self.cleaner.commands.messages, [])
        self.assertTrue(self.battery.fresh().brushes_up)
        self.assertEqual(self.cleaner.status.messages[-1].state, MissionStatus.YIELDING)
        self.assertEqual(goal.feedback[-1].mission.state, MissionStatus.YIELDING)
        self.cleaner.status.messages.clear()
        self.person.release()
        self.cleaner.status.find(lambda message: message.state == MissionStatus.CLEANING)
        self.battery.fresh(lambda message: not message.brushes_up)
        answer = goal.ends(Outcome.SUCCEEDED)
        self.assertAlmostEqual(answer.cleaning.coverage, 0.15, delta=0.03)

    def test_go_to_arrives_although_a_person_drives_away_from_the_target(self):
        goal = self.cleaner.send('go_to', go_to(1.0, 2.5, -2.0))
        self.cleaner.waits_to_drive()
        for v, w in ((-0.3, 0.5), (0.3, 1.5)):
            self.person.press(v, w)
            self.yields()
            self.truth.fresh(lambda message: message.twist.twist.linear.x * v > 0.01)
            self.person.release()
            self.cleaner.waits_to_drive()
        goal.ends(Outcome.SUCCEEDED)
        position = self.truth.fresh().pose.pose.position
        self.assertLess(math.hypot(position.x - 1.0, position.y - 2.5), 0.03)

    def test_a_goal_is_cancelled_while_a_person_drives(self):
        goal = self.cleaner.send('go_to', go_to(1.0, 2.5))
        self.cleaner.waits_to_drive()
        self.person.press(0.0, 1.0)
        self.yields()
        goal.handle.cancel()
        goal.ends(Outcome.CANCELLED)
        self.truth.fresh(lambda message: message.twist.twist.angular.z > 0.5)
        self.assertEqual(self.cleaner.settles().state, MissionStatus.IDLE)

    def test_a_person_who_drives_without_a_goal_changes_nothing(self):
        self.person.press(-0.1, 0.0)
        self.cleaner.status.messages.clear()
        self.truth.fresh(lambda message: message.twist.twist.linear.x < -0.05)
        self.person.release()
        self.truth.fresh(lambda message: message.twist.twist.linear.x == 0.0)
        self.assertEqual(self.cleaner.status.messages, [])

    def test_the_time_limit_counts_while_a_person_drives(self):
        goal = self.cleaner.send('go_to', go_to(1.0, 2.5, time_limit=5.0))
        self.cleaner.waits_to_drive()
        self.person.press(0.0, 1.0)
        begin = self.yields().header.stamp
        self.truth.fresh(lambda message: (message.header.stamp - begin).to_sec() > 6.0)
        self.person.release()
        goal.ends(Outcome.TIMED_OUT)


if __name__ == '__main__':
    rospy.init_node('test_cleaner_teleop')
    rostest.rosrun('rumba_cleaning', 'cleaner_teleop', CleanerTeleopTest)
