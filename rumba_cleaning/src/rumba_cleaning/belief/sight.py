"""What the laser of a robot sees, and the floor plan does not show."""

import math
from typing import Optional, Sequence

import numpy as np
from scipy import ndimage
from scipy.spatial import distance

from rumba_cleaning.belief.ground import ALL_AROUND
from rumba_cleaning.belief.met import NOTHING_SEEN, Seen
from rumba_localisation.mapping.grids import compiled_grid
from rumba_localisation.mapping.grids.grid import placed
from rumba_localisation.scan import Scan
from rumba_localisation.systematic import Systematic
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.compiling.compiled import fast
from rumba_sim.model.kernel import Array
from rumba_sim.model.maps.floor_plan import FloorPlan

# All figures below are our choice.
CELL = 0.04  # [m] side of a cell: a third of a chair's leg would need less, the time of a scan more
FARTHEST = 2.5  # [m] up to which the laser is believed: the error of the heading moves what is farther away too much
BESIDE = 0.1  # [m] from what the plan shows, within which nothing else is seen: an error of the pose is less, mostly
BEFORE = 0.06  # [m] before the end of a beam, up to which the floor is surely free
MATE = 0.4  # [m] around a mate, of which the radius is 0.17: it drives on
EACH = 0.2  # [s] from one scan that is looked at to the next
SURE = 1.5  # odds (their logarithm) from which on something is there: two beams that end in a cell, and few that pass
GONE = -1.5  # odds below which nothing is there any more: beams that graze an edge pass it now and then
EDGE = 2  # [cells] around what stays, what is seen stays too: it is the edge of the same thing
STAYS = 60.0  # [s] for which something was seen that stays: people and pets move on before
BODY = 0.7  # [m] around the robot, in which something can be in the way of what is ahead
MOVED = 0.1  # [m] after which a scan tells more of the systematic error of the laser
SPARE = 0.02  # [m] by which something is in the way, at least; paths keep farther away from what was seen before


