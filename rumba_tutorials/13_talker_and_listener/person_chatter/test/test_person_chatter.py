#!/usr/bin/env python3
"""Talkers in both languages publish their person, and listeners in both languages print it."""

import threading
import unittest

import rospy
import rostest
from rosgraph_msgs.msg import Log

from person_chatter.msg import Person

TIMEOUT = 30.0


class PersonChatterTest(unittest.TestCase):
    """The nodes run in namespaces: python and cpp hold a talker, to_python and to_cpp a listener."""

    def test_talkers(self):
        for namespace, wanted in (('python', Person('Ada', 36)), ('cpp', Person('Grace', 37))):
            self.assertEqual(rospy.wait_for_message(f'/{namespace}/custom_chatter', Person, TIMEOUT), wanted)

    def test_listeners(self):
        for namespace in ('to_python', 'to_cpp'):
            heard = threading.Event()
            log = rospy.Subscriber('/rosout', Log, lambda entry: self.note(entry, f'/{namespace}/listener', heard))
            publisher = rospy.Publisher(f'/{namespace}/custom_chatter', Person, queue_size=1)
            end = rospy.get_time() + TIMEOUT
            while not heard.wait(0.05):
                self.assertLess(rospy.get_time(), end, f'/{namespace}/listener logs nothing')
                publisher.publish('Alan', -3)
            log.unregister()
            publisher.unregister()

    def note(self, entry, node, heard):
        """Set the event if the node has logged the expected line."""
        if (entry.name, entry.msg) == (node, 'Alan is -3 years old'):
            heard.set()


if __name__ == '__main__':
    rospy.init_node('test_person_chatter')
    rostest.rosrun('person_chatter', 'person_chatter', PersonChatterTest)
