#!/usr/bin/env python3
"""A turtle that is the body of a Rumba drives, drains its battery, cleans, bumps and charges like a Rumba."""

import itertools
import math
import unittest

import rospy
import rostest
from geometry_msgs.msg import Pose2D
from simulators import Commands, Heard, shared, wait
from std_srvs.srv import SetBool, Trigger
from turtles import SPEED, Turtle, ask, body, turtlesim

from rumba_msg.srv import Teleport
from rumba_sim.ros.common import teleop
from rumba_sim.ros.participants.simulator_client import robot_config

PEN = (240, 240, 255)  # the parameters' defaults
DRAIN = 20.0
MIDDLE = 499 / 90  # [m]
DOCK = (10.895, MIDDLE)


class TurtlesimBodyTest(unittest.TestCase):
    """All tests share one turtle; each begins at a pose of its choice."""

    @classmethod
    def setUpClass(cls):
        test = shared(cls)
        turtlesim(test)
        body(test, f'_battery/drain:={DRAIN}')
        cls.turtle = Turtle(test)
        cls.battery = Heard(test, '/rumba/battery_state')
        cls.cleaning = Heard(test, '/rumba/cleaning_status')
        cls.bumper = Heard(test, '/rumba/bumper')

    def put(self, x, y, theta):
        """Teleport the robot."""
        answer = rospy.ServiceProxy('/rumba/teleport', Teleport)(Pose2D(x, y, theta))
        self.assertTrue(answer.success, answer.message)
        self.turtle.robot_is_at(x, y)

    def brushes(self, are_up):
        """Lift or lower the brushes."""
        self.assertTrue(rospy.ServiceProxy('/rumba/set_brushes_up', SetBool)(are_up).success)

    def seen(self, message):
        """A colour as a tuple."""
        return message.r, message.g, message.b

    def test_driving_drains_the_battery(self):
        """At 0.3 m/s with brushes: 0.19 + 1.0 + 0.5 A."""
        self.put(2.0, 8.0, 0.0)
        self.brushes(False)
        self.battery.messages.clear()
        self.turtle.drive(0.3, 0.0, lambda pose: pose.x > 4.5)
        # On a busy machine the turtle may stand for a while, since its next command came late.
        first, *_, last = max((list(states) for drives, states in itertools.groupby(
            self.battery.messages[:], lambda state: abs(state.current + 1.69) < 1e-3) if drives), key=len)
        seconds = (last.header.stamp - first.header.stamp).to_sec()
        self.assertGreater(seconds, 1.0)
        drained = 1.69 * DRAIN * seconds / 3600.0
        # In real time, the stamps are those of the wall clock, and turtlesim is not always on time.
        self.assertAlmostEqual(first.charge - last.charge, drained, delta=(0.002 if SPEED != 1 else 0.2) * drained)

    def test_a_turn_keeps_its_sign_and_the_limit_of_the_robot(self):
        self.put(3.0, 3.0, 0.5)
        pose = self.turtle.drive(0.0, -9.0, lambda pose: pose.theta < -0.5)
        self.assertGreaterEqual(pose.angular_velocity, -1.9 - 1e-5)
        self.turtle.truth.fresh(lambda truth: abs(2.0 * math.asin(truth.pose.pose.orientation.z)
                                                  - self.turtle.poses.messages[-1].theta) < 0.01)

    def test_brushes_and_pen_are_down_or_up_together(self):
        self.put(2.0, 2.0, 0.0)
        self.brushes(False)
        self.turtle.goes(0.5)
        clean = self.cleaning.fresh()
        self.turtle.colours.messages.clear()
        self.turtle.goes(0.3, v=-0.3)
        self.turtle.colours.find(lambda colour: self.seen(colour) == PEN)
        self.brushes(True)
        self.put(2.0, 4.0, 0.0)
        up = self.cleaning.fresh()
        self.turtle.colours.messages.clear()
        self.turtle.goes(0.5)
        self.turtle.goes(0.3, v=-0.3)
        self.assertNotIn(PEN, {self.seen(colour) for colour in self.turtle.colours.messages})
        after = self.cleaning.fresh()
        self.assertGreater(clean.cleaned_area, 0.04)
        self.assertEqual(after.cleaned_area, up.cleaned_area)
        self.assertEqual(after.time, up.time)
        self.assertGreater(after.distance, up.distance + 0.7)

    def test_a_teleport_is_not_counted_as_driving(self):
        self.put(3.0, 9.0, 0.0)
        self.brushes(False)
        before, believed = self.cleaning.fresh(), self.turtle.believed()
        self.put(7.0, 9.5, 0.3)
        ask('turtle1/teleport_absolute', 5.0, 9.0, 0.1)
        self.turtle.robot_is_at(5.0, 9.0)
        after = self.cleaning.fresh()
        self.assertEqual((after.distance, after.cleaned_area), (before.distance, before.cleaned_area))
        self.assertEqual(self.turtle.believed(), believed)

    def test_a_teleport_to_an_impossible_pose_is_refused(self):
        for x, message in ((0.1, r'\(0\.10, 5\.00\)'), (float('nan'), 'must be finite numbers')):
            answer = rospy.ServiceProxy('/rumba/teleport', Teleport)(Pose2D(x, 5.0, 0.0))
            self.assertFalse(answer.success)
            self.assertRegex(answer.message, message)

    def test_at_the_edge_it_stops_and_its_bumper_is_pressed(self):
        self.put(10.6, 8.0, 0.0)
        begin = self.turtle.poses.fresh()
        self.bumper.messages.clear()
        self.turtle.drive(0.1, 0.0, lambda pose: any(
            message.is_left_pressed and message.is_right_pressed for message in self.bumper.messages[:]))
        end = self.turtle.poses.fresh()
        self.assertGreater(end.x, begin.x + 0.1)
        self.assertLess(end.x, 11.1 - 0.17425 + 0.1)  # a few frames pass until the turtle obeys
        self.turtle.goes(0.2, v=-0.2)
        self.bumper.fresh(lambda message: not message.is_left_pressed and not message.is_right_pressed)

    def test_on_the_dock_it_charges(self):
        self.put(10.4, MIDDLE, 0.0)
        self.battery.fresh(lambda state: state.power_supply_status == state.POWER_SUPPLY_STATUS_DISCHARGING)
        self.put(*DOCK, 0.0)
        charged = self.battery.fresh(lambda state: state.power_supply_status == state.POWER_SUPPLY_STATUS_CHARGING)
        self.battery.fresh(lambda state: state.charge > charged.charge)

    def test_its_state_gives_map_seed_and_real_time_factor(self):
        heard = Heard(self, '/simulator/state')
        state = heard.find(lambda message: abs(message.real_time_factor - SPEED) < 0.2 * SPEED)
        self.assertEqual((state.node, state.step_rate, state.seed), ('/turtlesim_body', 62.5, 1))
        self.assertTrue(math.isnan(state.speed))
        self.assertEqual((state.is_paused, state.is_time_simulated), (False, SPEED != 1))
        self.assertTrue(state.map.startswith('/') and state.map.endswith('/rumba_sim/maps/field.yaml'), state.map)
        heard.fresh(lambda message: message.tick > state.tick and message.header.stamp > state.header.stamp)
        self.assertEqual(robot_config(state.node).battery.drain, DRAIN)

    def test_a_person_overrides_a_program(self):
        self.put(5.0, 5.0, 0.0)
        person, program, truth = Commands(self, topic=teleop.TOPIC), self.turtle.commands, self.turtle.truth

        def turns(sign):
            truth.messages.clear()

            def is_there():
                if sign > 0.0:
                    person.send(0.0, 1.0)
                program.send(0.0, -1.0)
                return truth.messages and abs(truth.messages[-1].twist.twist.angular.z - sign) < 1e-6
            wait(self, is_there, 'the turn')
        for sign in (-1.0, 1.0, -1.0):
            turns(sign)

    def test_after_a_reset_of_turtlesim_it_is_in_the_middle_and_continues_to_clean(self):
        self.put(2.5, 6.0, 1.0)
        self.brushes(False)
        believed, before = self.turtle.believed(), self.cleaning.fresh()
        ask('reset')
        self.turtle.robot_is_at(MIDDLE, MIDDLE)
        self.assertEqual(self.turtle.believed(), believed)
        self.assertEqual(self.cleaning.fresh().cleaned_area, before.cleaned_area)
        self.turtle.goes(0.4)
        self.turtle.colours.messages.clear()
        self.turtle.goes(0.3, v=-0.3)
        self.turtle.colours.find(lambda colour: self.seen(colour) == PEN)  # the new turtle got the pen

    def test_after_a_kill_it_waits_for_another_turtle(self):
        ask('kill', 'turtle1')
        rospy.ServiceProxy('/rumba/set_brushes_up', SetBool)(False)  # it lives on
        answer = rospy.ServiceProxy('/rumba/teleport', Teleport)(Pose2D(3.0, 5.0, 0.0))
        self.assertFalse(answer.success)
        self.assertRegex(answer.message, 'turtle1')
        ask('spawn', 4.0, 7.0, 0.2, 'turtle1')
        self.turtle.robot_is_at(4.0, 7.0)
        wait(self, self.turtle.commands.is_heard, 'the robot')
        self.turtle.goes(0.3)

    def test_its_own_reset_makes_the_floor_dirty_and_the_battery_full(self):
        self.put(7.0, 3.0, 0.0)
        self.brushes(False)
        self.turtle.goes(0.5)
        self.assertTrue(rospy.ServiceProxy('/turtlesim_body/reset', Trigger)().success)
        self.cleaning.fresh(lambda status: status.cleaned_area == 0.0 and status.distance == 0.0)
        self.battery.fresh(lambda state: state.percentage > 0.995)
        self.turtle.robot_is_at(self.turtle.poses.fresh().x, 3.0)


if __name__ == '__main__':
    rospy.init_node('test_turtlesim_body')
    rostest.rosrun('rumba_sim', 'turtlesim_body', TurtlesimBodyTest)