class Sight:
    """Cells of the floor on which there is something that the plan does not show.

    What stands there is seen from afar; what moved on is not there any more as soon as beams pass. Points are (x, y)
    [m] in the map frame, in arrays float64 (any, 2).
    """

    def __init__(self, plan: FloorPlan) -> None:
        """Know a floor plan."""
        self._systematic = Systematic()
        self._from: Optional[Pose] = None  # where the robot was when it learnt from a scan
        self.learn(plan)

    def learn(self, plan: FloorPlan) -> None:
        """Go on with another plan, of which nothing was seen."""
        self._plan = plan
        self._shape = tuple(math.ceil(cells * plan.resolution / CELL) for cells in (plan.rows, plan.columns))
        self._waited = EACH  # [s] since the scan that was looked at last
        self._now = 0.0  # [s]
        self._odds: Optional[Array] = None  # of each cell, as `Grid`; None until something is seen

    def look(self, pose: Pose, scan: Scan, mates: Sequence[Pose], dt: float) -> None:
        """Take a scan into account.

        Args:
            pose: of the laser [m, rad], map frame.
            scan: what it told.
            mates: poses of other robots, which are not obstacles.
            dt: time since the scan before [s].
        """
        self._now += dt
        self._waited += dt
        if self._waited < EACH - 0.5 * dt:
            return
        self._waited = 0.0
        scan = self._corrected(pose, scan)
        away = np.hypot(*scan.points.T)
        near = away <= FARTHEST
        ends = placed(pose, scan.points[near])
        is_news = self._is_news(ends, mates)
        if self._odds is None:
            if not is_news.any():
                return
            self._begin()
        short = np.maximum(away[near][~is_news] - BEFORE, 0.0) / np.maximum(away[near][~is_news], BEFORE)
        free = np.concatenate([
            scan.points[near][~is_news] * short[:, None],
            scan.points[~near] * (FARTHEST / away[~near])[:, None],
            scan.beyond * (FARTHEST / np.maximum(np.hypot(*scan.beyond.T), FARTHEST))[:, None]])
        self._add(pose, placed(pose, free), False)
        self._add(pose, ends[is_news], True)

    def _corrected(self, pose: Pose, scan: Scan) -> Scan:
        """A scan without the systematic error of the laser."""
        last = self._from
        if last is None or math.hypot(pose.x - last.x, pose.y - last.y) >= MOVED:
            self._from = pose
            self._systematic.follow(scan)
        return self._systematic.corrected(scan)

    def _begin(self) -> None:
        self._odds = np.zeros(self._shape, np.float32)
        self._hits = np.zeros((*self._shape, 5), np.float32)
        self._since = np.full(self._shape, np.nan, np.float32)  # [s] when something was first seen there

    def _is_news(self, ends: Array, mates: Sequence[Pose]) -> Array:
        """Whether beams that end at points met something that is neither on the plan nor a mate: bool (any)."""
        plan = self._plan
        found = np.asarray(fast.interpolated_at(plan.clearance, *plan.origin, plan.resolution, ends)) > BESIDE
        low, high = np.array(plan.bounds[:2]), np.array(plan.bounds[2:])
        found &= ((ends > low) & (ends < high)).all(axis=1)
        for mate in mates:
            found &= np.hypot(ends[:, 0] - mate.x, ends[:, 1] - mate.y) > MATE
        return found

    def _add(self, pose: Pose, ends: Array, has_echo: bool) -> None:
        """Take beams into account that end at points."""
        limit = np.array(self._shape)[::-1] - 1e-6
        cells = np.clip((ends - self._plan.origin) / CELL, 0.0, limit)
        x, y = np.clip((np.array(pose[:2]) - self._plan.origin) / CELL, 0.0, limit).tolist()
        compiled_grid.add_beams(self._odds, self._hits, x, y, cells, np.ones(len(cells)), has_echo)

    def seen(self) -> Seen:
        """The middles of the cells on which there is something."""
        if self._odds is None:
            return NOTHING_SEEN
        there = self._odds > SURE
        self._since[self._odds < GONE] = np.nan
        self._since[there & np.isnan(self._since)] = self._now
        stays = there & ndimage.binary_dilation(there & (self._now - self._since >= STAYS), ALL_AROUND, EDGE)
        return Seen(self._middles(there & ~stays), self._middles(stays))

    def _middles(self, cells: Array) -> Array:
        return (np.argwhere(cells)[:, ::-1] + 0.5) * CELL + self._plan.origin

    def forget(self, points: Array) -> None:
        """Forget what is at points (any, 2) [m] that were seen, until it is seen again; what stayed stays at once."""
        if self._odds is not None:
            column, row = ((points - self._plan.origin) / CELL).astype(np.intp).T
            self._odds[row, column] = 0.0

    def in_way(self, pose: Pose, ahead: Array, reach: float) -> Array:
        """Points of what is in the way of a robot that will drive to other points.

        Args:
            pose: of the robot, map frame.
            ahead: points on its way.
            reach: distance at which it touches something [m]; what it touches already is not in its way, unless it
                drives against it.
        """
        middles = self._near(pose.x, pose.y, BODY)
        nearest = distance.cdist(ahead, middles).min(axis=0, initial=np.inf)
        here = np.hypot(*(middles - pose[:2]).T)
        return middles[nearest < np.minimum(reach, here) - SPARE]

    def is_seen(self, x: float, y: float, within: float) -> bool:
        """Whether something is seen at a point [m], or within a distance of it [m]."""
        return bool((np.hypot(*(self._near(x, y, within) - (x, y)).T) <= within).any())

    def _near(self, x: float, y: float, within: float) -> Array:
        """The middles of the cells on which there is something, in a square around a point [m]."""
        if self._odds is None:
            return NOTHING_SEEN.passing
        size = int(within / CELL) + 1
        column, row = (int(cells) for cells in (np.array([x, y]) - self._plan.origin) / CELL)
        top, left = max(row - size, 0), max(column - size, 0)
        found = np.argwhere(self._odds[top:max(row + size + 1, 0), left:max(column + size + 1, 0)] > SURE)
        return (found[:, ::-1] + (left + 0.5, top + 0.5)) * CELL + self._plan.origin
