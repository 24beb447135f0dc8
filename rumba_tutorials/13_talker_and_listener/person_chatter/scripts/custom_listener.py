#!/usr/bin/env python3
"""Prints each Person that arrives on custom_chatter."""

import rospy

from person_chatter.msg import Person


def show(person):
    rospy.loginfo('%s is %d years old', person.name, person.age)


rospy.init_node('custom_listener', anonymous=True)
rospy.Subscriber('custom_chatter', Person, show)
rospy.spin()
