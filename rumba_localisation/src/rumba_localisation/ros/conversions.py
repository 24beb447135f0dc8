"""Converts between messages and what the localisation knows: pure functions."""

import math
from typing import Any, List, Tuple

import numpy as np
from geometry_msgs.msg import Point, PoseArray, PoseWithCovariance, PoseWithCovarianceStamped
from geometry_msgs.msg import Pose as PoseMessage
from nav_msgs.msg import MapMetaData, OccupancyGrid
from std_msgs.msg import Header

from rumba_sim.model.common.geometry import Pose, compose, inverse
from rumba_sim.model.kernel import Array
from rumba_sim.model.maps.floor_plan import FloorPlan
from rumba_sim.ros.common.conversions import heading, quaternion
from rumba_sim.ros.participants.maps import floor_plan

PLANE = (0, 1, 5)  # rows and columns of x, y and the rotation about z in a covariance of ROS


def turned_plan(message: OccupancyGrid) -> Tuple[FloorPlan, Pose]:
    """The map of a message, turned so that its cells lie along its axes, and the frame of that in the map frame.

    Raises:
        MapError: as for `maps.floor_plan`, but that its origin may be turned.
    """
    origin = message.info.origin
    corner, yaw = Pose(origin.position.x, origin.position.y, 0.0), heading(origin.orientation)
    if not math.isfinite(yaw) or abs(yaw) <= 1e-6:
        return floor_plan(message), Pose(0.0, 0.0, 0.0)
    level = MapMetaData(message.info.map_load_time, message.info.resolution, message.info.width, message.info.height,
                        pose_message(*corner))
    plan = floor_plan(OccupancyGrid(message.header, level, message.data))
    return plan, compose(corner._replace(theta=yaw), inverse(corner))


def turned(covariance: Array, angle: float) -> Array:
    """A covariance (3, 3) of x, y and heading, in axes that are turned by an angle [rad]."""
    if angle == 0.0:
        return covariance
    cos, sin = math.cos(angle), math.sin(angle)
    turn = np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])
    return np.asarray(turn @ covariance @ turn.T)


def covariance_of(message: PoseWithCovariance) -> Array:
    """The covariance of x, y and heading: float64 (3, 3)."""
    return np.array(message.covariance).reshape(6, 6)[np.ix_(PLANE, PLANE)]


def is_covariance(matrix: Array) -> bool:
    """Whether a matrix (3, 3) can be a covariance: finite, symmetric, no negative eigenvalue."""
    return bool(np.isfinite(matrix).all() and np.allclose(matrix, matrix.T)
                and np.linalg.eigvalsh(matrix).min() >= -1e-9)


def pose_with_covariance(pose: Pose, covariance: Array, header: Header) -> PoseWithCovarianceStamped:
    """A pose in the plane, with its covariance (3, 3) of x, y and heading."""
    whole = np.zeros((6, 6))
    whole[np.ix_(PLANE, PLANE)] = covariance
    return PoseWithCovarianceStamped(header, PoseWithCovariance(pose_message(*pose), whole.ravel().tolist()))


def cloud(poses: Array, header: Header) -> PoseArray:
    """Poses in the plane: float64 (any, 3)."""
    found: List[Any] = [pose_message(*pose) for pose in poses.tolist()]
    return PoseArray(header, found)


def pose_message(x: float, y: float, theta: float) -> PoseMessage:
    """A pose in the plane as one in space."""
    return PoseMessage(Point(x, y, 0.0), quaternion(theta))
