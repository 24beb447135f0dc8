#!/usr/bin/env python3
"""Service and action lead to the pose and refuse one in a wall; Ctrl-C stops the robot."""

import math
import signal
import subprocess
import time
import unittest

import rospy
import rostest
from nav_msgs.msg import Odometry
from std_srvs.srv import Trigger

from rumba_msg.msg import MissionStatus

TIMEOUT = 60.0
IN_A_WALL = ['0', '0', '0']


class GoThereTest(unittest.TestCase):
    """One robot for all tests; its pose at the start of a test does not matter."""

    def start(self, script, *arguments):
        """Start a script as a user does."""
        process = subprocess.Popen(['rosrun', 'go_there', script, *arguments], stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, universal_newlines=True)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        return process

    def run_script(self, script, *arguments):
        """Run a script to its end; return its lines and its exit code."""
        process = self.start(script, *arguments)
        return process.communicate(timeout=TIMEOUT)[0].splitlines(), process.returncode

    def wait_for(self, receive, condition):
        """Return the first message for which a condition holds."""
        end = time.monotonic() + TIMEOUT
        while True:
            message = receive()
            if condition(message):
                return message
            self.assertLess(time.monotonic(), end, message)

    def at_rest(self):
        """Wait until the robot stands still; return its true pose (x, y, theta)."""
        truth = self.wait_for(lambda: rospy.wait_for_message('rumba/ground_truth', Odometry, TIMEOUT),
                              lambda truth: truth.twist.twist.linear.x == truth.twist.twist.angular.z == 0.0)
        pose = truth.pose.pose
        return pose.position.x, pose.position.y, 2.0 * math.atan2(pose.orientation.z, pose.orientation.w)

    def is_at(self, x, y, theta):
        """Check that the robot comes to rest at a pose."""
        for value, wanted in zip(self.at_rest(), (x, y, theta)):
            self.assertAlmostEqual(value, wanted, delta=0.05)

    def test_by_service(self):
        lines, code = self.run_script('by_service', '1.5', '2.5', '1.0')
        self.assertRegex(lines[0], r'^\d\.\d\d m to go$')
        self.assertEqual((lines[-1], code), ('there', 0))
        self.is_at(1.5, 2.5, 1.0)

    def test_by_action(self):
        lines, code = self.run_script('by_action', '2.5', '2.0', '-0.5')
        # If the server answers before send_goal has returned, actionlib logs an error first.
        self.assertRegex('\n'.join(lines), r'(?m)^\d\.\d\d m to go$')
        self.assertRegex(lines[-1], r'^succeeded: at \(2\.\d\d, \d\.\d\d\) m$')
        self.assertEqual(code, 0)
        self.is_at(2.5, 2.0, -0.5)

    def test_both_say_why_a_pose_is_refused(self):
        for script, word in (('by_service', 'refused'), ('by_action', 'aborted')):
            lines, code = self.run_script(script, *IN_A_WALL)
            self.assertRegex(lines[-1], f'^{word}: .*a robot of radius 0.174 m does not fit$')
            self.assertEqual(code, 1)

    def test_both_require_three_numbers(self):
        for script in ('by_service', 'by_action'):
            lines, code = self.run_script(script, '1.0', '2.0')
            self.assertIn(f'{script} X Y THETA: ', lines[0])
            self.assertEqual(code, 1)

    def test_ctrl_c_cancels_the_goal(self):
        self.run_script('by_action', '2.5', '2.0', '0.0')
        process = self.start('by_action', '0.8', '2.5', '0.0')
        process.stdout.readline()  # the robot drives
        self.addCleanup(rospy.ServiceProxy('simulator/resume', Trigger))
        rospy.ServiceProxy('simulator/pause', Trigger)()  # else it may be there before a busy machine cancels
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=TIMEOUT)
        self.wait_for(lambda: rospy.wait_for_message('rumba/mission_status', MissionStatus, TIMEOUT),
                      lambda status: (status.state, status.message) == (MissionStatus.IDLE, 'cancelled'))
        rospy.ServiceProxy('simulator/resume', Trigger)()
        self.assertGreater(math.dist(self.at_rest()[:2], (0.8, 2.5)), 0.1)


if __name__ == '__main__':
    rospy.init_node('test_go_there')
    rostest.rosrun('go_there', 'go_there', GoThereTest)
