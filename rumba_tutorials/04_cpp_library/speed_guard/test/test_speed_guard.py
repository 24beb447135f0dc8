#!/usr/bin/env python3
"""The guard slows commands down without a change of their curve, and refuses bad limits."""

import queue
import subprocess
import unittest

import rospy
import rostest
from geometry_msgs.msg import Twist, Vector3

TIMEOUT = 30.0
WANTED = {  # v [m/s], w [rad/s]: the command, and what the guard publishes
    (0.25, -1.0): (0.25, -1.0),
    (-1.0, 1.0): (-0.5, 0.5),
    (0.5, -8.0): (0.125, -2.0),
    (float('nan'), 1.0): (0.0, 0.0),
    (0.25, float('inf')): (0.0, 0.0),
}


class SpeedGuardTest(unittest.TestCase):
    """A guard with limits of 0.5 m/s and 2 rad/s runs."""

    def test_commands(self):
        heard = queue.Queue()
        rospy.Subscriber('cmd_vel', Twist, heard.put)
        publisher = rospy.Publisher('cmd_vel_raw', Twist, queue_size=1)
        end = rospy.get_time() + TIMEOUT
        while publisher.get_num_connections() == 0 or heard.empty():
            self.assertLess(rospy.get_time(), end, 'the guard publishes nothing')
            publisher.publish(Twist())
            rospy.sleep(0.05)
        for (linear, angular), wanted in WANTED.items():
            publisher.publish(Twist(linear=Vector3(x=linear), angular=Vector3(z=angular)))
            command = heard.get(timeout=TIMEOUT)
            while command == Twist() and wanted != (0.0, 0.0):
                command = heard.get(timeout=TIMEOUT)
            self.assertEqual((command.linear.x, command.angular.z), wanted)

    def test_a_limit_of_0_is_refused(self):
        guard = subprocess.run(['rosrun', 'speed_guard', 'guard', '__name:=bad', '_max_linear:=0.0'], timeout=TIMEOUT,
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
        self.assertEqual(guard.returncode, 2)
        self.assertIn('max_linear is 0, max_angular is 1: both must be above 0', guard.stdout)


if __name__ == '__main__':
    rospy.init_node('test_speed_guard')
    rostest.rosrun('speed_guard', 'speed_guard', SpeedGuardTest)
