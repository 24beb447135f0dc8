#!/usr/bin/env python3
"""turtlesim starts late, or ends and starts again; the battery is empty; parameters are bad."""

import subprocess
import unittest

import rospy
import rostest
from simulators import Commands, Heard, wait
from turtles import Process, Turtle, ask, body, turtlesim

from turtlesim.msg import Pose


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
        Process(self, '/turtle1/set_pen', 'turtlesim', 'turtlesim_node', '_gui:=false')
        body(self, '_turtle:=mikey', '_robot:=second')
        ask('spawn', 2.0, 3.0, 0.5, 'mikey')
        truth = Heard(self, '/second/ground_truth').find()
        self.assertEqual(truth.child_frame_id, 'second/base_footprint')
        self.assertAlmostEqual(truth.pose.pose.position.x, 2.0, places=5)
        commands, poses = Commands(self, 'second'), Heard(self, '/mikey/pose', Pose)
        wait(self, lambda: commands.send(0.3, 0.0) or any(pose.x > 2.1 for pose in poses.messages[:]), 'mikey')

    def test_bad_parameters_end_it_with_one_line_and_exit_code_2(self):
        for arguments, message in (
                (['_turtle:=a/b'], "turtle is 'a/b': must be letters"), (['_map:=moon'], "there is no map 'moon'"),
                (['_pen/red:=256'], 'pen/red is 256: must be 0 to 255'), (['_speed:=2'], 'speed is unknown')):
            with self.subTest(arguments):
                process = subprocess.run(['rosrun', 'rumba_sim', 'turtlesim_body', *arguments], stderr=subprocess.PIPE,
                                         universal_newlines=True)
                self.assertEqual(process.returncode, 2)
                self.assertIn(message, process.stderr)
                self.assertEqual(process.stderr.count('\n'), 1)


if __name__ == '__main__':
    rospy.init_node('test_turtlesim_body_life')
    rostest.rosrun('rumba_sim', 'turtlesim_body_life', TurtlesimBodyLifeTest)
