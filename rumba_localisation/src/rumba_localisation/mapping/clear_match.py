"""Where a scan fits on a map near a pose, and fits well, and nowhere else as well."""

import math
from typing import NamedTuple, Optional

import numpy as np

from rumba_localisation import compiled_matching
from rumba_localisation.mapping.grids.grid import Grid
from rumba_localisation.mapping.look_around import best_around
from rumba_localisation.noise import Noise
from rumba_localisation.scan import Scan, thinned
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.kernel import Array

BEAMS, INDEPENDENT = 360, 0.2  # of a match, at most, and the share of them that err independently
HELD = np.diag([0.1, 0.1, 0.05]) ** 2  # covariance of each start of a match [m^2, m^2, rad^2]
# All these are our choice:
STARTS = 12  # of matches
KNOWN = 0.4  # share of the beams that end where the map shows something, at least: others prove nothing
WRONG = 2.0  # beams that end at a wall are outweighed by one that cannot be where it is
FITS = 0.75  # share of these that end at walls, at least: with noise alone it is 0.9
RIVAL = 0.03  # by so much it must fit better than anywhere else: in a bare corridor all places fit alike
ELSEWHERE = 0.1  # [m] from there on, a place is another


class Match(NamedTuple):
    """Where a scan fits on a map."""

    pose: Pose  # map frame
    covariance: Array  # float64 (3, 3)
    fit: float  # share of its beams that end at walls, less those behind, and WRONG times those that cannot


class Sought(NamedTuple):
    """What is looked for, and where."""

    pose: Pose  # near which it is looked for, map frame
    reach: float  # how far off that may be, along x and along y [m]
    turn: float  # how far it may be turned [rad]
    cloud: Array  # float64 (any, 2), where beams of this scan and of some before it end, in the frame of the robot [m]
    scan: Scan


def clear_match(grid: Grid, sought: Sought, noise: Noise, supposed: Optional[Pose] = None) -> Optional[Match]:
    """Where a scan fits; None if nowhere, or not clear.

    Args:
        grid: the map.
        sought: what is looked for.
        noise: of the laser.
        supposed: where an earlier scan has it: there it need not fit better than anywhere else, but as well.
    """
    few = thinned(sought.cloud, BEAMS)
    starts = best_around(grid, sought.pose, sought.reach, sought.turn, few, STARTS)
    matches = [_match(grid, start, few, sought.scan, noise) for start in starts]
    best = max(matches, key=lambda each: each.fit)
    if supposed is not None:
        there = _match(grid, supposed, few, sought.scan, noise)
        if there.fit > best.fit - RIVAL:
            best, matches = there, []
    known = 1.0 - grid.share_unknown(best.pose, few)
    if known < KNOWN or best.fit < FITS * known:
        return None
    rivals = [each for each in matches if each.fit > best.fit - RIVAL]
    is_clear = all(math.hypot(each.pose.x - best.pose.x, each.pose.y - best.pose.y) < ELSEWHERE for each in rivals)
    return best if is_clear else None


def _match(grid: Grid, start: Pose, points: Array, scan: Scan, noise: Noise) -> Match:
    found = grid.matched(start, HELD, points, noise.kernels(points, scan.laser), noise.steps, INDEPENDENT)
    behind = compiled_matching.from_behind(np.array(found.pose), scan.points, scan.laser, grid.field, *grid.origin,
                                           grid.resolution, noise.kernel)
    return Match(*found[:2], found.fit - behind - WRONG * grid.share_wrong(found.pose, scan, noise, points))
