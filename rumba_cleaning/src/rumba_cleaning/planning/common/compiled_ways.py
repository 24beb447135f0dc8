"""Ways and paths, compiled by numba."""

import math
from typing import Any, NamedTuple, Tuple

import numpy as np

from rumba_sim.model.compiling.compiled import fast
from rumba_sim.model.compiling.jit import compiled

interpolated = fast.interpolated

Array = Any  # numpy.ndarray

CLOSE = 0.02  # [m] points so near to each other have no direction between them
TINY = 1e-9  # [nodes]
SHARP = 1.6  # [rad] a little more than a right angle


class Needed(NamedTuple):
    """The clearance that a robot needs at the nodes along a line."""

    least: float  # [m]
    touching: float  # [m] within `near` of the ends, beside a wall; ...
    near: float  # [nodes]
    standing: float  # [m] ... to one side of which there must be this: where it is too narrow for a robot, there is not
    aside: int  # [nodes] how far to that side, at most
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
        here_x, here_y = x + at * along_x, y + at * along_y
        found = interpolated(clearance, here_x, here_y)[0]
        if found < (needed.touching if min(at, size - at) <= needed.near else needed.least):
            return False
        if found < needed.standing and 0.0 < at < size and not is_beside(
                clearance, needed, here_x, here_y, along_x, along_y):
            return False
        if at == size:
            return True
        at = min(at + max((found - needed.least) / needed.resolution, 1.0), size)


@compiled
def nearest(coordinate: float) -> int:
    """The row or column of the node nearest to a coordinate [nodes]."""
    return int(math.floor(coordinate + 0.5))


@compiled
def is_beside(clearance: Array, needed: Needed, x: float, y: float, along_x: float, along_y: float) -> bool:
    """Whether a robot can stand to the left or to the right of (x, y) [nodes], seen along a unit vector."""
    for away in range(-needed.aside, needed.aside + 1):
        row, column = nearest(y + away * along_x), nearest(x - away * along_y)
        if 0 <= row < clearance.shape[0] and 0 <= column < clearance.shape[1] and (
                clearance[row, column] >= needed.standing):
            return True
    return False


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
def wrapped(angle: float) -> float:
    """The size of an angle, 0 to pi [rad]."""
    return abs((angle + math.pi) % (2.0 * math.pi) - math.pi)


@compiled
def turning(angle: float, free: float, rate: float, stop: float) -> float:
    """Time lost in a corner [s]: nothing below `free` [rad], and a stop beyond a right angle."""
    return max(angle - free, 0.0) / rate + (stop if angle > SHARP else 0.0)


@compiled
def cornering(metres: float, start: Array, end: Array, out: float, into: float, free: float, rate: float,
              stop: float) -> float:
    """Time lost in the corners at both ends of a way [s].

    Args:
        metres: length of the way; a short one has no direction [m].
        start, end: of the way, float64 (2) [m].
        out, into: headings before and after it [rad]; NaN: any.
        free, rate, stop: see `turning`.
    """
    if metres < CLOSE:
        return known_turning(wrapped(into - out), free, rate, stop)
    along = math.atan2(end[1] - start[1], end[0] - start[0])
    return (known_turning(wrapped(along - out), free, rate, stop)
            + known_turning(wrapped(into - along), free, rate, stop))


@compiled
def known_turning(angle: float, free: float, rate: float, stop: float) -> float:
    """As `turning`; nothing if the angle is NaN."""
    return 0.0 if math.isnan(angle) else turning(angle, free, rate, stop)


@compiled
def drive_times(metres: Array, points: Array, exits: Array, entries: Array, out: Array, into: Array, speed: float,
                free: float, rate: float, stop: float) -> Array:
    """Times [s] from each exit to each entry.

    Args:
        metres: float64 (n, n) [m] from point to point.
        points: float64 (n, 2) [m].
        exits, entries: int, indices of points.
        out, into: headings at the exits and the entries [rad]; NaN: any.
        speed: [m/s]
        free, rate, stop: see `turning`.
    """
    found = np.empty((len(exits), len(entries)))
    for one in range(len(exits)):
        for other in range(len(entries)):
            a, b = exits[one], entries[other]
            time = metres[a, b] / speed
            time += cornering(metres[a, b], points[a], points[b], out[one], into[other], free, rate, stop)
            found[one, other] = time
    return found


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


@compiled
def distance(one: Array, other: Array) -> float:
    """The distance between two points (2)."""
    return math.hypot(other[0] - one[0], other[1] - one[1])
