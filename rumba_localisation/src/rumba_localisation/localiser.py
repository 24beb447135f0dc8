"""Monte Carlo localisation: where a robot is, by its odometry and its laser, on a map."""

import math
from typing import NamedTuple, Optional, Sequence, Union

import numpy as np

from rumba_localisation import compiled_matching, motion, particles
from rumba_localisation.localiser_config import LocaliserConfig
from rumba_localisation.matcher import DOUBT, FITS, Matcher
from rumba_localisation.scan import Scan, is_blind, thinned
from rumba_localisation.search import NEAR, WRONG, Search
from rumba_localisation.systematic import Systematic
from rumba_localisation.walls import Walls
from rumba_sim.model.common.geometry import Pose, compose, inverse, wrap_angle
from rumba_sim.model.kernel import Array
from rumba_sim.model.maps.floor_plan import FloorPlan

Seed = Union[int, Sequence[int]]
SURE = 0.9  # share of the weight in one cluster from which on the robot knows where it is
NARROW = 0.3  # [m], [rad] standard deviations in that cluster, at most
SPREAD = 0.03  # [m], [rad] standard deviations of particles that are drawn where a scan fits
SOME = 20  # beams, by which particles are looked at that may be in the wrong place
PLAUSIBLE = 0.75  # of how well scans went with the estimates before, at least
LITTLE, RARELY = 0.005, 20  # [m], [rad] of movement after which one scan in so many is used: wheels may slip in place
STILL = 0.001  # [m], [rad] that the wheels of a robot that stands turn from scan to scan: it may slide all the same
START = np.diag([0.25, 0.25, math.radians(15.0) ** 2])  # covariance of a start that is told, as amcl's


class Estimate(NamedTuple):
    """Where the robot believes it is."""

    pose: Pose  # [m, rad] map frame
    covariance: Array  # float64 (3, 3) of x, y, heading; that of a start at least if scans do not make it sure
    fit: float  # [0..1] share of the beams of the newest scan that end at a wall of the map
    is_sure: bool  # whether it knows its place: one hypothesis, narrow, to which the scans fit


