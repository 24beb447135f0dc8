"""Poses in the plane, after REP 103: x forward, y left, angles counter-clockwise."""

import math
from typing import NamedTuple


class Pose(NamedTuple):
    """Where something stands: x and y [m], theta [rad] in (-pi, pi]."""

    x: float
    y: float
    theta: float


def wrap_angle(angle: float) -> float:
    """The same direction in (-pi, pi] [rad]."""
    return math.pi - (math.pi - angle) % (2.0 * math.pi)
