"""Poses in the plane by the conventions of REP 103: x forward, y left, angles counter-clockwise."""

import math
from typing import NamedTuple, Tuple

from rumba_sim.model.kernel.geometry import wrap

TURN = 2.0 * math.pi  # [rad]


class Pose(NamedTuple):
    """Position and heading: x and y [m], theta [rad] in (-pi, pi]."""

    x: float
    y: float
    theta: float


def wrap_angle(angle: float) -> float:
    """The same direction as an angle in (-pi, pi] [rad]."""
    return wrap(angle)


def hypot(x: float, y: float) -> float:
    """The length of (x, y); math.hypot has rounded otherwise since Python 3.10, and a run must not depend on that."""
    return math.sqrt(x * x + y * y)


def compose(frame: Pose, pose: Pose) -> Pose:
    """Transform a pose from a frame to the parent of that frame.

    Args:
        frame: pose of the frame in its parent.
        pose: a pose in the frame.
    """
    cos, sin = math.cos(frame.theta), math.sin(frame.theta)
    return Pose(frame.x + cos * pose.x - sin * pose.y, frame.y + sin * pose.x + cos * pose.y,
                wrap_angle(frame.theta + pose.theta))


def inverse(frame: Pose) -> Pose:
    """The pose of the parent in a frame, from the pose of the frame in its parent."""
    cos, sin = math.cos(frame.theta), math.sin(frame.theta)
    return Pose(-cos * frame.x - sin * frame.y, sin * frame.x - cos * frame.y, wrap_angle(-frame.theta))


def half_angle(theta: float) -> Tuple[float, float]:
    """z and w of the quaternion of a rotation about z [rad]; its x and y are 0."""
    return math.sin(0.5 * theta), math.cos(0.5 * theta)


def yaw(x: float, y: float, z: float, w: float) -> float:
    """The angle about z [rad] of the rotation of a quaternion."""
    return math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))


def as_told(pose: Pose) -> Pose:
    """A pose as a transform tells it: by a quaternion, from which a heading comes back with other last bits."""
    return Pose(pose.x, pose.y, yaw(0.0, 0.0, *half_angle(pose.theta)))
