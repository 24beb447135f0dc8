"""Edits that move parts of a route a little: straight ones to a side, and corners outward or inward.

So a lane sweeps a sliver beside it, and a robot that cuts a corner sweeps what it would leave there.
"""

import math
from typing import Iterator

import numpy as np

from rumba_cleaning.behaviours.compiled_follower import HAIRPIN
from rumba_cleaning.belief.context import Context
from rumba_cleaning.planning.common.compiled_ways import kept
from rumba_cleaning.planning.simulate.rehearsal import Edit
from rumba_cleaning.route import BENT, Route

# All figures are our choice.
STRAIGHT = 0.01  # [m] by which waypoints may be off a straight part
LONG = 0.4  # [m] of a straight part, at least: short ones belong to bends
ASIDE = (-0.02, -0.01, 0.01, 0.02)  # [m] to the left, for straight parts
SHORT = 0.05  # [m] of a part, at least, for it to have a direction at its end
# [m], for corners that turn by BENT at least; at a hairpin the robot turns on the spot.
OUTWARD = (-0.04, -0.015, 0.02, 0.05)


def shifts(context: Context, route: Route) -> Iterator[Edit]:
    """Shifts of all straight parts and corners of a route with waypoints that are not far apart."""
    waypoints = route.waypoints
    kinks = np.flatnonzero(kept(waypoints, STRAIGHT))
    legs = np.diff(waypoints[kinks], axis=0)
    sizes = np.hypot(*legs.T)
    ahead = legs / sizes[:, np.newaxis]
    for leg in np.flatnonzero(sizes[1:-1] >= LONG) + 1:
        left = np.array([-ahead[leg, 1], ahead[leg, 0]])
        paths = (waypoints[kinks[leg:leg + 2]] + aside * left for aside in ASIDE)
        yield from (Edit(kinks[leg] - 1, kinks[leg + 1] + 1, path) for path in paths
                    if context.ground.is_straight(*path))
    outward = ahead[:-1] - ahead[1:]
    away = np.hypot(*outward.T)  # twice the sine of half the angle
    is_corner = (np.minimum(sizes[:-1], sizes[1:]) >= SHORT) & (away >= 2.0 * math.sin(0.5 * BENT)) & (
        away <= 2.0 * math.sin(0.5 * HAIRPIN))
    for corner, out in zip(kinks[1:-1][is_corner], outward[is_corner] / away[is_corner, np.newaxis]):
        points = waypoints[corner] + np.array(OUTWARD)[:, np.newaxis] * out
        yield from (Edit(corner - 1, corner + 1, point[np.newaxis])
                    for point in points[context.ground.are_free(points)])
