#!/usr/bin/env python3
"""turtlesim starts late, or ends and starts again, or is odd; the battery is empty; parameters are bad."""

import math
import subprocess
import unittest

import programs
import rospy
import rostest
from simulators import TIMEOUT, Commands, Heard, lookup, wait
from turtles import IS_STAND_IN, Turtle, ask, body, turtlesim

from turtlesim.msg import Pose


def is_published(topic):
    """Whether the master knows a publisher of a topic."""
    return topic in [name for name, _ in rospy.get_published_topics()]


class TurtlesimBodyLifeTest(unittest.TestCase):
    """Each test starts its own nodes."""

    def test_it_waits_for_turtlesim_and_for_the_next_one_in_real_time(self):
        body(self)
        for theta in (0.0, 1.0):
            simulation = turtlesim(self, speed=1)
            turtle = Turtle(self)
            turtle.robot_is_at(499 / 90, 499 / 90)
            turtle.drive(0.2, 0.5, lambda pose: pose.x > 5.6)
            simulation.end()

    @unittest.skipUnless(IS_STAND_IN, 'the original turtlesim has no clock')
    def test_it_continues_with_a_new_turtlesim_whose_time_begins_at_0(self):
        first = turtlesim(self)
        body(self)
        turtle = Turtle(self)
        turtle.goes(1.0)
        before = turtle.truth.fresh().header.stamp
        first.end()
        rospy.set_param('/use_sim_time', True)
        turtlesim(self)
        after = turtle.robot_is_at(499 / 90, 499 / 90).header.stamp
        self.assertLess(after, before + rospy.Duration(60.0))
        turtle.goes(0.3)

    def test_with_an_empty_battery_the_turtle_stands_still(self):
        turtlesim(self)
        body(self, '_percentage:=0')
        turtle = Turtle(self)
        status = Heard(self, '/rumba/battery_status').find(lambda status: status.percentage_battery == 0)
        self.assertEqual(status.debug_message, 'battery empty')
        turtle.poses.messages.clear()
        wait(self, lambda: turtle.commands.send(0.3, 0.5) or len(turtle.poses.messages) > 100, 'poses')
        self.assertEqual({(pose.x, pose.theta, pose.linear_velocity) for pose in turtle.poses.messages},
                         {(turtle.poses.messages[0].x, 0.0, 0.0)})

    def test_another_turtle_and_another_robot(self):
        turtlesim(self, speed=1)
        body(self, '_turtle:=mikey', '_robot:=second')
        ask('spawn', 2.0, 3.0, 0.5, 'mikey')
        truth = Heard(self, '/second/ground_truth').find()
        self.assertEqual(truth.child_frame_id, 'second/base_footprint')
        self.assertAlmostEqual(truth.pose.pose.position.x, 2.0, places=5)
        commands, poses = Commands(self, 'second'), Heard(self, '/mikey/pose', Pose)
        wait(self, lambda: commands.send(0.3, 0.0) or any(pose.x > 2.1 for pose in poses.messages[:]), 'mikey')

    def test_without_its_turtle_it_says_so_and_the_robot_is_gone_until_the_turtle_comes(self):
        turtlesim(self, speed=1)
        log = Heard(self, '/rosout')
        body(self, '_turtle:=mikey')
        log.find(lambda entry: entry.msg.startswith('no turtle: nothing publishes /mikey/pose; turtles that there are: '
                                                    '/turtle1. '))
        battery = Heard(self, '/rumba/battery_status')
        wait(self, lambda: not lookup('/rumba/teleport'), 'the end of the robot')
        wait(self, lambda: not is_published('/rumba/battery_status'), 'the end of its topics')
        ask('spawn', 2.0, 3.0, 0.5, 'mikey')
        self.assertAlmostEqual(battery.fresh().location_x, 2.0, places=5)
        log.find(lambda entry: entry.msg == 'there is a turtle on /mikey/pose')
        log.messages.clear()
        ask('kill', 'mikey')
        log.find(lambda entry: entry.msg.startswith('no turtle: nothing publishes /mikey/pose'))

    def test_a_turtlesim_that_was_killed_has_no_turtle_and_the_next_one_has(self):
        simulation = turtlesim(self, speed=1)
        log = Heard(self, '/rosout')
        body(self)
        turtle = Turtle(self)
        turtle.truth.find()
        simulation.process.kill()
        simulation.process.wait(TIMEOUT)
        line = log.find(lambda entry: entry.msg.startswith('no turtle: ')).msg
        self.assertEqual(line, 'no turtle: nothing publishes /turtle1/pose; turtles that there are: none. Start '
                               'turtlesim, or set the parameter turtle')
        turtlesim(self, speed=1)
        log.find(lambda entry: entry.msg == 'there is a turtle on /turtle1/pose')
        turtle.truth.fresh()

    def test_a_pose_that_is_not_finite_changes_nothing(self):
        rospy.set_param('/use_sim_time', False)
        log = Heard(self, '/rosout')
        body(self)
        publisher = rospy.Publisher('/turtle1/pose', Pose, queue_size=10)
        self.addCleanup(publisher.unregister)
        battery = Heard(self, '/rumba/battery_status')

        def told(pose, condition):
            wait(self, lambda: publisher.publish(pose) or condition(), pose)
        good, odd = Pose(x=2.0, y=3.0, theta=0.5), Pose(x=math.inf, y=-math.inf, theta=0.5)
        told(good, lambda: battery.messages)
        line = '/turtle1/pose has numbers that are not finite'
        told(odd, lambda: any(line in entry.msg for entry in log.messages[:]))
        battery.messages.clear()
        told(good, lambda: battery.messages)
        self.assertEqual({(status.location_x, status.location_y) for status in battery.messages}, {(2.0, 3.0)})

    def test_bad_parameters_end_it_with_one_line_and_exit_code_2(self):
        for arguments, message in (
                (['_turtle:=a/b'], "turtle is 'a/b': must be letters"), (['_map:=moon'], "there is no map 'moon'"),
                (['_pen/red:=256'], 'pen/red is 256: must be 0 to 255'), (['_speed:=2'], 'speed is unknown')):
            process = programs.run('rumba_sim', 'turtlesim_body', *arguments, timeout=TIMEOUT,
                                   stderr=subprocess.PIPE, universal_newlines=True)
            self.assertEqual(process.returncode, 2)
            self.assertIn(message, process.stderr)
            self.assertEqual(process.stderr.count('\n'), 1)


if __name__ == '__main__':
    rospy.init_node('test_turtlesim_body_life')
    rostest.rosrun('rumba_sim', 'turtlesim_body_life', TurtlesimBodyLifeTest)
