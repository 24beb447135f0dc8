#!/usr/bin/env python3
"""Publishes a Person on custom_chatter, ten times a second."""

import rospy

from person_chatter.msg import Person


def main():
    rospy.init_node('custom_talker', anonymous=True)
    publisher = rospy.Publisher('custom_chatter', Person, queue_size=10)
    rate = rospy.Rate(10)
    while not rospy.is_shutdown():
        publisher.publish(Person(name='Ada', age=36))
        rate.sleep()


if __name__ == '__main__':
    try:
        main()
    except rospy.ROSInterruptException:  # Ctrl-C during rate.sleep()
        pass
