#!/usr/bin/env python3
"""A thermometer with a small error; publishes its readings on sensor_topic, twice a second.

Parameters: ~id; ~sensor_name; ~temperature [degC], the reading without the error.
"""

import random

import rospy

from thermometer.msg import Reading

ERROR = 0.1  # [degC], standard deviation


def main():
    rospy.init_node('sensor_publisher', anonymous=True)
    publisher = rospy.Publisher('sensor_topic', Reading, queue_size=10)
    reading = Reading(id=rospy.get_param('~id', 1), name=rospy.get_param('~sensor_name', 'room'))
    temperature = rospy.get_param('~temperature', 21.5)
    rate = rospy.Rate(2)
    while not rospy.is_shutdown():
        reading.header.stamp = rospy.Time.now()
        reading.temperature = random.gauss(temperature, ERROR)
        publisher.publish(reading)
        rate.sleep()


if __name__ == '__main__':
    try:
        main()
    except rospy.ROSInterruptException:  # Ctrl-C during rate.sleep()
        pass
