"""Poses in the plane, after REP 103: x forward, y left, angles counter-clockwise."""

import math
from typing import NamedTuple

from rumba_sim.model import kernel


class Pose(NamedTuple):
    """Where something stands: x and y [m], theta [rad] in (-pi, pi]."""

    x: float
    y: float
    theta: float


def wrap_angle(angle: float) -> float:
    """The same direction in (-pi, pi] [rad]."""
    return kernel.wrap(angle)


def compose(frame: Pose, pose: Pose) -> Pose:
    """A pose given in a frame, as seen from where the frame's own pose is given."""
    cos, sin = math.cos(frame.theta), math.sin(frame.theta)
    return Pose(frame.x + cos * pose.x - sin * pose.y, frame.y + sin * pose.x + cos * pose.y,
                wrap_angle(frame.theta + pose.theta))


def inverse(frame: Pose) -> Pose:
    """The pose, in a frame, of that against which the frame's own pose is given."""
    cos, sin = math.cos(frame.theta), math.sin(frame.theta)
    return Pose(-cos * frame.x - sin * frame.y, sin * frame.x - cos * frame.y, wrap_angle(-frame.theta))
