#!/usr/bin/env python3
"""Prints each BatteryStatus that arrives on rumba/battery_status."""

import rospy

from rumba_msg.msg import BatteryStatus


def show(status):
    rospy.loginfo('%d %%, at (%.1f, %.1f), brushes %s', status.percentage_battery, status.location_x,
                  status.location_y, 'up' if status.brushes_up else 'down')


rospy.init_node('read_battery', anonymous=True)
rospy.Subscriber('rumba/battery_status', BatteryStatus, show)
rospy.spin()
