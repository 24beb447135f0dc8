#!/usr/bin/env python3
"""Prints what the battery's state means, when it is heard first, and whenever that changes."""

import rospy

from battery_words import words
from rumba_msg.msg import BatteryStatus


class Speaker:
    """Says nothing twice."""

    def __init__(self):
        self.said = ''
        rospy.Subscriber('rumba/battery_status', BatteryStatus, self.hear)

    def hear(self, status):
        line = words.describe(status)
        if line != self.said:
            rospy.loginfo(line)
            self.said = line


rospy.init_node('say_battery')
Speaker()
rospy.spin()
