"""Where a robot in process believes to be: by the truth, by its odometry alone, or by a localisation."""

from typing import Any, Callable, Dict, NamedTuple, Optional, Tuple

import numpy as np

from rumba_cleaning.behaviour import CERTAIN, UNKNOWN, Covariance
from rumba_cleaning.survey import Survey
from rumba_localisation.localiser import Localiser, Seed
from rumba_localisation.mapping.findings import Findings
from rumba_localisation.mapping.mapper import Mapper
from rumba_localisation.scan import Reading, Scan, scan_of
from rumba_sim.model.common.geometry import Pose, as_told, compose, inverse
from rumba_sim.model.devices.laser_scan import laser_scan
from rumba_sim.model.kernel import Array
from rumba_sim.model.maps.floor_plan import FloorPlan
from rumba_sim.model.settings.laser_config import IDEAL, LaserConfig
from rumba_sim.model.simulation.world import World


class Belief(NamedTuple):
    """A pose in the map frame, and how certain it is."""

    pose: Pose
    covariance: Covariance = CERTAIN
    scan: Optional[Scan] = None  # by which it was found
    silence: float = 0.0  # [s] since the newest scan by which it was found, if a scan is due


PoseSource = Callable[[World, str], Belief]  # called once for each observation of a robot, by its name


def truth(world: World, name: str) -> Belief:
    """The true pose, as the simulator tells it by way of two transforms, bit for bit."""
    robot = world.robots[name]
    odometry = robot.odometry
    return Belief(_told(compose(robot.pose, inverse(odometry)), odometry))


class DeadReckoning:
    """A robot that knows where it began, and counts the turns of its wheels since then."""

    def __init__(self) -> None:
        """Begin with the first observation."""
        self._corrections: Dict[str, Pose] = {}

    def __call__(self, world: World, name: str) -> Belief:
        """Where the robot believes to be, as certain as if it were true."""
        robot = world.robots[name]
        start = self._corrections.setdefault(name, compose(robot.pose, inverse(robot.odometry)))
        return Belief(_told(start, robot.odometry))


def reckoned(world: World, name: str) -> Belief:
    """What the odometry tells, in a frame of its own that has nothing to do with the map."""
    return Belief(as_told(world.robots[name].odometry))


class Localised:
    """A robot that localises itself by its laser, as the node `localiser` does, bit for bit.

    Attributes:
        localiser: what it believes.
        scans: what the laser of a robot tells, by its world and its name; None while it is silent.
    """

    def __init__(self, plan: FloorPlan, world: World, name: str, seed: Seed = 0) -> None:
        """Have a robot of a world know a map, and where it stands now."""
        config = world.config
        self.scans: Callable[[World, str], Optional[Scan]] = due_scan
        self._scanned = world.time  # [s] of the newest scan
        self.localiser = Localiser(plan, config.drive.radius, config.laser.range_max, seed=seed)
        self.localiser.start_at(world.robots[name].pose)

    def __call__(self, world: World, name: str) -> Belief:
        """Scan, and see where that fits."""
        odometry = as_told(world.robots[name].odometry)
        scan = self.scans(world, name)
        if scan is not None or world.is_scan_due:  # else the laser is still turning
            self.localiser.observe(odometry, scan)
        if scan is not None:
            self._scanned = world.time
        estimate = self.localiser.estimate
        pose = compose(as_told(self.localiser.correction), odometry)
        return Belief(pose, UNKNOWN if estimate is None else _rows(estimate.covariance), scan,
                      world.time - self._scanned)


class Mapped(Survey):
    """A robot that makes a map by its laser, as the node `mapper` does, from the place where it is at first.

    Attributes:
        mapper: the map, and what it believes.
        findings: what bumper and cliff sensors found.
    """

    def __init__(self, world: World, name: str, dock: Optional[Pose] = None) -> None:
        """Begin with a first scan of a robot of a world; its true pose defines the map frame, in which the dock is."""
        config = world.config
        self.mapper = Mapper(world.robots[name].pose)
        self.findings = Findings(config)
        self._dock = dock
        self._known: Optional[Tuple[int, FloorPlan]] = None  # the newest plan, after its version
        self._frames: Tuple[int, Array] = 0, np.empty((0, 3))  # key frames, after how often the map was redrawn
        self._take(world, name, scan_of_robot(world, name))

    def __call__(self, world: World, name: str) -> Belief:
        """Scan, and see where that fits on the map."""
        return self._take(world, name, due_scan(world, name))

    def _take(self, world: World, name: str, scan: Optional[Scan]) -> Belief:
        odometry = as_told(world.robots[name].odometry)
        redrawn = self.mapper.redrawn
        if scan is not None:
            self.mapper.observe(odometry, scan)
        if self.mapper.redrawn > redrawn:
            self.findings.move(self.mapper.moved)
        estimate, pose = self.mapper.estimate, self.mapper.pose(odometry)
        self.findings.note(self.mapper.grid, pose, world.robots[name].bumper, world.cliffs(name))
        return Belief(pose, UNKNOWN if estimate is None else _rows(estimate.covariance), scan)

    def plan(self) -> FloorPlan:
        """The map so far, with the dock."""
        version = self.mapper.version + self.findings.version
        if self._known is None or self._known[0] != version:
            self._known = version, self.mapper.plan('the map so far', self._dock, self.findings)
        return self._known[1]

    def frames(self) -> Array:
        """The poses of the key frames of the mapper: unless the map was redrawn, only new ones have to be added."""
        poses, (redrawn, known) = self.mapper.frames, self._frames
        if redrawn != self.mapper.redrawn:
            known = known[:0]
        if len(known) < len(poses):
            self._frames = self.mapper.redrawn, np.concatenate([known, np.array(poses[len(known):])])
        return self._frames[1]


def seeing(source: PoseSource) -> PoseSource:
    """The same belief, with each scan of the laser."""
    def believe(world: World, name: str) -> Belief:
        belief = source(world, name)
        return belief if belief.scan is not None else belief._replace(scan=due_scan(world, name))
    return believe


def due_scan(world: World, name: str) -> Optional[Scan]:
    """What the laser of a robot of a world tells now; None if it tells nothing at this tick, since it turns slowly."""
    return scan_of_robot(world, name) if world.is_scan_due else None


def scan_of_robot(world: World, name: str) -> Scan:
    """What the laser of a robot of a world tells, as by a sensor_msgs/LaserScan and by tf."""
    told = laser_scan(world, name)
    return scan_of(told.ranges, told.angle_min, told.angle_increment, told.range_max, told.range_min,
                   told.mounting, Reading(usable=usable_range(world.config.laser)))


def usable_range(laser: LaserConfig) -> float:
    """How far beams without an echo are free [m]: as far as the laser sees if it misses none, else 0."""
    return laser.range_max if laser.model == IDEAL else 0.0


def _told(correction: Pose, odometry: Pose) -> Pose:
    return compose(as_told(correction), as_told(odometry))


def _rows(covariance: Any) -> Covariance:
    (xx, xy, xt), (yx, yy, yt), (tx, ty, tt) = covariance.tolist()
    return (xx, xy, xt), (yx, yy, yt), (tx, ty, tt)
