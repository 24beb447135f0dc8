"""Where a scan fits on a map near a pose, and fits well, and nowhere else as well."""

import itertools
import math
from typing import NamedTuple, Optional

import numpy as np

from rumba_localisation import compiled_matching
from rumba_localisation.mapping.grid import RESOLUTION, Grid
from rumba_localisation.scan import thinned
from rumba_sim.model.geometry import Pose, wrap_angle
from rumba_sim.model.kernel import Array

STEPS = np.geomspace(0.1, 0.02, 6)  # [m] sigmas of a match
BEAMS, INDEPENDENT = 180, 0.2  # of a match, at most, and the share of them that err independently
HELD = np.diag([0.1, 0.1, 0.05]) ** 2  # covariance of each start of a match [m^2, m^2, rad^2]
STRIDE = 0.15  # [m] between these starts: a match finds what is as far off
# All these are our choice:
KNOWN = 0.5  # share of the beams that end where the map shows something, at least: others prove nothing
FITS = 0.8  # share of these that end at walls, by default: with noise alone it is 0.9
RIVAL = 0.03  # by so much it must fit better than anywhere else: in a bare corridor all places fit alike
ELSEWHERE = 0.1  # [m] from there on, a place is another


class Match(NamedTuple):
    """Where a scan fits on a map."""

    pose: Pose  # map frame
    covariance: Array  # float64 (3, 3)
    fit: float  # share of all its beams that end at a wall, less those that end at the wrong side of one


def clear_match(grid: Grid, pose: Pose, reach: float, points: Array, fits: float = FITS) -> Optional[Match]:
    """Where a scan fits; None if nowhere, or not clear.

    Args:
        grid: the map.
        pose: near which it is looked for, map frame.
        reach: how far off that may be, along x and along y [m].
        points: float64 (any, 2), where beams end, in the frame of the laser [m].
        fits: share of the beams on known floor that must end at walls.
    """
    few = thinned(points, BEAMS)
    offsets = np.arange(-math.ceil(reach / STRIDE), math.ceil(reach / STRIDE) + 1) * STRIDE
    matches = [_match(grid, Pose(pose.x + float(x), pose.y + float(y), pose.theta), few)
               for x, y in itertools.product(offsets, offsets)]
    best = max(matches, key=lambda each: each.fit)
    known = 1.0 - grid.share_unknown(best.pose, few)
    if known < KNOWN or best.fit < fits * known:
        return None
    rivals = [each for each in matches if each.fit > best.fit - RIVAL]
    is_clear = all(math.hypot(each.pose.x - best.pose.x, each.pose.y - best.pose.y) < ELSEWHERE for each in rivals)
    return best if is_clear else None


def _match(grid: Grid, start: Pose, points: Array) -> Match:
    found, covariance = np.empty(3), np.empty((3, 3))
    fit = compiled_matching.match(np.array(start), HELD, points, grid.field, *grid.origin, RESOLUTION, STEPS,
                                  INDEPENDENT, found, covariance)
    fit -= compiled_matching.from_behind(found, points, grid.field, *grid.origin, RESOLUTION, STEPS[-1])
    x, y, theta = found.tolist()
    return Match(Pose(x, y, wrap_angle(theta)), covariance, fit)
