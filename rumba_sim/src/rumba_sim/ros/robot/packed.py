"""The messages of every tick, packed at once: making objects of all their fields takes longer than the tick itself."""

import itertools
import struct
from typing import Any, List, Sequence

import rospy

from rumba_sim.model.common.geometry import Pose, half_angle
from rumba_sim.model.simulation.robot import Robot, Twist
from rumba_sim.model.simulation.world import World
from rumba_sim.ros.common import conversions
from rumba_sim.ros.participants.examiner_frames import serialised

KNOWN = 1e-6  # variance of what is known: a robot on a floor does not rise, roll or pitch
HEADER = struct.Struct('<3I')  # number of the message, and stamp [s], [ns]; then comes the frame
ODOMETRY = struct.Struct('<85d')  # pose (3 + 4), covariance (36), twist (3 + 3), covariance (36); after the child
TRANSFORM = struct.Struct('<7d')  # translation (3), rotation (4); after the child
LENGTH = struct.Struct('<I')
CODES = {'bool': 'B', 'uint8': 'B', 'float32': 'f', 'float64': 'd'}  # of struct


class OdometryPacker:
    """Makes the messages of nav_msgs/Odometry of one topic, and numbers them as rospy does."""

    def __init__(self, frame: str, child: str) -> None:
        """Tell poses of a child frame in a frame."""
        self._names = _text(frame) + _text(child)
        self._count = 0

    def message(self, stamp: rospy.Time, pose: Pose, twist: Twist, pose_variance: Sequence[float] = (0.0, 0.0),
                twist_variance: Sequence[float] = (0.0, 0.0)) -> rospy.AnyMsg:
        """Pose in the frame and velocity in the child's, with variances of position [m^2] and heading [rad^2]."""
        self._count += 1
        numbers = ODOMETRY.pack(
            pose.x, pose.y, 0.0, 0.0, 0.0, *half_angle(pose.theta), *_covariance(*pose_variance),
            twist.v, 0.0, 0.0, 0.0, 0.0, twist.w, *_covariance(*twist_variance))
        return _message(HEADER.pack(self._count, stamp.secs, stamp.nsecs) + self._names + numbers)


def odometry_message(packer: OdometryPacker, world: World, robot: Robot, stamp: rospy.Time) -> rospy.AnyMsg:
    """What the encoders of a robot tell of its pose and velocity, with their errors."""
    config, tick, twist = robot.config, 1.0 / world.step_rate, robot.odometry_twist
    wheel_base = config.drive.wheel_base
    distance = abs(twist.v) * tick
    return packer.message(
        stamp, robot.odometry, twist, conversions.odometry_variance(robot.distance, config.odometry, wheel_base),
        [variance / tick ** 2 for variance in conversions.odometry_variance(distance, config.odometry, wheel_base)])


class NumbersPacker:
    """Makes messages of a kind that begins with a header and numbers; what comes after these stays as it is.

    Attributes:
        names: of the numbers, in their order.
    """

    def __init__(self, example: Any) -> None:
        """Make messages that have the frame of an example, and what comes after its numbers."""
        kinds = list(itertools.takewhile(CODES.__contains__, example._slot_types[1:]))
        self.names = example.__slots__[1:1 + len(kinds)]
        self._numbers = struct.Struct('<' + ''.join(map(CODES.__getitem__, kinds)))
        self._frame = _text(example.header.frame_id)
        self._rest = serialised(example)[HEADER.size + len(self._frame) + self._numbers.size:]
        self._count = 0

    def message(self, stamp: rospy.Time, *numbers: float) -> rospy.AnyMsg:
        """Such a message."""
        self._count += 1
        return _message(HEADER.pack(self._count, stamp.secs, stamp.nsecs) + self._frame
                        + self._numbers.pack(*numbers) + self._rest)


class TransformPacker:
    """Makes the parts of tf2_msgs/TFMessage of one child frame in a frame."""

    def __init__(self, frame: str, child: str) -> None:
        """Tell poses of a child frame in a frame."""
        self._names = _text(frame) + _text(child)

    def part(self, stamp: rospy.Time, pose: Pose) -> bytes:
        """A geometry_msgs/TransformStamped."""
        numbers = TRANSFORM.pack(pose.x, pose.y, 0.0, 0.0, 0.0, *half_angle(pose.theta))
        return HEADER.pack(0, stamp.secs, stamp.nsecs) + self._names + numbers


def transforms(parts: List[bytes]) -> rospy.AnyMsg:
    """A tf2_msgs/TFMessage of parts."""
    return _message(LENGTH.pack(len(parts)) + b''.join(parts))


def _message(content: bytes) -> rospy.AnyMsg:
    message = rospy.AnyMsg()
    message._buff = content  # rospy sends it as it is
    return message


def _text(text: str) -> bytes:
    content = text.encode()
    return LENGTH.pack(len(content)) + content


def _covariance(position: float, heading: float) -> List[float]:
    """Row-major 6 x 6 over x, y, z and the rotations about them."""
    covariance = [0.0] * 36
    covariance[0] = covariance[7] = max(position, KNOWN)
    covariance[14] = covariance[21] = covariance[28] = KNOWN
    covariance[35] = max(heading, KNOWN)
    return covariance
