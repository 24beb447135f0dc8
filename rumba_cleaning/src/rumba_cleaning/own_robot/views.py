"""Whether scans and odometry tell of the same movements: is the laser where it is said to be?"""

import itertools
import math
from typing import NamedTuple, Optional, Sequence

import numpy as np
from scipy.spatial import cKDTree

from rumba_cleaning.own_robot.heard import View
from rumba_sim.model.common.geometry import Pose, hypot, wrap_angle
from rumba_sim.model.kernel import Array
from rumba_sim.model.settings.mounting import Mounting

WAY, TURN = 0.12, 0.3  # [m], [rad] that the odometry must tell, so that the scans can contradict it
STEP = math.radians(5.0)  # from one angle that is tried to the next
FAR = 0.3  # [m] from the nearest point, at most, in a mean
BETTER = 0.7  # share of the distance between points that is left at another mounting, at most, to prefer it ...
CLEARLY = 0.008  # ... if it is smaller by so much [m]: less is noise
MOVED = 0.1  # [m] by which half of the ranges change if the robot moves, or people


class Finding(NamedTuple):
    """A mounting that goes better with the odometry than the one that is said."""

    turned: float  # [rad] by which the laser is turned against it
    mirrored: bool  # its angles grow the other way, or the odometry turns the other way


def contradiction(views: Sequence[View], mounting: Mounting) -> Optional[Finding]:
    """What would fit much better; None if nothing would, or the robot moved too little to tell."""
    if not can_tell(views):
        return None
    steps = range(-35, 37) if has_driven(views) else range(1)
    costs = {(step * STEP, mirrored): _cost(views, mounting, step * STEP, mirrored)
             for step, mirrored in itertools.product(steps, (False, True))}
    best = min(costs, key=lambda each: costs[each] + 1e-4 * abs(each[0]))
    now = costs[0.0, False]
    return Finding(*best) if costs[best] < BETTER * now and now - costs[best] > CLEARLY else None


def can_tell(views: Sequence[View]) -> bool:
    """Whether the robot moved by its odometry."""
    return has_driven(views) or any(abs(wrap_angle(each.pose.theta - views[0].pose.theta)) > TURN for each in views)


def has_driven(views: Sequence[View]) -> bool:
    """Whether it did not only turn: otherwise nobody can tell how a laser is turned."""
    return any(hypot(each.pose.x - views[0].pose.x, each.pose.y - views[0].pose.y) > WAY for each in views)


def has_moved_by_scans(views: Sequence[View]) -> bool:
    """Whether the scans changed so much that the robot must have moved."""
    if len(views) < 2 or not all(len(view.points) for view in views):
        return False
    tree = cKDTree(views[0].points)
    return any(float(np.median(tree.query(view.points)[0])) > MOVED for view in views)


def _cost(views: Sequence[View], mounting: Mounting, turned: float, mirrored: bool) -> float:
    """How far points of the scans are from those of the first one, in the mean [m]."""
    clouds = [_placed(view, mounting, turned, mirrored) for view in views]
    tree = cKDTree(clouds[0])
    return float(np.mean([np.minimum(tree.query(cloud)[0], FAR).mean() for cloud in clouds[1:]]))


def _placed(view: View, mounting: Mounting, turned: float, mirrored: bool) -> Array:
    """The points of a scan in the frame of the odometry."""
    points = view.points * (1.0, -1.0 if mounting.upside_down is not mirrored else 1.0)
    on_robot = _moved(points, Pose(mounting.x, mounting.y, mounting.yaw + turned))
    return _moved(on_robot, view.pose)


def _moved(points: Array, pose: Pose) -> Array:
    cos, sin = math.cos(pose.theta), math.sin(pose.theta)
    x, y = points.T
    return np.stack([pose.x + cos * x - sin * y, pose.y + sin * x + cos * y], axis=1)
