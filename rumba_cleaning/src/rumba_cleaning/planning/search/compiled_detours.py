"""The search for the shortest detour past a crumb, compiled by numba."""

from typing import Any, Tuple

import numpy as np

from rumba_cleaning.planning.common.compiled_ways import Needed, cornered_length, sight
from rumba_sim.model.compiling.jit import compiled

Array = Any  # numpy.ndarray


@compiled
def shortest(clearance: Array, origin: Tuple[float, float], resolution: float, needed: Needed, route: Array,
             begins: Array, paths: Array, stops: Array, corner: float) -> Tuple[float, int, int]:
    """The shortest detour from one waypoint of a route to the next one, along one of several paths.

    Args:
        clearance, origin, resolution: of the ground, as in `search.is_clear`.
        needed: on the straight lines to a path and back.
        route: float64 (any, 2) [m].
        begins: int (any), the waypoints of the route from which a detour may begin.
        paths: float64 (any, 2) [m], one behind the other.
        stops: int (paths + 1), where each begins, and the end of the last.
        corner: see `compiled_ways.cornered_length`.

    Returns:
        what it adds to the length of the route [m], inf if there is none; the waypoint; the number of the path.
    """
    needed = Needed(*needed)
    best, waypoint, number = np.inf, 0, 0
    for begin in begins:
        before, after = route[max(begin - 1, 0):begin + 1], route[begin + 1:begin + 3]
        without = cornered_length(np.concatenate((before, after)), corner)
        for index in range(len(stops) - 1):
            path = paths[stops[index]:stops[index + 1]]
            length = cornered_length(np.concatenate((before, path, after)), corner) - without
            if length < best and sees(clearance, origin, resolution, needed, at(before, -1), at(path, 0)) and (
                    sees(clearance, origin, resolution, needed, at(path, -1), at(after, 0))):
                best, waypoint, number = length, begin, index
    return best, waypoint, number


@compiled
def at(path: Array, index: int) -> Tuple[float, float]:
    """A waypoint of a path (any, 2) [m]."""
    return path[index, 0], path[index, 1]


@compiled
def sees(clearance: Array, origin: Tuple[float, float], resolution: float, needed: Needed, start: Tuple[float, float],
         end: Tuple[float, float]) -> bool:
    """Whether the robot can drive along the line between two points [m]."""
    return sight(clearance, Needed(*needed), (start[0] - origin[0]) / resolution, (start[1] - origin[1]) / resolution,
                 (end[0] - origin[0]) / resolution, (end[1] - origin[1]) / resolution)
