"""The way along the walls, on which the brush reaches its rim: parts of it beside what was missed there."""

from typing import Optional

import numpy as np
from scipy import spatial

from rumba_cleaning.belief.ground import Ground
from rumba_cleaning.compiled_bearings import bearings
from rumba_cleaning.planning.common.compiled_ways import NONE
from rumba_cleaning.planning.common.nearest import nearest
from rumba_cleaning.planning.common.polyline import SPACING
from rumba_cleaning.planning.swaths.rings import SHORTEST, outlines
from rumba_sim.model.kernel import Array

# Our choice.
REACH = 0.1  # [m] from the way to the middle of a cell, beyond which the brush does not sweep it from there
LONGEST = 0.6  # [m] of a part: what was missed on both sides of a thin wall has no part in common
LEAD = 0.04  # [m] before and behind what was missed: large drives straight there, small takes less time
BENT = 0.8  # [rad] that a part may turn: in a sharper corner the robot leaves what it left before
AHEAD = 3  # waypoints over which its direction is measured


class Walls:
    """The outermost rings of a floor.

    Attributes:
        outlines: as those of `rings`.
    """

    def __init__(self, ground: Ground) -> None:
        """Find them."""
        self.outlines = outlines(ground)
        self._rings = [path for path in self.outlines
                       if len(path) * SPACING >= SHORTEST and np.allclose(path[0], path[-1])]
        self._tree = spatial.cKDTree(np.concatenate([np.zeros((0, 2)), *self._rings]))
        self._begins = np.cumsum([0, *(len(ring) for ring in self._rings)])

    def beside(self, points: Array) -> Optional[Array]:
        """The part of one ring beside all points (any, 2) [m]: float64 (any, 2) [m]; None: there is no straight one."""
        beside = nearest(self._tree, points, 1, REACH)[:, 0]
        if (beside == NONE).any():
            return None
        number = int(np.searchsorted(self._begins, beside[0], side='right')) - 1
        ring = self._rings[number]
        size = len(ring) - 1
        along = (beside - beside[0] + size // 2) % size - size // 2  # waypoints from the first of the points
        lead = int(LEAD / SPACING)
        first, last = int(along.min()) - lead, int(along.max()) + lead
        is_one = ((beside >= self._begins[number]) & (beside < self._begins[number + 1])).all()
        if not is_one or (last - first) * SPACING > LONGEST or last - first >= size:
            return None
        part = ring[(beside[0] - self._begins[number] + np.arange(first, last + 1)) % size]
        return part if _turned(part) < BENT else None


def _turned(path: Array) -> float:
    """The angle between the first direction of a path (any, 2) and the one that differs most from it [rad]."""
    ahead = min(AHEAD, len(path) - 1)
    headings = bearings(path[ahead:] - path[:-ahead])
    return float(np.abs(np.unwrap(headings) - headings[0]).max())
