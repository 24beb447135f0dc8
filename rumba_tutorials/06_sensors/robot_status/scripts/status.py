#!/usr/bin/env python3
"""Puts together the status of a robot on robot_status, from its battery on rumba/battery_state.

Parameter: ~lowest [V], below which the battery is low.
"""

import rospy
from sensor_msgs.msg import BatteryState

from robot_status.msg import BatteryStatus, RobotStatus, SystemStatus


def report(state, publisher, lowest):
    """Publish one status for one state of the battery."""
    status = RobotStatus(header=state.header, battery=BatteryStatus(state.current, state.voltage))
    if state.voltage < lowest:
        status.system = SystemStatus(SystemStatus.LOW_BATTERY, f'{state.voltage:.1f} V is below {lowest:.1f} V')
    publisher.publish(status)


rospy.init_node('status')
robot_status = rospy.Publisher('robot_status', RobotStatus, queue_size=10)
rospy.Subscriber('rumba/battery_state', BatteryState,
                 lambda state: report(state, robot_status, rospy.get_param('~lowest', 13.0)))
rospy.spin()
