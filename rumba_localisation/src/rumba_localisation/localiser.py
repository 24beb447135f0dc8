"""Monte Carlo localisation: where a robot is, by its odometry and its laser, on a map."""

import math
from typing import NamedTuple, Optional, Sequence, Union

import numpy as np

from rumba_localisation import compiled_matching, motion, particles
from rumba_localisation.localiser_config import LocaliserConfig
from rumba_localisation.scan import is_blind, thinned
from rumba_localisation.search import WRONG, Search
from rumba_localisation.walls import Walls
from rumba_sim.model.floor_plan import FloorPlan
from rumba_sim.model.geometry import Pose, compose, inverse, wrap_angle
from rumba_sim.model.kernel import Array

Seed = Union[int, Sequence[int]]
STEPS = np.geomspace(0.15, 0.03, 6)  # [m] sigmas of `match`
MATCHED = 180  # beams, at most, by which the pose is refined
SURE = 0.9  # share of the weight in one cluster from which on the robot knows where it is
NARROW = 0.3  # [m], [rad] standard deviations in that cluster, at most
FITS = 0.25  # share of beams that end at a wall, at least: what the map does not show may hide most of it
DOUBT = 0.1  # the share by which scans fit worse than in the long run, from which on particles are drawn from the scan
SOME = 20  # beams, by which particles are looked at that may be in the wrong place
PLAUSIBLE = 0.75  # of how well scans went with the estimates before, at least
LITTLE, RARELY = 0.005, 20  # [m], [rad] of movement after which one scan in so many is used: wheels may slip in place
GOOD, STARTS = 0.85, 8  # a fit below which a match begins also at so many of the heaviest particles
WORSE, SOON = 0.8, 0.1  # times the average fit, below which the wheels may have slipped; weight of each scan in it
SLIPS = np.linspace(-0.4, 0.4, 5)  # [rad] by which they may have turned the robot ...
SLIPPED = np.diag([0.1, 0.1, 0.1]) ** 2  # ... with such variances [m^2, m^2, rad^2]
HELD = np.diag([0.02, 0.02, 0.02]) ** 2  # least variances of the prior of a match [m^2, m^2, rad^2]
INDEPENDENT = 0.2  # share of the beams of a match that err independently: the map errs with its neighbours alike
START = np.diag([0.25, 0.25, math.radians(15.0) ** 2])  # covariance of a start that is told, as amcl's


class Estimate(NamedTuple):
    """Where the robot believes it is."""

    pose: Pose  # [m, rad] map frame
    covariance: Array  # float64 (3, 3) of x, y, heading; that of a start at least if the robot is not sure
    fit: float  # [0..1] share of the beams of the newest scan that end at a wall of the map
    is_sure: bool  # whether it knows its place: one hypothesis, narrow, to which the scans fit


class Match(NamedTuple):
    """Where a scan fits."""

    pose: Array  # float64 (3) [m, m, rad]
    covariance: Array  # float64 (3, 3)
    fit: float  # [0..1]


