#!/usr/bin/env python3
"""Reports each contact of a bumper: prints it, and publishes it on the latched topic contact_report.

Subscribes to rumba/bumper and rumba/odom.
"""

import collections
import math

import rospy
from nav_msgs.msg import Odometry

from contact_report.msg import ContactReport
from rumba_msg.msg import Bumper

SIDES = {(True, False): 'left', (False, True): 'right', (True, True): 'front'}
MEMORY = rospy.Duration(1.0)  # when the message of the contact comes, the robot has already slowed down


class ContactWatch:
    """Detects the beginning of each contact."""

    def __init__(self):
        self.count = 0
        self.is_touching = None  # None: no reading yet
        self.speeds = collections.deque()  # (stamp, forward speed [m/s]) of the last second
        self.publisher = rospy.Publisher('contact_report', ContactReport, queue_size=10, latch=True)
        rospy.Subscriber('rumba/odom', Odometry, self.on_odom)
        rospy.Subscriber('rumba/bumper', Bumper, self.on_bumper)

    def on_odom(self, odom):
        self.speeds.append((odom.header.stamp, odom.twist.twist.linear.x))
        while self.speeds[0][0] < odom.header.stamp - MEMORY:
            self.speeds.popleft()

    def on_bumper(self, bumper):
        if self.is_touching is None:
            rospy.loginfo('first reading of the bumper')
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
