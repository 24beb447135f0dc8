#!/usr/bin/env python3
"""The node localiser finds robots of a simulator, obeys a person, and bears messages that make no sense."""

import math
import unittest

import rospy
import rostest
from geometry_msgs.msg import PoseArray, PoseWithCovarianceStamped, Twist
from localisers import Localiser
from nav_msgs.msg import OccupancyGrid
from sensor_msgs.msg import LaserScan
from simulators import Heard, Simulator, shared, wait
from std_srvs.srv import Empty
from tf2_msgs.msg import TFMessage

from rumba_localisation.ros.conversions import pose_with_covariance
from rumba_sim.model.common.geometry import Pose, compose
from rumba_sim.ros.common.conversions import heading, plane_pose

CLOSE = 0.03  # [m], [rad]


class LocaliserNodeTest(unittest.TestCase):
    """One simulator and one localiser, which was told nothing."""

    @classmethod
    def setUpClass(cls):
        """Start both."""
        test = shared(cls)
        cls.simulator = Simulator(test, '_map:=studio', '_speed:=5', '_localisation:=none', '_seed:=2')
        Localiser(test)
        cls.pose = Heard(test, '/rumba/amcl_pose', PoseWithCovarianceStamped)
        cls.truth, cls.odom = Heard(test, '/rumba/ground_truth'), Heard(test, '/rumba/odom')
        cls.cloud, cls.tf = Heard(test, '/rumba/particlecloud', PoseArray), Heard(test, '/tf', TFMessage)
        cls.start = rospy.Publisher('/rumba/initialpose', PoseWithCovarianceStamped, queue_size=1)
        wait(test, cls.start.get_num_connections, 'the localiser to listen to initialpose')
        cls.wheels = rospy.Publisher('/rumba/cmd_vel', Twist, queue_size=1)
        wait(test, cls.wheels.get_num_connections, 'the simulator to listen to cmd_vel')

    def off(self, message):
        """Distance [m] and angle [rad] from a pose that was told to the true one; None before that comes."""
        true = next((each for each in self.truth.messages[:] if each.header.stamp == message.header.stamp), None)
        if true is None:
            return None
        told, pose = plane_pose(message.pose.pose), plane_pose(true.pose.pose)
        return math.hypot(told.x - pose.x, told.y - pose.y), abs(math.remainder(told.theta - pose.theta, math.tau))

    def is_found(self, message):
        """Whether a pose that was told is the true one, and is told to be certain."""
        off = self.off(message)
        return off is not None and max(off) < CLOSE and message.pose.covariance[0] < CLOSE ** 2

    def moves(self):
        """Drive in a small circle until the end of the test."""
        twist = Twist()
        twist.linear.x, twist.angular.z = 0.1, 1.0
        timer = rospy.Timer(rospy.Duration(0.2), lambda _: self.wheels.publish(twist))
        self.addCleanup(timer.shutdown)

    def test_a_robot_that_was_told_nothing_is_found(self):
        self.simulator.teleport(2.0, 2.0, 1.0)
        rospy.ServiceProxy('/rumba/global_localization', Empty)()
        self.moves()
        message = self.pose.fresh(self.is_found)
        self.assertEqual(message.header.frame_id, 'map')

    def test_tf_leads_from_the_map_to_the_robot(self):
        self.moves()
        found = self.pose.fresh(self.is_found)
        stamp = found.header.stamp
        link = wait(self, lambda: next((
            each for message in self.tf.messages[:] for each in message.transforms
            if (each.header.frame_id, each.child_frame_id, each.header.stamp) == ('map', 'odom', stamp)), None), 'tf')
        moved = link.transform.translation
        odometry = plane_pose(self.odom.find(lambda each: each.header.stamp == stamp).pose.pose)
        pose = compose(Pose(moved.x, moved.y, heading(link.transform.rotation)), odometry)
        told = plane_pose(found.pose.pose)
        self.assertLess(max(abs(math.remainder(a - b, math.tau)) for a, b in zip(pose, told)), 1e-6)

    def test_a_robot_that_is_told_a_wrong_place_with_doubt_finds_the_right_one(self):
        self.moves()
        true = plane_pose(self.truth.fresh().pose.pose)
        wide = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.3]]
        self.start.publish(pose_with_covariance(Pose(true.x + 0.3, true.y - 0.2, true.theta + 0.2), wide,
                                                self.pose.fresh().header))
        self.pose.fresh()
        self.pose.fresh(self.is_found)

    def test_a_robot_that_is_carried_away_is_lost_and_found_again(self):
        self.moves()
        self.pose.fresh(self.is_found)
        self.simulator.teleport(1.0, 3.0, 0.5)  # too far away for wheels that slipped
        self.pose.fresh(lambda message: message.pose.covariance[0] > 0.2)
        self.pose.fresh(self.is_found)

    def test_particles_are_where_the_robot_is(self):
        self.moves()
        self.pose.fresh(self.is_found)
        cloud = self.cloud.fresh()
        self.assertEqual(cloud.header.frame_id, 'map')
        self.assertGreater(len(cloud.poses), 100)
        true = plane_pose(self.truth.fresh().pose.pose)
        near = [each for each in cloud.poses if math.hypot(each.position.x - true.x, each.position.y - true.y) < 0.5]
        self.assertGreater(len(near), 0.9 * len(cloud.poses))

    def test_what_makes_no_sense_is_ignored(self):
        self.moves()
        log = Heard(self, '/rosout')
        for pose in (Pose(math.nan, 1.0, 0.0), Pose(1.0, math.inf, 0.0)):
            self.start.publish(pose_with_covariance(pose, [[0.1, 0, 0], [0, 0.1, 0], [0, 0, 0.1]],
                                                    self.pose.fresh().header))
        log.find(lambda message: message.msg == 'initialpose: must be a finite pose in the frame map with a '
                                                'covariance; ignored')
        scans = rospy.Publisher('/rumba/scan', LaserScan, queue_size=5)
        maps = rospy.Publisher('/map', OccupancyGrid, queue_size=5)
        for publisher in (scans, maps):
            self.addCleanup(publisher.unregister)
            wait(self, publisher.get_num_connections, 'the localiser to listen')
        stamp = self.odom.fresh().header.stamp
        for scan in (LaserScan(), LaserScan(angle_min=math.nan, ranges=[1.0] * 9),
                     LaserScan(angle_increment=math.inf, ranges=[math.nan, -1.0, 1e30])):
            scan.header.stamp = stamp
            scans.publish(scan)
        maps.publish(OccupancyGrid())
        log.find(lambda message: message.msg == 'map: 0 cells: must be width * height, 0 * 0; ignored')
        self.pose.fresh(self.is_found)


if __name__ == '__main__':
    rospy.init_node('test_localiser_node')
    rostest.rosrun('rumba_localisation', 'localiser', LocaliserNodeTest)
