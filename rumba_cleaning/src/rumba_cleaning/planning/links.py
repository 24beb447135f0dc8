"""Joins the lanes of a block: paths from the end of one lane to the start of the next."""

import math
from typing import List

import numpy as np

from rumba_cleaning.belief.ground import Ground
from rumba_cleaning.planning.stretches import Variant
from rumba_sim.model.kernel import Array

# Our choice: a half circle is driven without stopping, but the wheels turn too fast on a small one, and a large one
# is longer than a path with corners.
BENDS = (0.05, 0.4)  # [m] between two lanes, if a half circle joins them: lanes are as far apart as the brush is wide
OFFSET = 0.35  # [m] by which the ends of the two lanes may differ along the lanes: twice the width of the brush
CORNERS = 9  # points of a half circle, both ends included: 22.5 degrees apart, within 2 % of its radius
# [m] before its end at which a lane is left for the next one, if that begins beside it: a half circle over two lanes
# then just reaches as far as the lanes would. Large leaves the corners beside the half circle.
EARLY = 0.08
PART = 0.4  # of a lane, at most, by which it is shorter at each end
ANGLES = np.linspace(0.0, math.pi, CORNERS)[:, np.newaxis]
COS, SIN = np.cos(ANGLES), np.sin(ANGLES)
SAME = 1e-6  # [m] waypoints so near to each other are one
NO_POINTS = np.zeros((0, 2))


def block_variants(ground: Ground, lanes: List[Array]) -> List[Variant]:
    """The four paths through the lanes of a block: from the first lane or the last, and from either end of it.

    Args:
        ground: where the robot can stand.
        lanes: float64 (2, 2) [m] each, side by side, all in the same direction.
    """
    return [Variant([through(ground, order, first)], False) for order in (lanes, lanes[::-1]) for first in (0, 1)]


def through(ground: Ground, lanes: List[Array], first: int) -> Array:
    """The path through lanes, to and fro: float64 (any, 2) [m]; it begins at the end `first`, 0 or 1, of lane 0."""
    parts = [lanes[0] if first == 0 else lanes[0][::-1]]
    for index, lane in enumerate(lanes[1:], 1):
        lane = lane if index % 2 == first else lane[::-1]
        parts[-1:] = _joined(ground, parts[-1], lane)
    path = np.concatenate(parts)
    return np.asarray(path[np.append(True, np.hypot(*np.diff(path, axis=0).T) > SAME)])


def _joined(ground: Ground, lane: Array, following: Array) -> List[Array]:
    """A lane, the waypoints from it to the next lane, and that lane: float64 (any, 2) [m] each."""
    end, start = _early(lane[::-1])[::-1], _early(following)
    bend = _half_circle(end, start)
    if len(bend) and ground.are_free(bend).all() and ground.is_straight(end[-1], bend[0]) and (
            ground.is_straight(bend[-1], start[0])):
        return [end, bend, start]
    path = ground.path(lane[-1], following[0])
    return [lane, NO_POINTS if path is None else path[1:-1], following]


def _early(lane: Array) -> Array:
    """A lane that begins a little later: float64 (2, 2) [m]."""
    along = lane[1] - lane[0]
    return np.array([lane[0] + min(EARLY / np.hypot(*along), PART) * along, lane[1]])


def _half_circle(lane: Array, following: Array) -> Array:
    """A half circle beyond the ends of two lanes: float64 (CORNERS, 2) [m], or (0, 2) if they are not side by side."""
    ahead = (lane[-1] - lane[0]) / np.hypot(*(lane[-1] - lane[0]))
    step = following[0] - lane[-1]
    along = float(step @ ahead)
    across = step - along * ahead
    if not (BENDS[0] < np.hypot(*across) < BENDS[1] and abs(along) < OFFSET):
        return NO_POINTS
    start = lane[-1] + max(along, 0.0) * ahead
    half = 0.5 * across
    return np.asarray(start + half - COS * half + SIN * np.hypot(*half) * ahead)