class Localiser:
    """Particles that follow the odometry and are weighed by scans; their heaviest cluster is matched with the walls.

    Attributes:
        config: parameters.
        correction: pose of the frame of the odometry in the map frame.
        estimate: where the robot was at the newest scan that was used; None before the first.
        particles: float64 (any, 3), poses of the particles [m, m, rad].
        systematic: what all ranges of the laser have in common; scans are matched without it.
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
        self._matcher = Matcher(self._walls, self._search, config)
        self._generator = np.random.default_rng(seed)
        self.systematic = Systematic()
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
        # As Generator.multivariate_normal does with method='eigh', which NumPy before 1.18 lacks.
        squares, axes = np.linalg.eigh(covariance)
        spread = axes * np.sqrt(np.maximum(squares, 0.0))
        self.particles = pose + self._generator.standard_normal((count, 3)) @ spread.T
        self._begin()

    def search_anywhere(self) -> None:
        """Begin at the next scan with every place on the map to which it fits."""
        self.particles = np.empty((0, 3))
        self._begin()

    def _begin(self) -> None:
        self._logarithms = np.zeros(len(self.particles))
        self._last: Optional[Pose] = None  # odometry at the newest scan that was used
        self._unused = 0  # scans since then
        self._seen: Optional[Pose] = None  # odometry at the newest scan, even if it was not used
        self._errors: Optional[Array] = None  # of the odometry of each particle, while no scan tells how it errs
        self._was_sure = False  # of its place when that began
        self._good: Optional[Pose] = None  # newest correction of which it was sure
        self._is_in_doubt = True
        self._matcher.begin()

    # --- scans ----------------------------------------------------------------------------------------------------

    def pose(self, odometry: Pose) -> Pose:
        """Where the robot is, from its odometry, by the newest correction."""
        return compose(self.correction, odometry)

    def observe(self, odometry: Pose, scan: Optional[Scan], is_forced: bool = False) -> bool:
        """Take a scan into account, if the robot has moved enough since the last one.

        Args:
            odometry: pose by odometry when the scan was taken.
            scan: what the laser told. Without echoes the particles follow the odometry alone; the same if it is None:
                the laser is silent.
            is_forced: use it even if the robot has not moved.

        Returns:
            Whether it was used: there is a new estimate, and a new correction if there are echoes.
        """
        if scan is None or is_blind(scan.points):
            return self._reckon(odometry)
        self._unused += 1
        told, scan = scan, self.systematic.corrected(scan)
        if not (is_forced or self._errors is not None or self._is_due(odometry, scan.points)):
            return False
        self.systematic.follow(told)
        self._unused, self._errors = 0, None
        if self._last is not None:
            self._move(odometry, motion.noise(len(self.particles), self._generator))
        self._last = odometry
        self._weigh(scan)
        self.estimate = self._estimated(odometry, scan)
        self.correction = compose(self.estimate.pose, inverse(odometry))
        if self.estimate.is_sure:
            self._good = self.correction
        return True

    def _reckon(self, odometry: Pose) -> bool:
        """Follow the odometry alone, with one error for each particle: until a scan comes, wheels err in one way."""
        config, known = self.config, self.estimate
        if known is None or self._last is None or not self._has_moved(odometry, config.update_min_d,
                                                                      config.update_min_a):
            return False
        if self._errors is None:
            self._errors, self._was_sure = motion.noise(len(self.particles), self._generator), known.is_sure
        self._move(odometry, self._errors)
        self._last = odometry
        covariance = particles.mean_and_covariance(self.particles, particles.weights(self._logarithms))[1]
        is_sure = self._was_sure and float(np.sqrt(np.diag(covariance)).max()) < NARROW
        self.estimate = Estimate(self.pose(odometry), covariance if self._was_sure else START + covariance, known.fit,
                                 is_sure)
        return True

    def _move(self, odometry: Pose, errors: Array) -> None:
        assert self._last is not None
        self.particles = motion.moved(self.particles, self._last, odometry, self.config, errors)

    def _is_due(self, odometry: Pose, points: Array) -> bool:
        """Whether a scan is to be used: the robot has moved enough, or slides although its wheels stand still."""
        config, seen = self.config, self._seen
        self._seen = odometry
        if self._has_moved(odometry, config.update_min_d, config.update_min_a):
            return True
        if self._unused >= RARELY and self._has_moved(odometry, LITTLE, LITTLE):
            return True
        return seen is not None and max(abs(now - then) for now, then in zip(odometry, seen)) < STILL and (
            self._matcher.is_surprising(np.array(self.pose(odometry)), points))

    def _has_moved(self, odometry: Pose, distance: float, turn: float) -> bool:
        """Whether the robot has moved by a distance [m], or a turn [rad], since the newest scan that was used."""
        last = self._last
        return last is None or (math.hypot(odometry.x - last.x, odometry.y - last.y) >= distance
                                or abs(wrap_angle(odometry.theta - last.theta)) >= turn)

    def _weigh(self, scan: Scan) -> None:
        """Weigh the particles, and draw new ones if few of them carry most of the weight."""
        config = self.config
        if not len(self.particles):
            self.particles = self._found(scan, config.max_particles)
            self._logarithms = np.zeros(len(self.particles))
        sums = self._likelihoods(scan)
        self._logarithms += sums
        share = particles.weights(self._logarithms)
        fresh = self._matcher.decline
        if particles.effective(share) < 0.5 * len(share) or fresh > DOUBT:
            self._draw(share, fresh if fresh > DOUBT else 0.0, scan)

    def _draw(self, share: Array, fresh: float, scan: Scan) -> None:
        """Draw particles by their weight, and a part of them from the scan if it fits worse than others did before."""
        self.particles = particles.drawn(self.particles, share, self.config, self._generator)
        self._logarithms = np.zeros(len(self.particles))
        count = int(fresh * len(self.particles))
        if count:
            self.particles[:count] = self._found(scan, count)
            self._logarithms = self._likelihoods(scan)

    def _found(self, scan: Scan, count: int) -> Array:
        """Particles at the places to which a scan fits, more where it fits better."""
        poses, fits = self._search.hypotheses(scan, self._generator)
        chosen = poses[self._generator.choice(len(poses), count, p=particles.weights(fits / 0.05))]
        return chosen + self._generator.standard_normal((count, 3)) * SPREAD

    def _likelihoods(self, scan: Scan) -> Array:
        """Logarithms of how likely a scan is at the particles: float64, at most 0.

        Only a robot that may be in the wrong place looks at what its beams pass through, which takes long.
        """
        few = thinned(scan.points, self.config.laser_max_beams)
        sums = np.empty(len(self.particles))
        compiled_matching.weigh(self.particles, few, self._field, *self._walls.origin, self._walls.resolution, sums)
        if self._is_in_doubt:
            few = thinned(scan.points, SOME)
            sums -= WRONG * self.config.laser_max_beams * np.array(
                [self._walls.through(pose, few, scan.laser) for pose in self.particles])
        return sums * self.config.laser_independence

    def _estimated(self, odometry: Pose, scan: Scan) -> Estimate:
        """The heaviest cluster, moved to where the scan fits best; the particles follow, or they would lag behind."""
        matcher = self._matcher
        share = particles.weights(self._logarithms)
        cluster = particles.heaviest(self.particles, share)
        match = matcher.best(cluster, self.particles, share, scan)
        near = None if self._good is None else compose(self._good, odometry)
        if near is not None and not matcher.is_good(match):
            slipped = matcher.slipped(near, scan)
            if slipped is not None:
                match, cluster = slipped, self._gather(slipped.pose)
                share = particles.weights(self._logarithms)
        is_near = near is None or math.hypot(match.pose[0] - near.x, match.pose[1] - near.y) <= NEAR
        is_narrow = cluster.share >= SURE and float(np.sqrt(np.diag(cluster.covariance)).max()) < NARROW
        is_sure = (is_narrow and match.fit >= FITS and match.plausibility >= PLAUSIBLE * matcher.usual
                   and (is_near or matcher.is_good(match)))
        self._is_in_doubt = not is_sure or match.plausibility < 1.0 - DOUBT
        matcher.follow(match, is_sure)
        if is_sure:
            x, y, turn = (match.pose - cluster.mean).tolist()
            self.particles += (x, y, wrap_angle(turn))
        x, y, theta = match.pose.tolist()
        covariance = match.covariance if is_sure else START + particles.mean_and_covariance(self.particles, share)[1]
        return Estimate(Pose(x, y, wrap_angle(theta)), covariance, match.fit, is_sure)

    def _gather(self, pose: Array) -> particles.Cluster:
        """Have all particles at a pose (3), since the robot slipped there; returns their cluster."""
        count = self.config.min_particles
        self.particles = pose + self._generator.standard_normal((count, 3)) * SPREAD
        self._logarithms = np.zeros(count)
        return particles.heaviest(self.particles, particles.weights(self._logarithms))
