#!/usr/bin/env python3
"""A Patrol arrives with all nested messages, also at a subscriber that comes later."""

import unittest

import rospy
import rostest

from patrol_plan.msg import Patrol


class PatrolPlanTest(unittest.TestCase):
    """The launch file of the lesson runs."""

    def test_what_is_nested(self):
        patrol = rospy.wait_for_message('patrol', Patrol, timeout=30.0)
        self.assertEqual([(pose.position.x, pose.position.y, pose.orientation.w) for pose in patrol.waypoints.poses],
                         [(1.0, 2.0, 1.0), (3.0, 0.5, 1.0)])
        self.assertEqual([speed.linear.x for speed in patrol.speeds], [0.25, 0.125])
        self.assertEqual((patrol.header.frame_id, patrol.waypoints.header.frame_id), ('map', 'map'))
        battery = patrol.battery
        self.assertEqual((battery.percentage_battery, battery.debug_message), (97, 'enough for the patrol'))
        self.assertLess(abs((rospy.Time.now() - patrol.header.stamp).to_sec()), 60.0)


if __name__ == '__main__':
    rospy.init_node('test_patrol_plan')
    rostest.rosrun('patrol_plan', 'patrol_plan', PatrolPlanTest)
