"""Makes a map of a floor that a robot has never seen, by its odometry and its laser, and finds its place on that."""

import collections
import math
from typing import Dict, Optional, Sequence, Tuple

import numpy as np

from rumba_localisation import compiled_matching
from rumba_localisation.compiled_matrices import inverse as inverted
from rumba_localisation.localiser import START, Estimate, Localiser
from rumba_localisation.mapping.believed_plan import believed_plan
from rumba_localisation.mapping.clear_match import clear_match
from rumba_localisation.mapping.grid import RESOLUTION, Grid
from rumba_localisation.mapping.key_frames import KeyFrames
from rumba_localisation.mapping.loop_closure import LoopClosure
from rumba_localisation.mapping.mapper_config import MapperConfig
from rumba_localisation.scan import Scan, is_blind, thinned
from rumba_sim.model.geometry import Pose, compose, inverse, wrap_angle
from rumba_sim.model.kernel import Array

STEPS = np.geomspace(0.1, 0.02, 6)  # [m] sigmas of `match`
MATCHED = 180  # beams, at most, by which a pose is found
INDEPENDENT = 0.2  # share of the beams of a match that err independently
SPACING, VISITS = 0.25, 4  # [m] side of a square of the floor, and scans from there that the map shows
UNSEEN = 0.05  # share of the beams that end on unknown floor, from which on a scan from anywhere is added
AT_ONCE = 4  # scans that are added before distances are measured again
LEAST = np.array([0.005, 0.005, 0.005]) ** 2  # variances of any movement [m^2, m^2, rad^2]
OPEN = 0.1  # [m] of standard deviation of the place, at most, that is left open: as far off a match finds it
GOOD = 0.75  # a fit below which other starts of a match are tried ...
BETTER = 0.1  # ... whose fit must be better by so much: in a corridor all fit alike
SLIPPED = np.diag([0.1, 0.1, 0.05]) ** 2  # covariance of these
LOST_FIT, LOST_AFTER = 0.6, 5  # the robot was carried away if, of the beams that end on known floor, so few fit in so
#                                many scans, one after the other; meanwhile the map stays as it is
SLID = 1.0  # [m] along each axis, by which a robot may be off that was not carried away
FOUND_FIT = 0.6  # from which on a place that was looked for is believed
DRIFT = np.diag([0.0003, 0.0003, 0.0002]) ** 2  # variances by which the map drifts with each scan [m^2, m^2, rad^2]: as
#                                                 measured on the first 24 m of drives around an office
FOLLOWED = 1.0  # [m] of way since the newest key frame, from which on a scan was rather found by older ones nearby
CERTAIN = np.diag(LEAST)