class Localiser:
    """Particles that follow the odometry and are weighed by scans; their heaviest cluster is matched with the walls.

    The laser is in the centre of the robot and looks forward, as a Rumba's.

    Attributes:
        config: parameters.
        correction: pose of the frame of the odometry in the map frame.
        estimate: where the robot was at the newest scan that was used; None before the first.
        particles: float64 (any, 3), poses of the particles [m, m, rad].
    """

    def __init__(self, plan: FloorPlan, radius: float, range_max: float, config: LocaliserConfig = LocaliserConfig(),
                 seed: Seed = 0) -> None:
        """Know a map, and nothing of where the robot is.

        Args:
            plan: the map.
            radius: of the robot [m].
            range_max: of its laser [m].
            config: parameters.
            seed: of the random generator.
        """
        self.config = config
        self._walls = Walls(plan)
        self._field = self._walls.log_likelihood(config.laser_sigma_hit, config.laser_z_hit, config.laser_z_rand,
                                                 range_max)
        self._search = Search(plan, self._walls, radius, range_max)
        self._generator = np.random.default_rng(seed)
        self.correction = Pose(0.0, 0.0, 0.0)
        self.estimate: Optional[Estimate] = None
        self.search_anywhere()

    def start_at(self, pose: Pose, covariance: Array = START) -> None:
        """Believe what a person, or the dock, tells of the place.

        Args:
            pose: [m, rad], map frame.
            covariance: float64 (3, 3) of x, y and heading.
        """
        count = self.config.max_particles
        self.particles = self._generator.multivariate_normal(pose, covariance, count, method='eigh')
        self._begin()

    def search_anywhere(self) -> None:
        """Begin at the next scan with every place on the map to which it fits."""
        self.particles = np.empty((0, 3))
        self._begin()

    def _begin(self) -> None:
        self._logarithms = np.zeros(len(self.particles))
        self._last: Optional[Pose] = None  # odometry at the newest scan that was used
        self._unused = 0  # scans since then
        self._slow = self._fast = 0.0  # averages of how well scans fit
        self._fit = 0.0  # average share of beams that end at a wall
        self._is_in_doubt = True

    # --- scans ----------------------------------------------------------------------------------------------------

    def pose(self, odometry: Pose) -> Pose:
        """Where the robot is, from its odometry, by the newest correction."""
        return compose(self.correction, odometry)

    def observe(self, odometry: Pose, points: Array, is_forced: bool = False) -> bool:
        """Take a scan into account, if the robot has moved enough since the last one.

        Args:
            odometry: pose by odometry when the scan was taken.
            points: float64 (beams, 2), where the beams that have an echo end, in the frame of the robot [m]; without
                echoes the particles follow the odometry alone.
            is_forced: use it even if the robot has not moved.

        Returns:
            Whether it was used: there is a new estimate and a new correction.
        """
        self._unused += 1
        config = self.config
        if not (is_forced or self._has_moved(odometry, config.update_min_d, config.update_min_a)
                or self._unused >= RARELY and self._has_moved(odometry, LITTLE, LITTLE)):
            return False
        self._unused = 0
        if self._last is not None:
            self.particles = motion.moved(self.particles, self._last, odometry, self.config, self._generator)
        elif is_blind(points):
            return False
        self._last = odometry
        if not is_blind(points):
            self._weigh(points)
        self.estimate = self._estimated(points)
        self.correction = compose(self.estimate.pose, inverse(odometry))
        return True

    def _has_moved(self, odometry: Pose, distance: float, turn: float) -> bool:
        """Whether the robot has moved by a distance [m], or a turn [rad], since the newest scan that was used."""
        last = self._last
        return last is None or (math.hypot(odometry.x - last.x, odometry.y - last.y) >= distance
                                or abs(wrap_angle(odometry.theta - last.theta)) >= turn)

    def _weigh(self, points: Array) -> None:
        """Weigh the particles, and draw new ones if few of them carry most of the weight."""
        config = self.config
        if not len(self.particles):
            self.particles = self._found(points, config.max_particles)
            self._logarithms = np.zeros(len(self.particles))
        sums = self._likelihoods(points)
        self._logarithms += sums
        share = particles.weights(self._logarithms)
        fresh = 1.0 - self._fast / self._slow if self._slow > 0.0 else 0.0
        if particles.effective(share) < 0.5 * len(share) or fresh > DOUBT:
            self._draw(share, fresh if fresh > DOUBT else 0.0, points)

    def _plausibility(self, match: Match, points: Array) -> float:
        """How well a scan goes with a match [0..1], whatever stands before the walls unless it hides most."""
        through = self._walls.through(match.pose, thinned(points, self.config.laser_max_beams))
        return min(max(1.0 - WRONG * through, 0.0), match.fit / FITS)

    def _follow_fit(self, fit: float) -> None:
        """Update the averages of how well scans fit."""
        config = self.config
        self._slow += (config.recovery_alpha_slow if self._slow > 0.0 else 1.0) * (fit - self._slow)
        self._fast += (config.recovery_alpha_fast if self._fast > 0.0 else 1.0) * (fit - self._fast)

    def _draw(self, share: Array, fresh: float, points: Array) -> None:
        """Draw particles by their weight, and a part of them from the scan if it fits worse than others did before."""
        self.particles = particles.drawn(self.particles, share, self.config, self._generator)
        self._logarithms = np.zeros(len(self.particles))
        count = int(fresh * len(self.particles))
        if count:
            self.particles[:count] = self._found(points, count)
            self._logarithms = self._likelihoods(points)

    def _found(self, points: Array, count: int) -> Array:
        """Particles at the places to which a scan fits, more where it fits better."""
        poses, fits = self._search.hypotheses(points, self._generator)
        chosen = poses[self._generator.choice(len(poses), count, p=particles.weights(fits / 0.05))]
        return chosen + self._generator.standard_normal((count, 3)) * 0.03

    def _likelihoods(self, points: Array) -> Array:
        """Logarithms of how likely a scan is at the particles: float64, at most 0.

        Only a robot that may be in the wrong place looks at what its beams pass through, which takes long.
        """
        few = thinned(points, self.config.laser_max_beams)
        sums = np.empty(len(self.particles))
        compiled_matching.weigh(self.particles, few, self._field, *self._walls.origin, self._walls.resolution, sums)
        if self._is_in_doubt:
            few = thinned(points, SOME)
            sums -= WRONG * self.config.laser_max_beams * np.array(
                [self._walls.through(pose, few) for pose in self.particles])
        return sums * self.config.laser_independence

    def _estimated(self, points: Array) -> Estimate:
        """The heaviest cluster, moved to where the scan fits best; the particles follow, or they would lag behind.

        While the laser sees nothing the cluster stays where the odometry has it, and spreads on the way.
        """
        share = particles.weights(self._logarithms)
        cluster = particles.heaviest(self.particles, share)
        match = self._best_match(cluster, share, points)
        deviations = np.sqrt(np.diag(cluster.covariance))
        is_sure = cluster.share >= SURE and float(deviations.max()) < NARROW
        if not is_blind(points):
            plausibility = self._plausibility(match, points)
            is_sure = is_sure and match.fit >= FITS and plausibility >= PLAUSIBLE * max(self._slow, self._fast)
            self._is_in_doubt = not is_sure or plausibility < 1.0 - DOUBT
            self._follow_fit(plausibility)
            self._fit += SOON * (match.fit - self._fit)
        if is_sure:
            x, y, turn = (match.pose - cluster.mean).tolist()
            self.particles += (x, y, wrap_angle(turn))
        x, y, theta = match.pose.tolist()
        covariance = match.covariance if is_sure else START + particles.mean_and_covariance(self.particles, share)[1]
        return Estimate(Pose(x, y, wrap_angle(theta)), covariance, match.fit, is_sure)

    def _best_match(self, cluster: particles.Cluster, share: Array, points: Array) -> Match:
        """Where a scan fits near a cluster; the cluster itself if there is no scan."""
        if is_blind(points):
            return Match(cluster.mean, cluster.covariance, 0.0)
        match = self._matched(cluster, cluster.mean, points)
        starts = []
        if match.fit < GOOD:  # perhaps the far side of a thin wall: it may fit better from elsewhere in the cluster
            starts += list(self.particles[np.argsort(-share, kind='stable')[:STARTS]])
        if match.fit < WORSE * self._fit:  # perhaps the wheels slipped
            starts += [cluster.mean + (0.0, 0.0, turn) for turn in SLIPS]
            cluster = cluster._replace(covariance=cluster.covariance + SLIPPED)
        few = thinned(points, self.config.laser_max_beams)
        return max([match, *(self._matched(cluster, start, points) for start in starts)],
                   key=lambda each: each.fit - WRONG * self._walls.through(each.pose, few)) if starts else match

    def _matched(self, cluster: particles.Cluster, start: Array, points: Array) -> Match:
        pose, covariance = np.empty(3), np.empty((3, 3))
        fit = compiled_matching.match(start, cluster.covariance + HELD, thinned(points, MATCHED),
                                      self._walls.distance, *self._walls.origin, self._walls.resolution, STEPS,
                                      INDEPENDENT, pose, covariance)
        return Match(pose, covariance, fit)
