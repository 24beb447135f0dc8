#!/usr/bin/env python3
"""The alarm and the node of the same package as the module log the words of the module."""

import queue
import unittest

import rospy
import rostest
from rosgraph_msgs.msg import Log
from std_msgs.msg import Bool

from rumba_msg.msg import BatteryStatus

TIMEOUT = 30.0


class BatteryAlarmTest(unittest.TestCase):
    """Both nodes subscribe to one battery."""

    def setUp(self):
        self.low, self.said = queue.Queue(), set()
        rospy.Subscriber('battery_low', Bool, lambda message: self.low.put(message.data))
        rospy.Subscriber('/rosout', Log, lambda entry: self.said.add((entry.name, entry.level, entry.msg)))
        self.publisher = rospy.Publisher('rumba/battery_status', BatteryStatus, queue_size=10)
        self.end = rospy.get_time() + TIMEOUT
        while self.publisher.get_num_connections() < 2:
            self.assertLess(rospy.get_time(), self.end, 'the nodes do not subscribe')
            rospy.sleep(0.01)

    def publish(self, percentage, brushes_up):
        self.publisher.publish(BatteryStatus(percentage_battery=percentage, brushes_up=brushes_up))

    def test_it_publishes_when_the_charge_crosses_the_limit(self):
        self.publish(21, True)
        self.assertIs(self.low.get(timeout=TIMEOUT), False)  # latched: from here on, every change arrives
        for percentage in (20, 19, 50, 10):
            self.publish(percentage, True)
        self.assertEqual([self.low.get(timeout=TIMEOUT) for _ in range(3)], [True, False, True])
        self.check_what_both_log()

    def check_what_both_log(self):
        wanted = {('/alarm', Log.WARN, 'low: 20 %, brushes lifted'),
                  ('/say_battery', Log.INFO, 'full: 100 %, brushes on the floor')}
        while not wanted <= self.said:
            self.assertLess(rospy.get_time(), self.end, self.said)
            self.publish(20, True)
            self.publish(100, False)
            rospy.sleep(0.05)


if __name__ == '__main__':
    rospy.init_node('test_battery_alarm')
    rostest.rosrun('battery_alarm', 'battery_alarm', BatteryAlarmTest)
