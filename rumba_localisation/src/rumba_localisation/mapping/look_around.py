"""Where around a pose a scan fits: poses from which a match begins (correlative scan matching, Olson 2009)."""

import math
from typing import List

import numpy as np

from rumba_localisation import compiled_matching
from rumba_localisation.mapping.grids.grid import Grid
from rumba_localisation.scan import thinned
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.kernel import Array

STRIDE, TURN = 0.08, 0.03  # [m], [rad] from pose to pose that is tried: a match finds what is twice as far off
WIDTH = 0.15  # [m] from a wall, at which the end of a beam counts nothing
APART = 2.5  # strides and turns within which poses are the same place
BEAMS = 90  # by which poses are tried, at most


def best_around(grid: Grid, pose: Pose, reach: float, turn: float, points: Array, count: int) -> List[Pose]:
    """The poses where a scan fits best, the best first, each some way from the others.

    Args:
        grid: the map.
        pose: around which it is looked, map frame.
        reach: how far off they may be, along x and along y [m].
        turn: how far they may be turned [rad].
        points: float64 (any, 2), where beams end, in the frame of the robot [m].
        count: of poses.
    """
    across, turns = _steps(reach, STRIDE), _steps(turn, TURN)
    offsets = np.stack(np.meshgrid(across, across), axis=-1).reshape(-1, 2)
    scores = np.empty((len(turns), len(offsets)))
    compiled_matching.look_around(np.array(pose), thinned(points, BEAMS), grid.field, *grid.origin, grid.resolution,
                                  offsets, turns, WIDTH, scores)
    found = []
    for _ in range(count):
        row, column = divmod(int(np.argmax(scores)), len(offsets))
        x, y = offsets[column].tolist()
        found.append(Pose(pose.x + x, pose.y + y, pose.theta + float(turns[row])))
        is_near = np.hypot(*(offsets - offsets[column]).T) < APART * STRIDE
        scores[np.ix_(np.abs(turns - turns[row]) < APART * TURN, is_near)] = -1.0
    return found


def _steps(reach: float, step: float) -> Array:
    """Steps from -reach to reach, and a little more, with 0 among them: float64 (any)."""
    count = math.ceil(reach / step)
    return np.arange(-count, count + 1) * step
