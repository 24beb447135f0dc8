#!/usr/bin/env python3
"""The node publishes what follows from the right and wrong answers of a user."""

import subprocess
import threading
import unittest

import rospy
import rostest
from geometry_msgs.msg import Twist, Vector3

TIMEOUT = 30.0


class RaiseVelocityTest(unittest.TestCase):
    """The node runs as a user starts it, with pipes as keyboard and screen."""

    def setUp(self):
        self.news = threading.Condition()
        self.published = []  # (forward velocity [m/s], turn rate [rad/s]) that the node publishes
        subscriber = rospy.Subscriber('cmd_vel', Twist, self.on_command)
        self.node = subprocess.Popen(['rosrun', 'raise_velocity', 'increase.py'], universal_newlines=True,
                                     stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.addCleanup(self.node.wait)
        self.addCleanup(self.node.kill)
        self.addCleanup(subscriber.unregister)

    def on_command(self, velocity):
        if velocity._connection_header['callerid'] == '/increase':
            with self.news:
                self.published.append((velocity.linear.x, velocity.angular.z))
                self.news.notify()

    def wait_for(self, *wanted):
        """Wait until the last command of the node is the wanted one."""
        with self.news:
            is_there = self.news.wait_for(lambda: self.published[-1:] == [wanted], TIMEOUT)
            self.assertTrue(is_there, (wanted, self.published[-1:]))

    def answer(self, answer, shown):
        """Type an answer and read the next line on the screen."""
        print(answer, file=self.node.stdin, flush=True)
        self.assertEqual(self.node.stdout.readline(), f'> {shown}\n')

    def test_a_conversation(self):
        asked = 'the velocity is {:.2f} m/s; how much to add? (q: stop the robot and quit)'
        refused = '{} is not a velocity: type a number in m/s, such as 0.1 or -0.1'
        self.assertEqual(self.node.stdout.readline(), asked.format(0.0) + '\n')
        self.wait_for(0.0, 0.0)
        self.answer('0.25', asked.format(0.25))
        self.wait_for(0.25, 0.0)
        for wrong in ('fast', '', 'nan', '-inf', '1,5'):
            self.answer(wrong, refused.format(repr(wrong)))
        self.wait_for(0.25, 0.0)
        other = rospy.Publisher('cmd_vel', Twist, queue_size=1, latch=True)
        other.publish(Twist(linear=Vector3(x=0.5), angular=Vector3(z=-1.0)))
        self.wait_for(0.5, -1.0)
        other.unregister()
        self.answer('-0.125', asked.format(0.375))
        self.wait_for(0.375, -1.0)
        print('q', file=self.node.stdin, flush=True)
        self.assertEqual(self.node.wait(TIMEOUT), 0)
        self.wait_for(0.0, 0.0)

    def test_the_end_of_the_input_stops_the_robot(self):
        self.node.stdout.readline()
        self.answer('1', 'the velocity is 1.00 m/s; how much to add? (q: stop the robot and quit)')
        self.wait_for(1.0, 0.0)
        self.node.stdin.close()
        self.assertEqual(self.node.wait(TIMEOUT), 0)
        self.wait_for(0.0, 0.0)


if __name__ == '__main__':
    rospy.init_node('test_raise_velocity')
    rostest.rosrun('raise_velocity', 'raise_velocity', RaiseVelocityTest)
