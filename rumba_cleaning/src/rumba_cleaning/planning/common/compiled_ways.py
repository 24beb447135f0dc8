"""Ways and paths, compiled by numba."""

import math
from typing import Any, NamedTuple, Tuple

import numpy as np

from rumba_sim.model.compiling.compiled import fast
from rumba_sim.model.compiling.jit import compiled

interpolated = fast.interpolated

Array = Any  # numpy.ndarray

TINY = 1e-9  # [nodes]


class Needed(NamedTuple):
    """The clearance that a robot needs at the nodes along a line."""

    least: float  # [m]
    touching: float  # [m] within `near` of the ends, beside a wall
    near: float  # [nodes]
    resolution: float  # [m] from node to node


@compiled
def sight(clearance: Array, needed: Needed, x: float, y: float, to_x: float, to_y: float) -> bool:
    """Whether a robot can drive along the line from (x, y) to (to_x, to_y) [nodes].

    From a point with more clearance than the robot needs, the line is free at least for as long as it has more.
    """
    size = math.hypot(to_x - x, to_y - y)
    along_x, along_y = (to_x - x) / max(size, TINY), (to_y - y) / max(size, TINY)
    at = 0.0
    while True:
        found = interpolated(clearance, x + at * along_x, y + at * along_y)[0]
        if found < (needed.touching if min(at, size - at) <= needed.near else needed.least):
            return False
        if at == size:
            return True
        at = min(at + max((found - needed.least) / needed.resolution, 1.0), size)


@compiled
def lengths(clearance: Array, needed: Needed, points: Array, stops: Array) -> Tuple[Array, Array]:
    """Lengths [nodes] of the shortest paths from point to point over lines of sight, and the last stop on each of them.

    Args:
        clearance: float64 (rows + 1, columns + 1) [m].
        needed: see above.
        points: float64 (n, 2), x and y [nodes].
        stops: int (any), the points at which a path may stop between its ends.

    Returns:
        float64 (n, n), inf if there is no path; int (n, n), the point before the last one.
    """
    needed = Needed(*needed)
    count = len(points)
    found = np.full((count, count), np.inf)
    before = np.empty((count, count), np.int32)
    for one in range(count):
        before[one, :] = one
        found[one, one] = 0.0
        for other in range(one):
            distance = math.hypot(points[one, 0] - points[other, 0], points[one, 1] - points[other, 1])
            if sight(clearance, needed, points[one, 0], points[one, 1], points[other, 0], points[other, 1]):
                found[one, other] = found[other, one] = distance
    for middle in stops:
        for one in range(count):
            if one != middle and found[one, middle] < np.inf:
                shorten(found[one], before[one], found[one, middle], found[middle], before[middle])
    return found, before


@compiled
def shorten(lengths_of: Array, before: Array, there: float, beyond: Array, before_beyond: Array) -> None:
    """Take the paths from one point to all others over a third point, where those are shorter.

    Without a branch, so that the compiler handles several paths at once.

    Args:
        lengths_of, before: of the paths so far, float64 and int (n); they are changed.
        there: length of the path to the third point.
        beyond, before_beyond: of the paths from there, as the first two.
    """
    for other in range(len(lengths_of)):
        length = there + beyond[other]
        is_shorter = length < lengths_of[other]
        lengths_of[other] = length if is_shorter else lengths_of[other]
        before[other] = before_beyond[other] if is_shorter else before[other]


@compiled
def kept(path: Array, off: float) -> Array:
    """Which waypoints of a path (any, 2) are farther than `off` from the line between others: bool (any)."""
    keep = np.zeros(len(path), np.bool_)
    keep[0] = keep[-1] = True
    spans = [(0, len(path) - 1)]
    while len(spans) > 0:
        first, last = spans.pop()
        x, y = path[first, 0], path[first, 1]
        along_x, along_y = path[last, 0] - x, path[last, 1] - y
        square = along_x * along_x + along_y * along_y
        most, middle = off, -1
        for index in range(first + 1, last):
            dx, dy = path[index, 0] - x, path[index, 1] - y
            share = (dx * along_x + dy * along_y) / square if square > 0.0 else 0.0
            share = min(max(share, 0.0), 1.0)
            away = math.hypot(dx - share * along_x, dy - share * along_y)
            if away > most:
                most, middle = away, index
        if middle >= 0:
            keep[middle] = True
            spans.append((first, middle))
            spans.append((middle, last))
    return keep
