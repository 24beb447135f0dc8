"""Packed messages are those that their definitions describe."""

import io
import math

import rospy
from nav_msgs.msg import Odometry
from tf2_msgs.msg import TFMessage

from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.simulation.robot import Twist
from rumba_sim.ros.robot.packed import OdometryPacker, TransformPacker, transforms

STAMP = rospy.Time(12, 34)


def unpacked(message, kind):
    """What a subscriber gets; exactly so many bytes as the definition has."""
    buffer, again = io.BytesIO(), io.BytesIO()
    message.serialize(buffer)
    found = kind().deserialize(buffer.getvalue())
    found.serialize(again)
    assert again.getvalue() == buffer.getvalue()
    return found


def test_odometry_has_pose_twist_and_variances_in_the_right_fields():
    packer = OdometryPacker('map', 'base')
    packer.message(STAMP, Pose(0.0, 0.0, 0.0), Twist(0.0, 0.0))
    message = unpacked(packer.message(STAMP, Pose(1.0, -2.0, 0.5), Twist(0.3, -0.7), (0.01, 0.02), (0.03, 0.04)),
                       Odometry)
    assert (message.header.seq, message.header.stamp, message.header.frame_id) == (2, STAMP, 'map')
    assert message.child_frame_id == 'base'
    position, rotation = message.pose.pose.position, message.pose.pose.orientation
    assert (position.x, position.y, position.z) == (1.0, -2.0, 0.0)
    assert (rotation.x, rotation.y, rotation.z, rotation.w) == (0.0, 0.0, math.sin(0.25), math.cos(0.25))
    linear, angular = message.twist.twist.linear, message.twist.twist.angular
    assert (linear.x, linear.y, linear.z, angular.x, angular.y, angular.z) == (0.3, 0.0, 0.0, 0.0, 0.0, -0.7)
    diagonals = [[part.covariance[7 * place] for place in range(6)] for part in (message.pose, message.twist)]
    assert diagonals == [[0.01, 0.01, 1e-6, 1e-6, 1e-6, 0.02], [0.03, 0.03, 1e-6, 1e-6, 1e-6, 0.04]]
    assert [sum(map(bool, part.covariance)) for part in (message.pose, message.twist)] == [6, 6]


def test_transforms_have_frames_position_and_heading():
    first, second = TransformPacker('map', 'odom'), TransformPacker('odom', 'base')
    message = unpacked(transforms([first.part(STAMP, Pose(1.0, 2.0, 0.5)), second.part(STAMP, Pose(3.0, 4.0, 0.0))]),
                       TFMessage)
    assert [(each.header.frame_id, each.child_frame_id, each.header.stamp) for each in message.transforms] == [
        ('map', 'odom', STAMP), ('odom', 'base', STAMP)]
    moved, turned = message.transforms[0].transform.translation, message.transforms[0].transform.rotation
    assert (moved.x, moved.y, moved.z) == (1.0, 2.0, 0.0)
    assert (turned.x, turned.y, turned.z, turned.w) == (0.0, 0.0, math.sin(0.25), math.cos(0.25))
    assert message.transforms[1].transform.translation.x == 3.0


def test_a_message_may_have_no_transforms():
    assert unpacked(transforms([]), TFMessage).transforms == []
