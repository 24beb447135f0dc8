"""What pieces of routes take and sweep, and the links between them, compiled by numba.

Arguments that many functions share:
    points: float64 (any, 2) [m], the waypoints of the pieces, one piece behind the other.
    stops: int (pieces + 1), where each piece begins, and the end of the last.
"""

import math
from typing import Any, NamedTuple, Tuple

import numpy as np

from rumba_cleaning.behaviours.compiled_follower import SLOWEST_BEND, Drive, wrapped
from rumba_cleaning.planning.common.compiled_ways import CLOSE, NONE, Needed, cornering, distance, sight
from rumba_sim.model.compiling.jit import compiled

Array = Any  # numpy.ndarray

BEYOND = 0.3  # of half a brush that is swept beyond the ends of a piece: robots swing round there, or go on; our choice
FAR = 1e4  # [s] for a link that is not known: finite, so that sums can be compared
TOGETHER = 1e-3  # [m] ends so near to each other are one


class Pace(NamedTuple):
    """How fast links are driven."""

    longest: float  # [m] of one at the cleaning speed
    slow: float  # that speed [m/s]
    fast: float  # on longer ones [m/s]
    free: float  # corners by this cost no time [rad], as for `compiled_ways.turning`
    rate: float  # [rad/s] in others
    stop: float  # [s] in those by more than a right angle


@compiled
def durations(points: Array, stops: Array, speed: float, drive: Drive) -> Array:
    """How long each piece takes at a speed [m/s], or less in its bends, about: float64 (pieces) [s]."""
    drive = Drive(*drive)
    found = np.zeros(len(stops) - 1)
    for piece in range(len(found)):
        for index in range(stops[piece] + 1, stops[piece + 1]):
            size, bent, along = distance(points[index - 1], points[index]), 0.0, 0.0
            for corner in range(max(index - 1, stops[piece] + 1), min(index + 1, stops[piece + 1] - 1)):
                bent += abs(wrapped(bearing(points, corner, corner + 1) - bearing(points, corner - 1, corner)))
                along += 0.5 * (distance(points[corner - 1], points[corner])
                                + distance(points[corner], points[corner + 1]))
            curvature = bent / along if along > 0.0 else 0.0
            wheels = drive.max_speed / (1.0 + 0.5 * drive.wheel_base * curvature)
            turns = drive.max_turn_rate / curvature if curvature > 0.0 else speed
            found[piece] += size / max(min(speed, wheels, turns), SLOWEST_BEND)
    return found


@compiled
def bearing(points: Array, one: int, other: int) -> float:
    """The direction from one of the points to another [rad]."""
    return math.atan2(points[other, 1] - points[one, 1], points[other, 0] - points[one, 0])


@compiled
def cells(points: Array, stops: Array, half: float, wanted: Array, origin: Tuple[float, float],
          resolution: float) -> Tuple[Array, Array]:
    """The cells that a brush sweeps along each piece.

    Args:
        points, stops: see above.
        half: of the width of the brush [m].
        wanted: bool (rows, columns), the cells to sweep.
        origin: of the cells [m].
        resolution: of the cells [m].

    Returns:
        int32 (any), the numbers of the cells, row by row, one piece behind the other; int (pieces + 1), where those of
        each piece begin, and the end of the last.
    """
    found, ends = [np.int32(0) for _ in range(0)], np.zeros(len(stops), np.int64)
    last = np.full(wanted.shape, -1, np.int32)  # the last piece that sweeps each cell
    for piece in range(len(stops) - 1):
        path = points[stops[piece]:stops[piece + 1]]
        for leg in range(len(path) - 1):
            rows = span(path[leg, 1], path[leg + 1, 1], half, origin[1], resolution, wanted.shape[0])
            columns = span(path[leg, 0], path[leg + 1, 0], half, origin[0], resolution, wanted.shape[1])
            for row in range(*rows):
                for column in range(*columns):
                    x, y = origin[0] + (column + 0.5) * resolution, origin[1] + (row + 0.5) * resolution
                    if wanted[row, column] and last[row, column] != piece and is_swept(path, leg, half, x, y):
                        found.append(np.int32(row * wanted.shape[1] + column))
                        last[row, column] = piece
        ends[piece + 1] = len(found)
    return np.array(found), ends


@compiled
def span(one: float, other: float, margin: float, origin: float, resolution: float, count: int) -> Tuple[int, int]:
    """The rows, or columns, between two coordinates and up to a margin beside them: the first; the one after the last.

    Args:
        one, other, margin, origin, resolution: [m]
        count: of all rows, or columns.
    """
    low, high = min(one, other) - margin - origin, max(one, other) + margin - origin
    return max(int(low / resolution), 0), min(int(high / resolution) + 1, count)


@compiled
def is_swept(path: Array, leg: int, half: float, x: float, y: float) -> bool:
    """Whether a brush with half a width [m] sweeps a point on a leg of a path (any, 2) [m], or in the bend after it."""
    from_x, from_y = path[leg, 0], path[leg, 1]
    along_x, along_y = path[leg + 1, 0] - from_x, path[leg + 1, 1] - from_y
    size = math.hypot(along_x, along_y)
    if size == 0.0:
        return False
    along = ((x - from_x) * along_x + (y - from_y) * along_y) / size
    if (leg == 0 and along < -BEYOND * half) or (leg == len(path) - 2 and along > size + BEYOND * half):
        return False
    along = min(max(along, 0.0), size) / size
    return math.hypot(x - from_x - along * along_x, y - from_y - along * along_y) <= half


@compiled
def links(ends: Array, headings: Array, near: Array, clearance: Array, origin: Tuple[float, float], resolution: float,
          needed: Needed, pace: Pace) -> Tuple[Array, Array]:
    """Straight links between ends of pieces.

    Args:
        ends: float64 (ends, 2) [m].
        headings: in which each piece is left at its ends, float64 (ends) [rad]; NaN: any.
        near: int (ends, any), others near to each; NONE for no more.
        clearance, origin, resolution: of the ground, as in `search.is_clear`.
        needed: beside the links.
        pace: at which they are driven.

    Returns:
        those near to each end to which a link is free, the quickest first, int32 (ends, any), NONE for no more; the
        times of all links, float32 (ends, ends) [s], FAR where there is none.
    """
    needed, pace = Needed(*needed), Pace(*pace)
    found, seconds = np.full(near.shape, NONE, np.int32), np.full((len(ends), len(ends)), FAR, np.float32)
    for one in range(len(ends)):
        count = 0
        for other in near[one]:
            if other == NONE:
                break
            if other >> 1 != one >> 1 and (distance(ends[one], ends[other]) < TOGETHER or sight(
                    clearance, needed, (ends[one, 0] - origin[0]) / resolution, (ends[one, 1] - origin[1]) / resolution,
                    (ends[other, 0] - origin[0]) / resolution, (ends[other, 1] - origin[1]) / resolution)):
                found[one, count] = other
                count += 1
                seconds[one, other] = seconds[other, one] = link(ends, headings, one, other, pace)
        quickest = np.argsort(seconds[one][found[one, :count]], kind='mergesort')
        found[one, :count] = found[one][quickest]
    return found, seconds


@compiled
def link(ends: Array, headings: Array, one: int, other: int, pace: Pace) -> float:
    """The time from one end to another [s]."""
    metres = distance(ends[one], ends[other])
    time = metres / (pace.slow if metres < CLOSE or metres <= pace.longest else pace.fast)
    return time + cornering(metres, ends[one], ends[other], headings[one], headings[other] + math.pi, pace.free,
                            pace.rate, pace.stop)
