#!/usr/bin/env python3
"""The alarm, and the node beside the module, say what the module says."""

import queue
import unittest

import rospy
import rostest
from rosgraph_msgs.msg import Log
from std_msgs.msg import Bool

from rumba_msg.msg import BatteryStatus

TIMEOUT = 30.0


class BatteryAlarmTest(unittest.TestCase):
    """Both nodes hear one battery."""

    def setUp(self):
        self.low, self.log = queue.Queue(), queue.Queue()
        rospy.Subscriber('battery_low', Bool, lambda message: self.low.put(message.data))
        rospy.Subscriber('/rosout', Log, lambda entry: self.log.put((entry.name, entry.level, entry.msg)))
        self.publisher = rospy.Publisher('rumba/battery_status', BatteryStatus, queue_size=10)
        end = rospy.get_time() + TIMEOUT
        while self.publisher.get_num_connections() < 2:
            self.assertLess(rospy.get_time(), end, 'the nodes do not listen')
            rospy.sleep(0.01)

    def logged(self, wanted):
        """Whether an entry comes, before time is over."""
        while self.log.get(timeout=TIMEOUT) != wanted:
            pass

    def test_it_speaks_when_the_limit_is_crossed(self):
        for percentage in (21, 20, 19, 50):
            self.publisher.publish(BatteryStatus(percentage_battery=percentage, brushes_up=True))
        self.assertEqual([self.low.get(timeout=TIMEOUT) for _ in range(3)], [False, True, False])
        self.logged(('/alarm', Log.WARN, 'low: 20 %, brushes lifted'))
        self.publisher.publish(BatteryStatus(percentage_battery=100))
        self.logged(('/say_battery', Log.INFO, 'full: 100 %, brushes on the floor'))


if __name__ == '__main__':
    rospy.init_node('test_battery_alarm')
    rostest.rosrun('battery_alarm', 'battery_alarm', BatteryAlarmTest)
