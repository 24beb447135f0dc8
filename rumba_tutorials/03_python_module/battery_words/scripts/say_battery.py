#!/usr/bin/env python3
"""Logs the state of the battery in words, at the first message and at each change."""

import rospy

from battery_words import words
from rumba_msg.msg import BatteryStatus


class Speaker:
    """Logs no line twice in a row."""

    def __init__(self):
        self.said = ''
        rospy.Subscriber('rumba/battery_status', BatteryStatus, self.on_status)

    def on_status(self, status):
        line = words.describe(status)
        if line != self.said:
            rospy.loginfo(line)
            self.said = line


rospy.init_node('say_battery')
Speaker()
rospy.spin()
