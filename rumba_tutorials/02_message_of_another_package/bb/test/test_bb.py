#!/usr/bin/env python3
"""bb adds the numbers that aa publishes."""

import queue
import unittest

import rospy
import rostest
from rosgraph_msgs.msg import Log


class BbTest(unittest.TestCase):
    """The launch file of the lesson runs."""

    def test_sum(self):
        log = queue.Queue()
        subscriber = rospy.Subscriber('/rosout', Log, log.put)
        entry = log.get(timeout=30.0)
        while entry.name != '/listener':
            entry = log.get(timeout=30.0)
        subscriber.unregister()
        self.assertEqual(entry.msg, '3 + -5 = -2')


if __name__ == '__main__':
    rospy.init_node('test_bb')
    rostest.rosrun('bb', 'bb', BbTest)
