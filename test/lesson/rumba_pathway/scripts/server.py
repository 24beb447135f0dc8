#!/usr/bin/env python3
"""The server of the lesson: answers the heading that points away from the target, and a speed to back up to it."""

import math

import rospy
from turtlesim.msg import Pose

from rumba_msg.srv import TargetPosition, TargetPositionResponse

pose = Pose()


def take(newest):
    """Keep the newest pose."""
    global pose
    pose = newest


def answer(target):
    """Answer a call."""
    heading = math.atan2(pose.y - target.target_y, pose.x - target.target_x)
    return TargetPositionResponse(-1.0, heading, True, 'from Python')


rospy.init_node('server')
rospy.Subscriber('turtle1/pose', Pose, take, queue_size=1)
rospy.Service('go_to_position', TargetPosition, answer)
rospy.spin()
