"""Converts between messages and what the localisation knows: pure functions."""

import math
from typing import Any, List

import numpy as np
from geometry_msgs.msg import Point, PoseArray, PoseWithCovariance, PoseWithCovarianceStamped
from geometry_msgs.msg import Pose as PoseMessage
from nav_msgs.msg import OccupancyGrid
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Header

from rumba_localisation.localiser import points
from rumba_sim.model.errors import MapError
from rumba_sim.model.floor_plan import FloorPlan
from rumba_sim.model.geometry import Pose
from rumba_sim.model.kernel import Array
from rumba_sim.ros.common.conversions import heading, quaternion

PLANE = (0, 1, 5)  # rows and columns of x, y and the rotation about z in a covariance of ROS
FARTHEST = 1e6  # [m] of a coordinate, at most


def floor_plan(message: OccupancyGrid) -> FloorPlan:
    """The map of a message.

    Raises:
        MapError: its size disagrees with its data, it is turned, or its resolution is no length.
    """
    info = message.info
    # A float32 in the message: the shortest decimal that gives it is what map_server read.
    resolution = float(str(np.float32(info.resolution)))
    left, bottom = info.origin.position.x, info.origin.position.y
    if len(message.data) != info.width * info.height or not message.data:
        raise MapError(f'map: {len(message.data)} cells: must be width * height, {info.width} * {info.height}')
    if not (math.isfinite(resolution) and resolution > 0.0 and abs(left) <= FARTHEST and abs(bottom) <= FARTHEST):
        raise MapError(f'map: resolution {resolution} m, origin ({left}, {bottom}) m: must be a length and a place')
    if abs(heading(info.origin.orientation)) > 1e-6:
        raise MapError('map: its origin is turned: must have yaw 0')
    cells = np.array(message.data, np.int8).reshape(info.height, info.width)
    return FloorPlan('map', cells, resolution, (left, bottom))


def scan_points(scan: LaserScan) -> Array:
    """Where the beams of a scan that have an echo end: float64 (any, 2) [m]; none if its angles are no numbers."""
    if not (math.isfinite(scan.angle_min) and math.isfinite(scan.angle_increment)):
        return np.empty((0, 2))
    return points(np.asarray(scan.ranges, np.float32), scan.angle_min, scan.angle_increment)


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
