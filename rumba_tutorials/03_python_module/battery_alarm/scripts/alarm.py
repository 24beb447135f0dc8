#!/usr/bin/env python3
"""Logs a warning and publishes True on battery_low when the charge becomes low; publishes False when it is good again.

The topic is latched.
"""

import rospy
from std_msgs.msg import Bool

from battery_words.words import describe, level
from rumba_msg.msg import BatteryStatus


class Alarm:
    """Publishes when the charge crosses the limit, and not in between."""

    def __init__(self):
        self.is_low = None
        self.publisher = rospy.Publisher('battery_low', Bool, queue_size=10, latch=True)
        rospy.Subscriber('rumba/battery_status', BatteryStatus, self.on_status)

    def on_status(self, status):
        is_low = level(status.percentage_battery) in ('low', 'empty')
        if is_low == self.is_low:
            return
        self.is_low = is_low
        if is_low:
            rospy.logwarn(describe(status))
        self.publisher.publish(is_low)


rospy.init_node('alarm')
Alarm()
rospy.spin()
