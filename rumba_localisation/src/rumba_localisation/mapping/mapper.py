"""Makes a map of a floor that a robot has never seen, by its odometry and its laser, and finds its place on that."""

import collections
import math
from typing import Dict, Optional, Sequence, Tuple

import numpy as np

from rumba_localisation.localiser import START, Estimate
from rumba_localisation.mapping.believed_plan import believed_plan
from rumba_localisation.mapping.clear_match import Sought, clear_match
from rumba_localisation.mapping.findings import Findings
from rumba_localisation.mapping.grids.grid import Grid
from rumba_localisation.mapping.key_frames import KeyFrames
from rumba_localisation.mapping.loop_closure import LoopClosure
from rumba_localisation.mapping.mapper_config import MapperConfig
from rumba_localisation.mapping.relocation import Relocation
from rumba_localisation.mapping.tracker import INDEPENDENT, LEAST, MATCHED, TWIST, Tracker
from rumba_localisation.noise import Noise
from rumba_localisation.scan import Scan, is_blind, thinned
from rumba_localisation.systematic import Systematic
from rumba_sim.model.common.geometry import Pose, compose, inverse, wrap_angle
from rumba_sim.model.kernel import Array
from rumba_sim.model.maps.floor_plan import FloorPlan

FINE, COARSE, LARGEST = 0.02, 0.05, 0.2  # [m] side of a cell at first, by noise at most, and of a large map at most
SHOWN = 0.025  # [m] side of a cell of the plan, at most: robots drive along walls
COARSER = 2.5  # narrowest sigmas of a match in the side of a cell, from which on cells get larger
MOST = 6_000_000  # cells, at most, with 28 bytes each
SPACING, VISITS = 0.25, 4  # [m] side of a square of the floor, and scans from there that the map shows
UNSEEN = 0.05  # share of the beams that end on unknown floor, from which on a scan from anywhere is added
AT_ONCE = 4  # scans that are added before distances are measured again
ASTRAY = 0.3  # share of the beams that cannot be where they are, from which on the robot was carried away ...
LOST_AFTER = 5  # ... in so many scans, one after the other; meanwhile the map stays as it is
SLID = 1.0  # [m] along each axis, by which a robot may be off that was not carried away
FOLLOWED = 1.0  # [m] of way since the newest key frame, from which on a scan was rather found by older ones nearby
CERTAIN = np.diag(LEAST)


