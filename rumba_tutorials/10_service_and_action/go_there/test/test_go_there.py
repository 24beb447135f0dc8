#!/usr/bin/env python3
"""Service and action both lead to the place, refuse what cannot be, and Ctrl-C stops the robot."""

import math
import signal
import subprocess
import time
import unittest

import rospy
import rostest
from nav_msgs.msg import Odometry

from rumba_msg.msg import MissionStatus

TIMEOUT = 60.0
IN_A_WALL = ['0', '0', '0']


class GoThereTest(unittest.TestCase):
    """One robot for all tests: where it is when a test begins does not matter."""

    def start(self, script, *arguments):
        """The script as a user starts it."""
        process = subprocess.Popen(['rosrun', 'go_there', script, *arguments], stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, universal_newlines=True)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        return process

    def run_script(self, script, *arguments):
        """Lines and exit code of the script, when it is through."""
        process = self.start(script, *arguments)
        return process.communicate(timeout=TIMEOUT)[0].splitlines(), process.returncode

    def waits_for(self, hear, condition):
        """The first message heard for which a condition holds."""
        end = time.monotonic() + TIMEOUT
        while True:
            message = hear()
            if condition(message):
                return message
            self.assertLess(time.monotonic(), end, message)

    def at_rest(self):
        """The true pose (x, y, theta), once the robot stands still."""
        truth = self.waits_for(lambda: rospy.wait_for_message('rumba/ground_truth', Odometry, TIMEOUT),
                               lambda truth: truth.twist.twist.linear.x == truth.twist.twist.angular.z == 0.0)
        pose = truth.pose.pose
        return pose.position.x, pose.position.y, 2.0 * math.atan2(pose.orientation.z, pose.orientation.w)

    def is_at(self, x, y, theta):
        """See that the robot rests at a pose."""
        for value, wanted in zip(self.at_rest(), (x, y, theta)):
            self.assertAlmostEqual(value, wanted, delta=0.05)

    def test_by_service(self):
        lines, code = self.run_script('by_service', '1.5', '2.5', '1.0')
        self.assertRegex(lines[0], r'^\d\.\d\d m to go$')
        self.assertEqual((lines[-1], code), ('there', 0))
        self.is_at(1.5, 2.5, 1.0)

    def test_by_action(self):
        lines, code = self.run_script('by_action', '2.5', '2.0', '-0.5')
        # Where the server answers before send_goal has returned, actionlib complains first.
        self.assertRegex('\n'.join(lines), r'(?m)^\d\.\d\d m to go$')
        self.assertRegex(lines[-1], r'^succeeded: at \(2\.\d\d, \d\.\d\d\) m$')
        self.assertEqual(code, 0)
        self.is_at(2.5, 2.0, -0.5)

    def test_both_say_why_a_place_cannot_be(self):
        for script, word in (('by_service', 'refused'), ('by_action', 'aborted')):
            lines, code = self.run_script(script, *IN_A_WALL)
            self.assertRegex(lines[-1], f'^{word}: .*a robot of radius 0.174 m does not fit$')
            self.assertEqual(code, 1)

    def test_both_want_three_numbers(self):
        for script in ('by_service', 'by_action'):
            lines, code = self.run_script(script, '1.0', '2.0')
            self.assertIn(f'{script} X Y THETA: ', lines[0])
            self.assertEqual(code, 1)

    def test_ctrl_c_takes_the_goal_back(self):
        self.run_script('by_action', '2.5', '2.0', '0.0')
        process = self.start('by_action', '0.8', '2.5', '0.0')
        process.stdout.readline()  # it is on the way
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=TIMEOUT)
        self.waits_for(lambda: rospy.wait_for_message('rumba/mission_status', MissionStatus, TIMEOUT),
                       lambda status: (status.state, status.message) == (MissionStatus.IDLE, 'cancelled'))
        self.assertGreater(math.dist(self.at_rest()[:2], (0.8, 2.5)), 0.1)


if __name__ == '__main__':
    rospy.init_node('test_go_there')
    rostest.rosrun('go_there', 'go_there', GoThereTest)
