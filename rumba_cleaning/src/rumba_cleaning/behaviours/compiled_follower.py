"""Finds where on a route a robot is, compiled by numba."""

import math
from typing import Any, Tuple

from rumba_sim.model.jit import compiled

TIE = 1e-9  # [m] a leg farther on must be nearer by this

Array = Any  # numpy.ndarray


@compiled
def nearest(waypoints: Array, legs: Array, lengths: Array, first: int, x: float, y: float, since: float,
            window: float) -> Tuple[float, float]:
    """The point of a route that is nearest to another point, on a part of it.

    Args:
        waypoints: float64 (any, 2) [m].
        legs: float64 (any - 1), lengths of the lines between them [m].
        lengths: float64 (any), from the first waypoint to each, along the route [m].
        first: number of the leg on which the part begins.
        x, y: the other point [m].
        since: distance along the route at which the part begins [m].
        window: the part ends with the last leg that begins within this distance of its beginning [m].

    Returns:
        its distance along the route, and its distance from the other point [m]
    """
    best, least = since, math.inf
    for index in range(first, len(legs)):
        if lengths[index] > since + window:
            break
        from_x, from_y, leg = waypoints[index, 0], waypoints[index, 1], legs[index]
        dx, dy = waypoints[index + 1, 0] - from_x, waypoints[index + 1, 1] - from_y
        share = ((x - from_x) * dx + (y - from_y) * dy) / (leg * leg)
        share = min(max(share, (since - lengths[index]) / leg, 0.0), 1.0)
        off = math.hypot(from_x + share * dx - x, from_y + share * dy - y)
        if off < least - TIE:
            best, least = lengths[index] + share * leg, off
    return best, least
