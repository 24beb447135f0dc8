#!/usr/bin/env python3
"""Publishes one Patrol on patrol; the topic is latched, so that later subscribers receive it too."""

import rospy
from geometry_msgs.msg import Point, Pose, PoseArray, Quaternion, Twist, Vector3
from std_msgs.msg import Header

from patrol_plan.msg import Patrol
from rumba_msg.msg import BatteryStatus

WAYPOINTS = [(1.0, 2.0), (3.0, 0.5)]  # [m] in the map frame
SPEEDS = [0.25, 0.125]  # [m/s]


def plan(stamp):
    header = Header(stamp=stamp, frame_id='map')
    poses = [Pose(Point(x, y, 0.0), Quaternion(w=1.0)) for x, y in WAYPOINTS]
    speeds = [Twist(linear=Vector3(x=speed)) for speed in SPEEDS]
    battery = BatteryStatus(percentage_battery=97, debug_message='enough for the patrol')
    return Patrol(header=header, waypoints=PoseArray(header, poses), speeds=speeds, battery=battery)


rospy.init_node('plan')
publisher = rospy.Publisher('patrol', Patrol, queue_size=1, latch=True)
publisher.publish(plan(rospy.Time.now()))
rospy.loginfo('a patrol of %d waypoints', len(WAYPOINTS))
rospy.spin()