class Mapper:
    """Matches each scan with the map of those before it, and adds it; redraws the map if a loop closes.

    Attributes:
        config: parameters.
        correction: pose of the frame of the odometry in the map frame.
        estimate: where the robot was at the newest scan that was used; None before the first.
        grid: the map so far.
        version: rises with each change of it.
        redrawn: how many times the map was redrawn; what was found on it must then move, as `moved` says.
        noise: of the laser, with that of the map.
        systematic: what all ranges of the laser have in common; the map is drawn without it.
        is_full: whether a scan was left out, since the map would have been too large with it.
    """

    def __init__(self, start: Pose = Pose(0.0, 0.0, 0.0), config: MapperConfig = MapperConfig()) -> None:
        """Begin a map.

        Args:
            start: where the robot is at the first scan; this defines the map frame [m, rad].
            config: parameters.
        """
        self.config = config
        self._start = start
        self.grid = Grid(config.delta or FINE)
        self.noise = Noise(config.sigma)
        self.systematic = Systematic()
        self.correction = Pose(0.0, 0.0, 0.0)
        self.estimate: Optional[Estimate] = None
        self.version = self.redrawn = 0
        self.is_full = False
        self._frames = KeyFrames()
        self._closure = LoopClosure(self._frames, self.noise)
        self._tracker = Tracker(config, self.noise)
        self._visits: Dict[Tuple[int, int], int] = {}  # scans by the square of the floor in which they were taken
        self._added = 0  # scans since the distances on the grid were measured
        self._misfits = 0  # scans, one after the other
        self._search: Optional[Relocation] = None  # for the place of a robot that was carried away
        self._last: Optional[Pose] = None  # odometry at the newest scan that was used

    @property
    def is_lost(self) -> bool:
        """Whether the robot was carried away, and is looked for."""
        return self._search is not None

    @property
    def is_contradicted(self) -> bool:
        """Whether scans tell other movements than the odometry, one after the other: a laser mounted otherwise does."""
        return self._tracker.surprise > 0.5

    def pose(self, odometry: Pose) -> Pose:
        """Where the robot is, from its odometry, by the newest correction."""
        return compose(self.correction, odometry)

    def observe(self, odometry: Pose, scan: Scan) -> bool:
        """Take a scan into account, if the robot has moved enough since the last one.

        Args:
            odometry: pose by odometry when the scan was taken.
            scan: what the laser told.

        Returns:
            Whether it was used: there is a new estimate and a new correction.
        """
        last = self._last
        if last is not None and not self._has_moved(last, odometry):
            return False
        scan = self._corrected(scan)
        if last is None:
            estimate = Estimate(self._start, CERTAIN, 1.0, True)
        elif self._search is not None:
            return self._find(self._search, odometry, scan)
        else:
            estimate = self._judged(self._tracker.follow(self.grid, self.pose(odometry), last, odometry, scan),
                                    odometry, scan)
        self._last, self.estimate = odometry, estimate
        self.correction = compose(estimate.pose, inverse(odometry))
        if self._search is None and self._misfits == 0 and self._is_news(estimate.pose, scan.points):
            self._add(estimate, scan)
            self.correction = compose(self.estimate.pose, inverse(odometry))
        return True

    def plan(self, name: str, dock: Optional[Pose] = None, findings: Optional[Findings] = None) -> FloorPlan:
        """The plan that the map shows, as from `believed_plan`.

        A laser that errs is matched with coarse cells. Unless their side was told, those of the plan are parts of them.
        """
        return believed_plan(self.grid, name, dock, findings, self.config.delta or SHOWN)

    @property
    def frames(self) -> Sequence[Pose]:
        """Where the scans were taken that the map shows, map frame; each keeps its number if it moves."""
        return self._frames.poses

    def moved(self, pose: Pose) -> Pose:
        """Where on the redrawn map is what was at a pose before [m, rad]."""
        return self._frames.moved(pose)

    def _corrected(self, scan: Scan) -> Scan:
        """A scan without the systematic error; if more is known of that, the map is drawn again, and noise learnt."""
        known = self.systematic.error
        if self._search is None and self.systematic.follow(scan):
            self._frames.lengthen(known - self.systematic.error)
            self.noise.begin()
            fine = self.config.delta or FINE
            is_small = self.grid.odds.size * (self.grid.resolution / fine) ** 2 <= MOST
            self._draw(fine if is_small else self.grid.resolution)
        return self.systematic.corrected(scan)

    def _add(self, estimate: Estimate, scan: Scan) -> None:
        """Add a scan to the map, and redraw the map if that closes a loop."""
        if not self._has_room(estimate.pose, scan):
            self.is_full = True
            return
        self.grid.add(estimate.pose, scan, self.noise)
        self.version += 1
        self._added += 1
        if self._added >= AT_ONCE or not self._frames.poses:
            self.grid.measure()
            self._added = 0
        if self._closure.closes(self._keep(estimate, scan), scan, self.grid.resolution):
            self._redraw(estimate)
        side = min(round(self.noise.kernel, 2), COARSE)
        if self.noise.is_settled and not self.config.delta and side >= COARSER * self.grid.resolution:
            self._draw(side)

    def _has_room(self, pose: Pose, scan: Scan) -> bool:
        """Whether there is room for a scan, perhaps with larger cells."""
        cells = self.grid.size_with(pose, scan)
        if cells <= MOST:
            return True
        side = math.ceil(100.0 * self.grid.resolution * math.sqrt(cells / MOST) + 1.0) / 100.0
        if side > LARGEST:
            return False
        self._draw(side)
        return True

    def _draw(self, side: float) -> None:
        """Draw the map of the key frames, with cells of a side [m]."""
        frames = self._frames
        self.grid = frames.drawn(np.arange(len(frames.poses)), side, self.noise) if frames.poses else Grid(side)
        self.version += 1
        self._added = 0

    def _keep(self, estimate: Estimate, scan: Scan) -> int:
        """Make a scan a key frame, which was found from the one before, or from the map nearby; returns its number."""
        frames, pose, tracker = self._frames, estimate.pose, self._tracker
        is_first, is_next = not frames.poses, tracker.way < FOLLOWED
        before = len(frames.poses) - 1 if is_first or is_next else frames.nearest(pose.x, pose.y)
        frame = frames.add(pose, scan)
        if not is_first:
            frames.link(before, frame, pose, tracker.drift if is_next else INDEPENDENT * estimate.covariance)
        tracker.begin_way()
        return frame

    def _redraw(self, estimate: Estimate) -> None:
        """Move the key frames to where they contradict each other least, and draw the map of them."""
        frames = self._frames
        frames.optimise()
        self._draw(self.grid.resolution)
        self.estimate = estimate._replace(pose=frames.poses[-1])
        self.redrawn += 1
        self._visits = dict(collections.Counter(_square(pose) for pose in frames.poses))

    def _judged(self, estimate: Estimate, odometry: Pose, scan: Scan) -> Estimate:
        """If a scan does not fit, look nearby: wheels err along a bare corridor; in the end, look all over the map."""
        grid, ends = self.grid, scan.points
        if is_blind(ends) or grid.share_wrong(estimate.pose, scan, self.noise) < ASTRAY:
            self._misfits = 0
            self.noise.follow(np.array(estimate.pose), thinned(ends, MATCHED), scan.laser, grid.field, *grid.origin,
                              grid.resolution)
            return estimate
        self._misfits += 1
        near = clear_match(grid, Sought(estimate.pose, SLID, TWIST, ends, scan), self.noise)
        if near is not None:
            self._misfits = 0
            self._tracker.begin_way(math.inf)
            return Estimate(near.pose, near.covariance, near.fit, True)
        if self._misfits < LOST_AFTER:
            return estimate
        self._search = Relocation(grid, self.noise, compose(estimate.pose, inverse(odometry)))
        return estimate._replace(covariance=START, is_sure=False)

    def _find(self, search: Relocation, odometry: Pose, scan: Scan) -> bool:
        """Look for the place all over the map so far, which stays as it is meanwhile."""
        found = search.observe(odometry, scan)
        self._last = odometry
        self.estimate = found or Estimate(self.pose(odometry), START, 0.0, False)
        if found is not None:
            self.correction = compose(found.pose, inverse(odometry))
            self._search, self._misfits = None, 0
            self._tracker.begin_way(math.inf)
        return True

    def _is_news(self, pose: Pose, ends: Array) -> bool:
        """Whether a scan tells something new: it was taken where few were, or sees unknown floor."""
        place = _square(pose)
        count = self._visits[place] = self._visits.get(place, 0) + 1
        return count <= VISITS or self.grid.share_unknown(pose, ends) > UNSEEN

    def _has_moved(self, last: Pose, odometry: Pose) -> bool:
        return (math.hypot(odometry.x - last.x, odometry.y - last.y) >= self.config.update_min_d
                or abs(wrap_angle(odometry.theta - last.theta)) >= self.config.update_min_a)


def _square(pose: Pose) -> Tuple[int, int]:
    """The square of the floor in which a pose is."""
    return math.floor(pose.x / SPACING), math.floor(pose.y / SPACING)
