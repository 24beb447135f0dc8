#!/usr/bin/env python3
"""The controller of the lesson: turns to the heading that the server answers, then drives with the speed beside it.

Reads targets from the terminal, X Y THETA in a line, and prints where the turtle stands after each. A turtle that the
machine was too busy to stop in time has left its target again: it is sent back.
"""

import math
import queue
import sys

import rospy
from geometry_msgs.msg import Twist
from turtlesim.msg import Pose

from rumba_msg.srv import TargetPosition


def newest():
    """Wait for the next pose."""
    while not poses.empty():
        poses.get()
    return poses.get()


def step(target, pose):
    """Ask the server, and command the turtle; returns whether it is there."""
    answer = ask(*target)
    if not answer.feedback:
        return False
    away = math.hypot(target[0] - pose.x, target[1] - pose.y)
    is_aligned = abs(pose.theta - answer.angular_z) < threshold
    is_there = is_aligned and away < threshold
    twist = Twist()
    if not is_aligned:
        twist.angular.z = 1.0
    elif not is_there:
        twist.linear.x = answer.linear_x
    wheels.publish(twist)
    return is_there


rospy.init_node('controller')
poses = queue.Queue()
rospy.Subscriber('turtle1/pose', Pose, poses.put, queue_size=1)
wheels = rospy.Publisher('turtle1/cmd_vel', Twist, queue_size=1)
ask = rospy.ServiceProxy('go_to_position', TargetPosition)
ask.wait_for_service()
threshold = rospy.get_param('/threshold_parameter')
for line in sys.stdin:
    position = [float(word) for word in line.split()]
    place = newest()
    while not step(position, place) or place.linear_velocity or place.angular_velocity:
        place = newest()
    print('at', place.x, place.y, flush=True)
