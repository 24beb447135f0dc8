"""Where a robot is from scan to scan, by its odometry and a map that grows."""

import math
from typing import Tuple

import numpy as np

from rumba_localisation.compiled_matrices import inverse as inverted
from rumba_localisation.localiser import Estimate
from rumba_localisation.mapping.clear_match import WRONG
from rumba_localisation.mapping.grids.grid import Grid
from rumba_localisation.mapping.look_around import best_around
from rumba_localisation.mapping.mapper_config import MapperConfig
from rumba_localisation.noise import Noise
from rumba_localisation.scan import Scan, is_blind, thinned
from rumba_sim.model.common.geometry import Pose, wrap_angle
from rumba_sim.model.kernel import Array

MATCHED = 180  # beams, at most, by which a pose is found
INDEPENDENT = 0.2  # share of the beams of a match that err independently
LEAST = np.array([0.005, 0.005, 0.005]) ** 2  # variances of any movement [m^2, m^2, rad^2]
OPEN = 0.1  # [m] of standard deviation of the place, at most, that is left open: as far off a match finds it
DRIFT = np.diag([0.0003, 0.0003, 0.0002]) ** 2  # variances by which the map drifts with each scan [m^2, m^2, rad^2]: as
#                                                 measured on the first 24 m of drives around an office
GOOD = 0.75  # a fit below which the scan may fit better elsewhere: wheels slip, and a robot may be pushed ...
CAUGHT = 0.1  # [m], [rad] off, a match finds where a scan fits: after a movement that may err by more, too ...
SLIP, TWIST, STARTS = 0.3, 0.4, 3  # ... by so much at least [m], [rad]; and from how many poses a match begins there
MOST = 0.6  # [m], [rad] that is looked for around a scan that does not fit, however far the robot went
SLIPPED = np.diag([0.1, 0.1, 0.05]) ** 2  # covariance of these
EVIDENCE, RARE = 40.0, 16.0  # how much a quality of 1 counts, in units of a squared error of the odometry, and the
#                              largest such error that counts: in a corridor all places fit alike, but wheels do slip
SOON = 0.1  # weight of a scan in the share of those that surprise


class Tracker:
    """Matches each scan with the map near where the odometry has the robot.

    Attributes:
        drift: covariance (3, 3) of the way since it was set to 0.
        way: length of that [m].
        surprise: share of the newest scans that fit only where the odometry could hardly have the robot [0..1].
    """

    def __init__(self, config: MapperConfig, noise: Noise) -> None:
        """Know how wheels err, and how a laser."""
        self._config, self._noise = config, noise
        self._open = np.zeros((3, 3))  # covariance of the errors of the odometry that scans left open
        self.drift, self.way = np.zeros((3, 3)), 0.0
        self.surprise = 0.0

    def follow(self, grid: Grid, supposed: Pose, last: Pose, odometry: Pose, scan: Scan) -> Estimate:
        """Where a scan fits; keeps account of the errors of the odometry since the last one.

        Along a bare corridor errors of earlier movements are still open, and are corrected together.

        Args:
            grid: the map.
            supposed: where the robot would be if the odometry did not err, map frame.
            last, odometry: pose by odometry at the scan before, and now.
            scan: what the laser told.
        """
        movement = self._spread(last, odometry)
        estimate, movement = self._matched(grid, supposed, movement, scan)
        left = _share_left(estimate.covariance, self._open + movement)
        self._open = _bounded(left @ (self._open + movement) @ left.T)
        self.drift = self.drift + left @ movement @ left.T + DRIFT
        self.way += math.hypot(odometry.x - last.x, odometry.y - last.y)
        return estimate

    def begin_way(self, way: float = 0.0) -> None:
        """Begin to count way and drift, the way from a length [m]: infinite if the robot may have been carried away."""
        self.drift, self.way = np.zeros((3, 3)), way

    def _matched(self, grid: Grid, supposed: Pose, movement: Array, scan: Scan) -> Tuple[Estimate, Array]:
        """Where a scan fits, near where the odometry has the robot or farther away, and the covariance of that."""
        prior, ends = self._open + movement, scan.points
        if is_blind(ends):
            return Estimate(supposed, prior, 0.0, True), movement
        best = self._match(grid, supposed, prior, scan)
        reach, turn = 3.0 * math.sqrt(max(prior[0, 0], prior[1, 1])), 3.0 * math.sqrt(prior[2, 2])
        if best.fit >= GOOD and max(reach, turn) < CAUGHT:
            self.surprise -= SOON * self.surprise
            return best, movement
        held, place = inverted(prior), np.array(supposed)

        def error(estimate: Estimate) -> float:
            off = np.array(estimate.pose) - place
            off[2] = wrap_angle(float(off[2]))
            return min(float(off @ held @ off), RARE)

        def evidence(estimate: Estimate) -> float:
            quality = estimate.fit - WRONG * grid.share_wrong(estimate.pose, scan, self._noise)
            return EVIDENCE * quality - error(estimate)

        starts = best_around(grid, supposed, min(max(reach, SLIP), MOST), min(max(turn, TWIST), MOST), ends, STARTS)
        other = max((self._match(grid, start, SLIPPED, scan) for start in starts), key=evidence)
        is_better = evidence(other) > evidence(best)
        self.surprise += SOON * ((is_better and error(other) >= RARE) - self.surprise)
        return (other, SLIPPED) if is_better else (best, movement)

    def _match(self, grid: Grid, start: Pose, prior: Array, scan: Scan) -> Estimate:
        """Where a scan fits near a pose, which has a covariance (3, 3)."""
        few = thinned(scan.points, MATCHED)
        found = grid.matched(start, prior, few, self._noise.kernels(few, scan.laser), self._noise.steps, INDEPENDENT)
        return Estimate(*found, True)

    def _spread(self, last: Pose, odometry: Pose) -> Array:
        """Covariance of a movement (3, 3): Probabilistic Robotics (Thrun, Burgard, Fox 2005), table 5.6."""
        config = self._config
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
