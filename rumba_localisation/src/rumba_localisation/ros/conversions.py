"""Converts between messages and what the localisation knows: pure functions."""

import math
from typing import Any, List

import numpy as np
from geometry_msgs.msg import Point, PoseArray, PoseWithCovariance, PoseWithCovarianceStamped
from geometry_msgs.msg import Pose as PoseMessage
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Header

from rumba_localisation.scan import points
from rumba_sim.model.geometry import Pose
from rumba_sim.model.kernel import Array
from rumba_sim.ros.common.conversions import quaternion

PLANE = (0, 1, 5)  # rows and columns of x, y and the rotation about z in a covariance of ROS


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
