#!/usr/bin/env python3
"""Reports each contact of a bumper: prints it, and publishes it on contact_report, latched.

Listens to rumba/bumper and rumba/odom.
"""

import collections
import math

import rospy
from nav_msgs.msg import Odometry

from contact_report.msg import ContactReport
from rumba_msg.msg import Bumper

SIDES = {(True, False): 'left', (False, True): 'right', (True, True): 'front'}
MEMORY = rospy.Duration(1.0)  # the robot has slowed down already when the contact is heard of


class ContactWatch:
    """Tells the beginning of a contact from its going on."""

    def __init__(self):
        self.count = 0
        self.is_touching = None  # nothing was heard yet
        self.speeds = collections.deque()  # (stamp, speed ahead [m/s]) of the last second
        self.publisher = rospy.Publisher('contact_report', ContactReport, queue_size=10, latch=True)
        rospy.Subscriber('rumba/odom', Odometry, self.hear_odom)
        rospy.Subscriber('rumba/bumper', Bumper, self.hear_bumper)

    def hear_odom(self, odom):
        self.speeds.append((odom.header.stamp, odom.twist.twist.linear.x))
        while self.speeds[0][0] < odom.header.stamp - MEMORY:
            self.speeds.popleft()

    def hear_bumper(self, bumper):
        if self.is_touching is None:
            rospy.loginfo('the bumper is there')
        side = SIDES.get((bumper.is_left_pressed, bumper.is_right_pressed))
        if side and not self.is_touching:
            self.report(bumper.header, side)
        self.is_touching = side is not None

    def report(self, header, side):
        self.count += 1
        speed = max((speed for _, speed in list(self.speeds)), default=math.nan)
        rospy.loginfo('contact %d: %s, at %.2f m/s', self.count, side, speed)
        self.publisher.publish(header=header, count=self.count, side=side, speed=speed)


rospy.init_node('contact')
ContactWatch()
rospy.spin()
