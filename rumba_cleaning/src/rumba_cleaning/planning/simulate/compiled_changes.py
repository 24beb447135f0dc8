"""What edits of a route would change, by rehearsals of the parts around them, compiled by numba."""

import math
from typing import Any, Tuple

import numpy as np

from rumba_cleaning.planning.simulate.compiled_passes import Passes, gain
from rumba_cleaning.planning.simulate.compiled_rehearsal import ALONG, DT, SPEED, Walls, rehearse
from rumba_sim.model.compiling.jit import compiled

Array = Any  # numpy.ndarray
Brush = Any  # rumba_sim.model.floors.sweep.Brush
Drive = Any  # rumba_cleaning.behaviours.compiled_follower.Drive

# [m] before and behind an edit, within which the robot drives otherwise because of it: large is exact, small is fast.
LEAD, TAIL = 0.25, 0.5


@compiled
def changes(waypoints: Array, speeds: Array, lengths: Array, drive: Drive, walls: Walls, speed: float, trace: Array,
            brush: Brush, passes: Passes, scratch: Array, spans: Array, paths: Array,
            stops: Array) -> Tuple[Array, Array]:
    """What each of several edits of a route would change, if it were the only one.

    Args:
        waypoints, speeds, drive, walls, trace: as for `rehearse`; the trace is that of the route.
        lengths: along the route to each waypoint, float64 (waypoints) [m].
        speed: at which what replaces a part is driven [m/s]; a faster route is driven with the brushes up.
        brush: of the floor.
        passes, scratch: as for `gain`.
        spans: int (edits, 2), the waypoints between which each edit replaces those of the route.
        paths: float64 (any, 2) [m], what it replaces them by, one path behind the other.
        stops: int (edits + 1), where each path begins, and the end of the last.

    Returns:
        how much longer the route takes: float64 (edits) [s], inf if the robot would not follow it; how many more
        samples are swept: int (edits).
    """
    passes = Passes(*passes)
    seconds, samples = np.full(len(spans), np.inf), np.zeros(len(spans), np.int64)
    along = trace[:, ALONG].copy()
    for edit in range(len(spans)):
        first, last = spans[edit]
        low = max(np.searchsorted(along, lengths[first] - LEAD) - 1, 0)
        high = min(np.searchsorted(along, lengths[last] + TAIL), len(along) - 1)
        points, fast_at, until = edited(waypoints, speeds, lengths, along[low], first, last,
                                        paths[stops[edit]:stops[edit + 1]], speed)
        is_end = high == len(along) - 1
        is_there, found = rehearse(points, fast_at, drive, walls, trace[low], low == 0, np.inf if is_end else until)
        if not is_there:
            continue
        seconds[edit] = (len(found) - 1 - (high - low)) * DT
        if not is_end:
            off = found[-1, ALONG] - until - (along[high] - lengths[last] - TAIL)
            seconds[edit] -= off / found[-1, SPEED]
        samples[edit] = gain(brush, passes, scratch, trace, low, high, found, speed)
    return seconds, samples


@compiled
def edited(waypoints: Array, speeds: Array, lengths: Array, here: float, first: int, last: int, path: Array,
           speed: float) -> Tuple[Array, Array, float]:
    """The part of a route around an edit, from a distance `here` along the route on [m].

    Returns:
        its waypoints, float64 (any, 2) [m], and speeds, float64 (any - 1) [m/s]; the length up to TAIL beyond the edit.
    """
    begin = min(max(int(np.searchsorted(lengths, here, side='right')), 1), max(first, 1))
    end = min(np.searchsorted(lengths, lengths[last] + 2.0 * TAIL), len(waypoints) - 1)
    share = min((here - lengths[begin - 1]) / max(lengths[begin] - lengths[begin - 1], 1e-9), 1.0)
    start = waypoints[begin - 1:begin] + share * (waypoints[begin:begin + 1] - waypoints[begin - 1:begin])
    points = np.concatenate((start, waypoints[begin:first + 1], path, waypoints[last:end + 1]))
    fast_at = np.concatenate((speeds[begin - 1:first], np.full(len(path) + 1, speed), speeds[last:end]))
    length = 0.0
    for index in range(1, len(points)):
        length += math.hypot(points[index, 0] - points[index - 1, 0], points[index, 1] - points[index - 1, 1])
    return points, fast_at, length - (lengths[end] - lengths[last] - TAIL)
