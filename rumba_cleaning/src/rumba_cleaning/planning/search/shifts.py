"""Edits that move parts of a route a little: straight ones to a side, and corners outward or inward.

So a lane sweeps a sliver beside it, and a robot that cuts a corner sweeps what it would leave there.
"""

import math
from typing import Iterator, Optional

import numpy as np

from rumba_cleaning.behaviours.compiled_follower import HAIRPIN
from rumba_cleaning.belief.context import Context
from rumba_cleaning.planning.common.compiled_ways import kept
from rumba_cleaning.planning.simulate.rehearsal import Edit
from rumba_cleaning.route import Route
from rumba_sim.model.common.geometry import hypot
from rumba_sim.model.kernel import Array

# All figures are our choice.
STRAIGHT = 0.01  # [m] by which waypoints may be off a straight part
LONG = 0.4  # [m] of a straight part, at least: short ones belong to bends
ASIDE = (-0.04, -0.02, -0.01, 0.01, 0.02, 0.04)  # [m] to the left, for straight parts
SHORT = 0.05  # [m] of a part, at least, for it to have a direction at its end
BENT = 0.5  # [rad] that a corner turns, at least; at a hairpin the robot turns on the spot
OUTWARD = (-0.08, -0.04, -0.015, 0.02, 0.05, 0.08)  # [m], for corners


def shifts(context: Context, route: Route) -> Iterator[Edit]:
    """Shifts of all straight parts and corners of a route with waypoints that are not far apart."""
    waypoints = route.waypoints
    corners = np.flatnonzero(kept(waypoints, STRAIGHT))
    for first, last in zip(corners[1:], corners[2:-1]):
        along = waypoints[last] - waypoints[first]
        length = hypot(*along)
        if length >= LONG:
            left = np.array([-along[1], along[0]]) / length
            paths = (waypoints[[first, last]] + aside * left for aside in ASIDE)
            yield from (Edit(first - 1, last + 1, path) for path in paths if context.ground.is_straight(*path))
    for before, corner, after in zip(corners, corners[1:], corners[2:]):
        outward = _outward(waypoints[[before, corner, after]])
        if outward is not None:
            points = waypoints[corner] + np.array(OUTWARD)[:, np.newaxis] * outward
            yield from (Edit(corner - 1, corner + 1, point[np.newaxis])
                        for point in points[context.ground.are_free(points)])


def _outward(points: Array) -> Optional[Array]:
    """The direction out of the middle one of three points (3, 2), as a unit vector; None if it is no corner."""
    legs = np.diff(points, axis=0)
    sizes = np.hypot(*legs.T)
    if sizes.min() < SHORT:
        return None
    (x, y), (to_x, to_y) = legs / sizes[:, np.newaxis]
    if not BENT <= abs(math.atan2(x * to_y - y * to_x, x * to_x + y * to_y)) <= HAIRPIN:
        return None
    out = np.array([x - to_x, y - to_y])
    return np.asarray(out / hypot(*out))
