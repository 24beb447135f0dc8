"""Half circles from lane to lane, compiled by numba."""

import math
from typing import Any, Tuple

import numpy as np

from rumba_cleaning.belief.search import is_clear
from rumba_sim.model.compiling.jit import compiled

Array = Any  # numpy.ndarray

# Our choice: a half circle is driven without stopping, but the wheels turn too fast on a small one, and a large one
# is longer than a path with corners.
BENDS = (0.05, 0.4)  # [m] between two lanes, if a half circle joins them: lanes are as far apart as the brush is wide
OFFSET = 0.35  # [m] by which the ends of the two lanes may differ along the lanes: twice the width of the brush
CORNERS = 9  # points of a half circle, both ends included: 22.5 degrees apart, within 2 % of its radius
# [m] before its end at which a lane is left for the next one, if that begins beside it: a half circle over two lanes
# then just reaches as far as the lanes would. Large leaves the corners beside the half circle.
EARLY = 0.08
PART = 0.4  # of a lane, at most, by which it is shorter at each end


@compiled
def joined(clearance: Array, origin: Tuple[float, float], resolution: float, least: float, lane: Array,
           following: Array) -> Array:
    """Two lanes, the first from where it begins and the second to where it ends, and the half circle between them.

    Args:
        clearance, origin, resolution: of the ground, as in `search.is_clear`.
        least: clearance that the robot needs [m].
        lane, following: both ends of the lanes, float64 (2, 2) [m].

    Returns:
        float64 (CORNERS + 4, 2) [m], or (0, 2) if the lanes are not side by side or the robot does not fit there.
    """
    end, start = shortened(lane[1], lane[0]), shortened(following[0], following[1])
    ahead_x, ahead_y = end[0] - lane[0, 0], end[1] - lane[0, 1]
    size = math.hypot(ahead_x, ahead_y)
    ahead_x, ahead_y = ahead_x / size, ahead_y / size
    step_x, step_y = start[0] - end[0], start[1] - end[1]
    along = step_x * ahead_x + step_y * ahead_y
    half_x, half_y = 0.5 * (step_x - along * ahead_x), 0.5 * (step_y - along * ahead_y)
    radius = math.hypot(half_x, half_y)
    if not (BENDS[0] < 2.0 * radius < BENDS[1] and abs(along) < OFFSET):
        return np.zeros((0, 2))
    middle_x, middle_y = end[0] + max(along, 0.0) * ahead_x + half_x, end[1] + max(along, 0.0) * ahead_y + half_y
    path = np.empty((CORNERS + 4, 2))
    path[0], path[-1] = lane[0], following[1]
    path[1, 0], path[1, 1] = end
    path[-2, 0], path[-2, 1] = start
    for corner in range(CORNERS):
        angle = math.pi * corner / (CORNERS - 1)
        cos, out = math.cos(angle), math.sin(angle) * radius
        path[corner + 2, 0] = middle_x - cos * half_x + out * ahead_x
        path[corner + 2, 1] = middle_y - cos * half_y + out * ahead_y
        point = path[corner + 2, 0], path[corner + 2, 1]
        if not is_clear(clearance, origin, resolution, point, point, least):
            return np.zeros((0, 2))
    first, last = (path[2, 0], path[2, 1]), (path[-3, 0], path[-3, 1])
    if is_clear(clearance, origin, resolution, end, first, least) and (
            is_clear(clearance, origin, resolution, last, start, least)):
        return path
    return np.zeros((0, 2))


@compiled
def shortened(end: Array, other: Array) -> Tuple[float, float]:
    """A point a little before one end (2) of a lane, which has another end (2) [m]."""
    along_x, along_y = other[0] - end[0], other[1] - end[1]
    share = min(EARLY / math.hypot(along_x, along_y), PART)
    return end[0] + share * along_x, end[1] + share * along_y
