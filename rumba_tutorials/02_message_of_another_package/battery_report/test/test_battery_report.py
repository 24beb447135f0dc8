#!/usr/bin/env python3
"""The message of the C++ publisher is complete, and both readers print the fields correctly."""

import threading
import unittest

import rospy
import rostest
from rosgraph_msgs.msg import Log

from rumba_msg.msg import BatteryStatus

TIMEOUT = 30.0


class BatteryReportTest(unittest.TestCase):
    """The nodes run in namespaces: published holds the publisher, to_python and to_cpp a reader."""

    def test_publisher(self):
        heard = rospy.wait_for_message('/published/rumba/battery_status', BatteryStatus, TIMEOUT)
        self.assertGreater(heard.percentage_battery, 0)
        self.assertEqual(heard, BatteryStatus(heard.percentage_battery, 1.5, -2.5, 0.75, True, 'from C++'))

    def test_readers(self):
        for brushes_up, brushes in ((True, 'up'), (False, 'down')):
            status = BatteryStatus(42, 1.25, -2.5, 0.0, brushes_up, '')
            for namespace in ('to_python', 'to_cpp'):
                self.check_reader(namespace, status, f'42 %, at (1.2, -2.5), brushes {brushes}')

    def check_reader(self, namespace, status, wanted):
        """Publish a status until the reader of a namespace logs the expected line."""
        heard = threading.Event()
        log = rospy.Subscriber('/rosout', Log, lambda entry: heard.set()
                               if (entry.name, entry.msg) == (f'/{namespace}/reader', wanted) else None)
        publisher = rospy.Publisher(f'/{namespace}/rumba/battery_status', BatteryStatus, queue_size=1)
        end = rospy.get_time() + TIMEOUT
        while not heard.wait(0.05):
            self.assertLess(rospy.get_time(), end, f'/{namespace}/reader does not log: {wanted}')
            publisher.publish(status)
        log.unregister()
        publisher.unregister()


if __name__ == '__main__':
    rospy.init_node('test_battery_report')
    rostest.rosrun('battery_report', 'battery_report', BatteryReportTest)
