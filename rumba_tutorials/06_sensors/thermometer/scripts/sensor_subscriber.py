#!/usr/bin/env python3
"""Logs the readings on sensor_topic: those above ~limit [degC] as warnings, those of a failed sensor as errors."""

import math

import rospy

from thermometer.msg import Reading


def sensor_callback(reading, limit):
    said = f'sensor {reading.id}, {reading.name}: {reading.temperature:.1f} degC'
    if math.isnan(reading.temperature):
        rospy.logerr('sensor %d, %s: failed', reading.id, reading.name)
    elif reading.temperature > limit:
        rospy.logwarn('%s, more than %.1f', said, limit)
    else:
        rospy.loginfo(said)


rospy.init_node('sensor_subscriber', anonymous=True)
rospy.Subscriber('sensor_topic', Reading, sensor_callback, callback_args=rospy.get_param('~limit', 40.0))
rospy.spin()