class Mapper:
    """Matches each scan with the map of those before it, and adds it; redraws the map if a loop closes.

    The laser is in the centre of the robot and looks forward, as a Rumba's.

    Attributes:
        config: parameters.
        correction: pose of the frame of the odometry in the map frame.
        estimate: where the robot was at the newest scan that was used; None before the first.
        grid: the map so far.
        version: rises with each change of it.
        redrawn: how many times the map was redrawn; what was found on it must then move, as `moved` says.
    """

    def __init__(self, start: Pose = Pose(0.0, 0.0, 0.0), config: MapperConfig = MapperConfig(),
                 radius: float = 0.17425, range_max: float = 8.0) -> None:
        """Begin a map.

        Args:
            start: where the robot is at the first scan; this defines the map frame [m, rad].
            config: parameters.
            radius: of the robot [m].
            range_max: of its laser [m].
        """
        self.config = config
        self._start, self._radius, self._range_max = start, radius, range_max
        self.grid = Grid()
        self.correction = Pose(0.0, 0.0, 0.0)
        self.estimate: Optional[Estimate] = None
        self.version = self.redrawn = 0
        self._frames = KeyFrames()
        self._closure = LoopClosure(self._frames)
        self._open = np.zeros((3, 3))  # covariance of the errors of the odometry that scans left open
        self._drift = np.zeros((3, 3))  # covariance of the way since the newest key frame
        self._way = 0.0  # [m] since then; infinite if the robot was carried away
        self._visits: Dict[Tuple[int, int], int] = {}  # scans by the square of the floor in which they were taken
        self._added = 0  # scans since the distances on the grid were measured
        self._misfits = 0  # scans, one after the other
        self._search: Optional[Localiser] = None  # for the place of a robot that was carried away
        self._last: Optional[Pose] = None  # odometry at the newest scan that was used

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
        if last is None:
            estimate = Estimate(self._start, CERTAIN, 1.0, True)
        elif not self._has_moved(last, odometry):
            return False
        elif self._search is not None:
            return self._find(self._search, odometry, scan.points)
        else:
            estimate = self._judged(self._followed(last, odometry, scan.points), scan.points)
        self._last, self.estimate = odometry, estimate
        self.correction = compose(estimate.pose, inverse(odometry))
        if self._search is None and self._misfits == 0 and self._is_news(estimate.pose, scan.points):
            self._add(estimate, scan)
            self.correction = compose(self.estimate.pose, inverse(odometry))
        return True

    def _followed(self, last: Pose, odometry: Pose, ends: Array) -> Estimate:
        """Where a scan fits; keeps account of the errors of the odometry since the last one."""
        estimate, movement = self._matched(last, odometry, ends)
        left = _share_left(estimate.covariance, self._open + movement)
        self._open = _bounded(left @ (self._open + movement) @ left.T)
        self._drift += left @ movement @ left.T + DRIFT
        self._way += math.hypot(odometry.x - last.x, odometry.y - last.y)
        return estimate

    @property
    def frames(self) -> Sequence[Pose]:
        """Where the scans were taken that the map shows, map frame; each keeps its number if it moves."""
        return self._frames.poses

    def moved(self, pose: Pose) -> Pose:
        """Where on the redrawn map is what was at a pose before [m, rad]."""
        return self._frames.moved(pose)

    def _add(self, estimate: Estimate, scan: Scan) -> None:
        """Add a scan to the map, and redraw the map if that closes a loop."""
        self.grid.add(estimate.pose, scan.points, scan.beyond)
        self.version += 1
        self._added += 1
        if self._added >= AT_ONCE or self.version == 1:
            self.grid.measure()
            self._added = 0
        if self._closure.closes(self._keep(estimate, scan), scan.points):
            self._redraw(estimate)

    def _keep(self, estimate: Estimate, scan: Scan) -> int:
        """Make a scan a key frame, which was found from the one before, or from the map nearby; returns its number."""
        frames, pose = self._frames, estimate.pose
        is_first, is_next = not frames.poses, self._way < FOLLOWED
        before = len(frames.poses) - 1 if is_first or is_next else frames.nearest(pose.x, pose.y)
        frame = frames.add(pose, scan)
        if not is_first:
            frames.link(before, frame, pose, self._drift if is_next else INDEPENDENT * estimate.covariance)
        self._way, self._drift = 0.0, np.zeros((3, 3))
        return frame

    def _redraw(self, estimate: Estimate) -> None:
        """Move the key frames to where they contradict each other least, and draw the map of them."""
        frames = self._frames
        frames.optimise()
        self.grid = frames.drawn(np.arange(len(frames.poses)))
        self.estimate = estimate._replace(pose=frames.poses[-1])
        self.version += 1
        self.redrawn += 1
        self._added = 0
        self._visits = dict(collections.Counter(_square(pose) for pose in frames.poses))

    def _judged(self, estimate: Estimate, ends: Array) -> Estimate:
        """If a scan does not fit, look nearby: wheels err along a bare corridor; in the end, look all over the map."""
        known = 1.0 - self.grid.share_unknown(estimate.pose, ends)
        if is_blind(ends) or estimate.fit >= LOST_FIT * known:
            self._misfits = 0
            return estimate
        self._misfits += 1
        near = clear_match(self.grid, estimate.pose, SLID, ends, LOST_FIT)
        if near is not None:
            self._misfits, self._way = 0, math.inf
            return Estimate(near.pose, near.covariance, near.fit, True)
        if self._misfits < LOST_AFTER:
            return estimate
        self._search = Localiser(believed_plan(self.grid, 'the map so far'), self._radius, self._range_max)
        return estimate._replace(covariance=START, is_sure=False)

    def _find(self, search: Localiser, odometry: Pose, ends: Array) -> bool:
        """Look for the place all over the map so far, which stays as it is meanwhile."""
        if not search.observe(odometry, ends):
            return False
        assert search.estimate is not None
        self._last, self.estimate, self.correction = odometry, search.estimate, search.correction
        if search.estimate.is_sure and search.estimate.fit > FOUND_FIT:
            self._search, self._misfits, self._way = None, 0, math.inf
        return True

    def _is_news(self, pose: Pose, ends: Array) -> bool:
        """Whether a scan tells something new: it was taken where few were, or sees unknown floor."""
        place = _square(pose)
        count = self._visits[place] = self._visits.get(place, 0) + 1
        return count <= VISITS or self.grid.share_unknown(pose, ends) > UNSEEN

    def _has_moved(self, last: Pose, odometry: Pose) -> bool:
        return (math.hypot(odometry.x - last.x, odometry.y - last.y) >= self.config.update_min_d
                or abs(wrap_angle(odometry.theta - last.theta)) >= self.config.update_min_a)

    def _matched(self, last: Pose, odometry: Pose, ends: Array) -> Tuple[Estimate, Array]:
        """Where a scan fits, near where the odometry has the robot, and the covariance (3, 3) of the movement.

        If it does not fit there, perhaps the wheels slipped, or the robot was pushed: it may fit better near the place
        where the robot was before, or farther away from where the odometry has it. Along a bare corridor errors of
        earlier movements are still open, and are corrected together.

        Args:
            last, odometry: pose by odometry at the scan before, and now.
            ends: where the beams end, in the frame of the laser [m].
        """
        supposed, spread = self.pose(odometry), self._spread(last, odometry)
        prior = self._open + spread
        if is_blind(ends):
            return Estimate(supposed, prior, 0.0, True), spread
        best = self._match(supposed, prior, ends)
        if best.fit < GOOD:
            before = self.pose(last)._replace(theta=supposed.theta)
            others = [self._match(start, SLIPPED, ends) for start in (supposed, before)]
            better = max(others, key=lambda each: each.fit)
            if better.fit > best.fit + BETTER:
                return better, SLIPPED
        return best, spread

    def _match(self, start: Pose, prior: Array, ends: Array) -> Estimate:
        """Where a scan fits near a pose, which has a covariance (3, 3)."""
        found, covariance = np.empty(3), np.empty((3, 3))
        fit = compiled_matching.match(np.array(start), prior, thinned(ends, MATCHED), self.grid.field,
                                      *self.grid.origin, RESOLUTION, STEPS, INDEPENDENT, found, covariance)
        x, y, theta = found.tolist()
        return Estimate(Pose(x, y, wrap_angle(theta)), covariance, fit, True)

    def _spread(self, last: Pose, odometry: Pose) -> Array:
        """Covariance of a movement (3, 3): Probabilistic Robotics (Thrun, Burgard, Fox 2005), table 5.6."""
        config = self.config
        way = (odometry.x - last.x) ** 2 + (odometry.y - last.y) ** 2
        turn = wrap_angle(odometry.theta - last.theta) ** 2
        place = config.odom_alpha3 * way + config.odom_alpha4 * turn
        return np.diag(LEAST + (place, place, config.odom_alpha1 * turn + config.odom_alpha2 * way))


def _share_left(covariance: Array, prior: Array) -> Array:
    """Which part (3, 3) of the error of the odometry is left in an estimate: it adds up from scan to scan.

    The rest is noise of the scan. It does not add up, since all scans in sight were matched with the same map.

    Args:
        covariance: float64 (3, 3), of the estimate.
        prior: float64 (3, 3), of what the odometry told before it.
    """
    held = inverted(prior)
    seen = (inverted(covariance) - held) / INDEPENDENT
    return np.asarray(inverted(seen + held) @ held)


def _bounded(covariance: Array) -> Array:
    """A covariance (3, 3), scaled so that the standard deviation of the place is at most OPEN."""
    return covariance * min(1.0, OPEN ** 2 / max(float(covariance[0, 0] + covariance[1, 1]), OPEN ** 2))


def _square(pose: Pose) -> Tuple[int, int]:
    """The square of the floor in which a pose is."""
    return math.floor(pose.x / SPACING), math.floor(pose.y / SPACING)
