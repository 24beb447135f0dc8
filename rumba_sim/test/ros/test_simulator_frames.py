#!/usr/bin/env python3
"""The simulator's frames in tf2, and the drift of odometry."""

import math
import os
import unittest

import rospy
import rostest
from simulators import Heard, Simulator, wait
from tf2_msgs.msg import TFMessage


def pose_of(transform):
    """x, y and heading of a transform."""
    place, turn = transform.transform.translation, transform.transform.rotation
    return place.x, place.y, 2.0 * math.atan2(turn.z, turn.w)


def pose_in(odometry):
    """x, y and heading of an odometry message."""
    place, turn = odometry.pose.pose.position, odometry.pose.pose.orientation
    return place.x, place.y, 2.0 * math.atan2(turn.z, turn.w)


@unittest.skipIf('RUMBA_PLATFORM' in os.environ, 'tf2_py is compiled for the Python of the system alone')
class SimulatorFramesTest(unittest.TestCase):
    """A simulator for each test, on the empty field."""

    def start(self, *arguments):
        """A paused simulator, and the odometry and ground truth of its robot."""
        simulator = Simulator(self, '_map:=field', '_speed:=10', '_rates/ground_truth:=50',
                              '_drive/command_timeout:=60', *arguments)
        self.truth, self.odom = Heard(self, '/rumba/ground_truth'), Heard(self, '/rumba/odom')
        self.transforms = Heard(self, '/tf', TFMessage)
        wait(self, lambda: self.truth.messages and self.odom.messages and self.transforms.messages)
        simulator.pause()
        return simulator

    def listen(self):
        """Gather all transforms from now on; time must not be reset."""
        import tf2_ros
        self.buffer = tf2_ros.Buffer()
        listener = tf2_ros.TransformListener(self.buffer)
        self.addCleanup(listener.unregister)

    def lookup(self, frame, child, stamp):
        """x, y and heading of a child frame."""
        wait(self, lambda: self.buffer.can_transform(frame, child, stamp), f'{frame} -> {child}')
        return pose_of(self.buffer.lookup_transform(frame, child, stamp))

    def assert_near(self, pose, other):
        for value, wanted in zip(pose, other):
            self.assertAlmostEqual(math.remainder(value - wanted, 2.0 * math.pi), 0.0, delta=1e-6)

    def test_tf_agrees_with_odom_and_ground_truth_also_while_driving(self):
        simulator = self.start('_odometry/scale_error:=0.05')
        self.listen()
        simulator.drive(0.4, 0.6, self.truth)
        begin = self.truth.at(simulator.ticks).header.stamp
        for _ in range(10):
            simulator.step(37)
            truth, odom = self.truth.at(simulator.ticks), self.odom.at(simulator.ticks)
            stamp = truth.header.stamp
            self.assert_near(self.lookup('odom', 'base_footprint', stamp), pose_in(odom))
            self.assert_near(self.lookup('map', 'base_footprint', stamp), pose_in(truth))
        # Left turns are positive. Odometry has an error, but a small one: 3.3 m were driven on a floor with slip.
        self.assertGreater(truth.twist.twist.angular.z, 0.59)
        self.assertAlmostEqual(odom.twist.twist.angular.z, 0.6, delta=0.35)
        self.assertAlmostEqual(odom.twist.twist.linear.x, 0.4 / 0.98, delta=0.1)
        self.assertGreater(odom.pose.covariance[0], 1e-6)
        first, last = self.lookup('map', 'odom', begin), self.lookup('map', 'odom', stamp)
        self.assertGreater(math.hypot(first[0] - last[0], first[1] - last[1]), 1e-3)

    def test_a_robot_turns_left_if_its_right_wheel_is_faster(self):
        """Odometry with no error but slip is the truth, longer by 1 / 0.98."""
        simulator = self.start('_odometry/scale_error:=0', '_odometry/noise:=0')
        simulator.drive(0.3, 0.5, self.truth)
        simulator.step(100)
        truth, odom = pose_in(self.truth.at(simulator.ticks)), pose_in(self.odom.at(simulator.ticks))
        self.assertGreater(truth[1], 5.544444 + 0.2)
        self.assertAlmostEqual(odom[2] * 0.98, truth[2], delta=0.01)
        self.assertAlmostEqual(odom[0], truth[0] - 5.544444, delta=0.03)
        self.assertAlmostEqual(odom[1], truth[1] - 5.544444, delta=0.03)

    def test_the_drift_of_odometry_depends_on_the_seed(self):
        found = []
        for seed in (7, 7, 8):
            simulator = self.start(f'_seed:={seed}')
            simulator.drive(0.4, 0.3, self.truth)
            simulator.step(300)
            odom, truth = self.odom.at(simulator.ticks), self.truth.at(simulator.ticks)
            found.append((pose_in(truth), pose_in(odom), odom.twist.twist))
            simulator.end()
        self.assertEqual(found[0], found[1])
        self.assertEqual(found[0][0], found[2][0])
        self.assertNotEqual(found[0][1], found[2][1])

    def test_each_of_two_robots_has_its_own_frames(self):
        simulator = self.start('_robots:=2')
        self.listen()
        second = Heard(self, '/rumba2/ground_truth')
        scan = Heard(self, '/rumba2/scan')
        static = Heard(self, '/tf_static', TFMessage)
        # A publisher tells a subscriber that it is connected a moment before it counts it.
        wait(self, lambda: simulator.step(50) or scan.messages, 'a scan')
        truth = second.at(simulator.ticks)
        self.assert_near(self.lookup('map', 'rumba2/base_footprint', truth.header.stamp), pose_in(truth))
        self.assert_near(self.lookup('map', 'base_footprint', truth.header.stamp),
                         pose_in(self.truth.at(simulator.ticks)))
        self.assertEqual([(part.child_frame_id, part.transform.translation.z)
                          for part in static.find().transforms if part.header.frame_id[:4] == 'base'],
                         [('base_link', 0.036), ('laser', 0.07)])
        self.assertEqual((truth.child_frame_id, scan.find().header.frame_id), ('rumba2/base_footprint', 'rumba2/laser'))
        frames = {(part.header.frame_id, part.child_frame_id) for heard in (static, self.transforms)
                  for message in heard.messages for part in message.transforms}
        self.assertEqual(frames, {(*pair,) for prefix in ('', 'rumba2/') for pair in (
            ('map', prefix + 'odom'), (prefix + 'odom', prefix + 'base_footprint'),
            (prefix + 'base_footprint', prefix + 'base_link'), (prefix + 'base_link', prefix + 'laser'))})

    def test_without_localisation_odometry_is_not_corrected(self):
        simulator = self.start('_localisation:=none')
        self.listen()
        simulator.step(10)
        self.lookup('odom', 'base_footprint', self.odom.at(simulator.ticks).header.stamp)
        self.assertEqual({(part.header.frame_id, part.child_frame_id) for message in self.transforms.messages
                          for part in message.transforms}, {('odom', 'base_footprint')})


if __name__ == '__main__':
    rospy.init_node('test_simulator_frames')
    rostest.rosrun('rumba_sim', 'simulator_frames', SimulatorFramesTest)
