#!/usr/bin/env python3
"""The node mapper makes the map that the simulator does not tell, finds its place on it, and saves it."""

import math
import os
import unittest

import rospy
import rostest
from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped, Twist
from localisers import Mapper
from nav_msgs.msg import OccupancyGrid
from sensor_msgs.msg import LaserScan
from simulators import Heard, Simulator, folder_of, shared, wait
from std_srvs.srv import Trigger
from tf2_msgs.msg import TFMessage

from rumba_sim.model.common.geometry import Pose, compose, inverse
from rumba_sim.model.maps import map_file, named_maps
from rumba_sim.ros.common.conversions import heading, plane_pose

CLOSE = 0.05  # [m], [rad]


class MapperNodeTest(unittest.TestCase):
    """One simulator that tells no map, and one mapper; the robot is on its dock at first."""

    @classmethod
    def setUpClass(cls):
        """Start both, and have the robot drive once it has learnt where its dock is."""
        test = shared(cls)
        cls.path = str(folder_of(test, {}) / 'home.yaml')
        cls.simulator = Simulator(test, '_map:=studio', '_speed:=5', '_localisation:=slam', '_seed:=2')
        cls.truth, cls.odom = Heard(test, '/rumba/ground_truth'), Heard(test, '/rumba/odom')
        cls.start = plane_pose(cls.truth.find().pose.pose)
        Mapper(test, f'_map_file:={cls.path}')
        cls.map, cls.tf = Heard(test, '/map', OccupancyGrid), Heard(test, '/tf', TFMessage)
        cls.static = Heard(test, '/tf_static', TFMessage)
        cls.pose = Heard(test, '/rumba/amcl_pose', PoseWithCovarianceStamped)
        cls.dock = Heard(test, '/rumba/dock_pose', PoseStamped)
        cls.first = cls.map.find()
        cls.dock.find()
        wheels = rospy.Publisher('/rumba/cmd_vel', Twist, queue_size=1)
        wait(test, wheels.get_num_connections, 'the simulator to listen to cmd_vel')
        twist = Twist()
        twist.linear.x, twist.angular.z = -0.1, -0.6
        timer = rospy.Timer(rospy.Duration(0.2), lambda _: wheels.publish(twist))
        test.addCleanup(timer.shutdown)

    def off(self, message):
        """Distance [m] and angle [rad] from a pose that was told to the true one; None before that comes."""
        true = next((each for each in self.truth.messages[:] if each.header.stamp == message.header.stamp), None)
        if true is None:
            return None
        told = compose(self.start, plane_pose(message.pose.pose))
        apart = compose(inverse(plane_pose(true.pose.pose)), told)
        return math.hypot(apart.x, apart.y), abs(apart.theta)

    def moved(self):
        """A pose that was told after the robot had left its dock."""
        return self.pose.fresh(lambda message: math.hypot(*plane_pose(message.pose.pose)[:2]) > 0.1)

    def test_the_map_grows_and_nobody_else_tells_one(self):
        self.assertEqual(self.first.header.frame_id, 'map')
        self.assertEqual({0, 100, -1}, set(self.first.data))
        grown = self.map.find(lambda message: message.data.count(0) > 1.05 * self.first.data.count(0))
        self.assertEqual(len(grown.data), grown.info.width * grown.info.height)
        self.assertEqual({'/mapper'}, {message._connection_header['callerid'] for message in self.map.messages})

    def test_the_pose_is_true(self):
        message = self.moved()
        self.assertEqual(message.header.frame_id, 'map')
        self.assertLess(max(wait(self, lambda: self.off(message), 'ground_truth')), CLOSE)

    def test_tf_leads_from_the_map_to_the_robot(self):
        found = self.moved()
        stamp = found.header.stamp
        link = wait(self, lambda: next((
            each for message in self.tf.messages[:] for each in message.transforms
            if (each.header.frame_id, each.child_frame_id, each.header.stamp) == ('map', 'odom', stamp)), None), 'tf')
        moved = link.transform.translation
        odometry = plane_pose(self.odom.find(lambda each: each.header.stamp == stamp).pose.pose)
        pose = compose(Pose(moved.x, moved.y, heading(link.transform.rotation)), odometry)
        for a, b in zip(pose, plane_pose(found.pose.pose)):
            self.assertAlmostEqual(a, b, 6)

    def test_the_dock_is_where_the_robot_began(self):
        self.assertLess(max(map(abs, plane_pose(self.dock.find().pose))), CLOSE)

    def test_the_map_is_saved_with_the_dock(self):
        self.moved()
        answer = rospy.ServiceProxy('/mapper/save_map', Trigger)()
        self.assertTrue(answer.success, answer.message)
        self.assertEqual(os.path.realpath(answer.message), os.path.realpath(self.path))
        plan = map_file.load(self.path)
        self.assertLess(max(map(abs, plan.dock)), CLOSE)
        self.assertGreater(plan.clearance_at(-0.5, 0.0), 0.15)

    def test_onlookers_learn_the_true_map_and_where_that_of_the_robot_is_in_it(self):
        true, home = Heard(self, '/simulator/map', OccupancyGrid).find(), map_file.load(named_maps.path('studio'))
        self.assertEqual((true.header.frame_id, list(true.data)), ('world', home.occupancy.ravel().tolist()))
        self.assertEqual(self.truth.find().header.frame_id, 'world')
        link = wait(self, lambda: next((each for message in self.static.messages[:] for each in message.transforms
                                        if each.child_frame_id == 'map'), None), 'world -> map')
        moved = link.transform.translation
        self.assertEqual(link.header.frame_id, 'world')
        for a, b in zip((moved.x, moved.y, heading(link.transform.rotation)), self.start):
            self.assertAlmostEqual(a, b, 6)

    def test_a_scan_that_makes_no_sense_is_ignored(self):
        log = Heard(self, '/rosout')
        scans = rospy.Publisher('/rumba/scan', LaserScan, queue_size=5)
        self.addCleanup(scans.unregister)
        wait(self, scans.get_num_connections, 'the mapper to listen')

        def is_said():
            scan = LaserScan(angle_min=math.nan, range_max=8.0, ranges=[1.0] * 9)
            scan.header.stamp = self.odom.fresh().header.stamp
            scans.publish(scan)
            return any(each.msg == 'rumba/scan: angle_min is nan: must be a number; ignored'
                       for each in log.messages[:])
        wait(self, is_said, 'a complaint')
        self.moved()


if __name__ == '__main__':
    rospy.init_node('test_mapper_node')
    rostest.rosrun('rumba_localisation', 'mapper', MapperNodeTest)
