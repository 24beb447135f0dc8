"""Where a scan fits best near a place, also if the wheels slipped on the way there."""

import math
from typing import NamedTuple, Optional

import numpy as np

from rumba_localisation import compiled_matching, particles
from rumba_localisation.localiser_config import LocaliserConfig
from rumba_localisation.scan import Scan, thinned
from rumba_localisation.search import NEAR, WRONG, Search
from rumba_localisation.walls import Walls
from rumba_sim.model.common.geometry import Pose, wrap_angle
from rumba_sim.model.kernel import Array

STEPS = np.geomspace(0.15, 0.03, 6)  # [m] sigmas of `match`
MATCHED = 180  # beams, at most, by which a pose is refined
FITS = 0.25  # share of beams that end at a wall, at least: what the map does not show may hide most of it
GOOD, STARTS = 0.85, 8  # a fit below which a match begins also at so many of the heaviest particles
WORSE = 0.8  # times the average fit, below which the wheels may have slipped
SOON, LATE = 0.1, 0.01  # weights of each scan in that average: while the robot knows its place, and while it does not
DOUBT = 0.1  # the share by which scans go worse with the estimates than usual, from which on these are in doubt
AWAY = 0.1  # of the beams have to fit better after NEAR of slip, and as many after half a turn: less slip is likelier
SLIPPED = np.diag([0.1, 0.1, 0.1]) ** 2  # variances of where it slipped to, within what is tried [m^2, m^2, rad^2]
HELD = np.diag([0.02, 0.02, 0.02]) ** 2  # least variances of the prior of a match [m^2, m^2, rad^2]
INDEPENDENT = 0.2  # share of the beams of a match that err independently: the map errs with its neighbours alike


class Match(NamedTuple):
    """Where a scan fits."""

    pose: Array  # float64 (3) [m, m, rad]
    covariance: Array  # float64 (3, 3)
    fit: float  # [0..1] share of the beams that end at a wall
    through: float  # [0..1] share of the beams that would have to pass through walls

    @property
    def plausibility(self) -> float:
        """How well the scan goes with the pose [0..1], whatever stands before the walls unless it hides most."""
        return min(max(1.0 - WRONG * self.through, 0.0), self.fit / FITS)

    @property
    def quality(self) -> float:
        """What decides between matches of one scan."""
        return self.fit - WRONG * self.through


class Matcher:
    """Matches scans with walls, and knows how well they usually go with their matches."""

    def __init__(self, walls: Walls, search: Search, config: LocaliserConfig) -> None:
        """Match with walls, and look for a robot that slipped by a search."""
        self._walls, self._search, self._config = walls, search, config
        self.begin()

    def begin(self) -> None:
        """Know nothing of how well scans fit."""
        self._fit = 0.0  # average share of beams that end at a wall
        self._slow = self._fast = 0.0  # averages of the plausibility

    @property
    def usual(self) -> float:
        """Plausibility of matches so far [0..1]."""
        return max(self._slow, self._fast)

    @property
    def decline(self) -> float:
        """The share by which scans go worse with their matches than in the long run, at most 1."""
        return 1.0 - self._fast / self._slow if self._slow > 0.0 else 0.0

    def follow(self, match: Match, is_sure: bool) -> None:
        """Count how well the newest scan fits; how well it should fit is learnt slowly where that may be wrong."""
        config, now = self._config, match.plausibility
        self._slow += (config.recovery_alpha_slow if self._slow > 0.0 else 1.0) * (now - self._slow)
        self._fast += (config.recovery_alpha_fast if self._fast > 0.0 else 1.0) * (now - self._fast)
        self._fit += (1.0 if self._fit == 0.0 else SOON if is_sure else LATE) * (match.fit - self._fit)

    def is_good(self, match: Match) -> bool:
        """Whether a scan fits as well as scans usually do."""
        return match.fit >= WORSE * self._fit and match.plausibility >= (1.0 - DOUBT) * self.usual

    def is_surprising(self, pose: Array, points: Array) -> bool:
        """Whether a scan fits worse at a pose (3) than scans usually fit where they match.

        Args:
            pose: [m, m, rad].
            points: float64 (beams, 2), where beams end in the frame of the robot [m].
        """
        walls = self._walls
        few = thinned(points, self._config.laser_max_beams)
        fit = compiled_matching.normal_equations(pose, few, np.zeros(len(few)), walls.distance, *walls.origin,
                                                 walls.resolution, STEPS[-1], np.empty((3, 3)), np.empty(3))
        return bool(fit < WORSE * self._fit)

    def best(self, cluster: particles.Cluster, poses: Array, share: Array, scan: Scan) -> Match:
        """Where a scan fits best near a cluster.

        Args:
            cluster: of particles.
            poses: float64 (any, 3), particles; a match begins also at the heaviest if one does not fit well.
            share: float64 (any), their weights.
            scan: with echoes.
        """
        match = self._matched(cluster.mean, cluster.covariance, scan)
        if match.fit < GOOD:  # perhaps the far side of a thin wall: it may fit better from elsewhere in the cluster
            heaviest = poses[np.argsort(-share, kind='stable')[:STARTS]]
            starts = [self._matched(start, cluster.covariance, scan) for start in heaviest]
            match = max([match, *starts], key=lambda each: each.quality)
        return match

    def slipped(self, place: Pose, scan: Scan) -> Optional[Match]:
        """Where around a place a scan fits as well as usual; None if it does nowhere.

        Args:
            place: where the robot would be if its wheels had not slipped [m, rad], map frame.
            scan: as for `best`.
        """
        found = [self._matched(start, SLIPPED, scan) for start in self._search.near(place, scan.points)]
        good = [match for match in found if self.is_good(match)]
        return max(good, key=lambda match: match.quality - _slip(place, match.pose)) if good else None

    def _matched(self, start: Array, prior: Array, scan: Scan) -> Match:
        walls, pose, covariance = self._walls, np.empty(3), np.empty((3, 3))
        few = thinned(scan.points, MATCHED)
        fit = compiled_matching.match(start, prior + HELD, few, np.zeros(len(few)), walls.distance, *walls.origin,
                                      walls.resolution, STEPS, INDEPENDENT, pose, covariance)
        through = walls.through(pose, thinned(scan.points, self._config.laser_max_beams), scan.laser)
        return Match(pose, covariance, fit, through)


def _slip(before: Pose, after: Array) -> float:
    """What speaks against a slip from a pose to another one (3), as a share of beams."""
    turn = wrap_angle(float(after[2]) - before.theta)
    return AWAY * (math.hypot(after[0] - before.x, after[1] - before.y) / NEAR + abs(turn) / math.pi)
