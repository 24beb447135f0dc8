"""What the window shows at one moment, as plain values: no ROS, no Qt."""

import dataclasses
import math
from typing import Any, FrozenSet, NamedTuple, Optional, Tuple

from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.settings.robot_config import BrushConfig, DriveConfig

Array = Any  # numpy.ndarray
YIELDING, GOING_TO = 'yielding', 'going to'  # states of a mission


class Point(NamedTuple):
    """A point of the map [m]."""

    x: float
    y: float


class Box(NamedTuple):
    """A rectangle along the axes of the map [m]."""

    left: float
    bottom: float
    right: float
    top: float


@dataclasses.dataclass(frozen=True, eq=False)
class Grid:
    """Values on the cells of a map.

    Attributes:
        cells: int8 (rows, columns); row 0 lies at the lowest y.
        resolution: side of a cell [m].
        left, bottom: the lower left corner of cell (0, 0) [m].
        number: changes with the content; painters keep a finished picture as long as it stays the same.
    """

    cells: Array
    resolution: float
    left: float
    bottom: float
    number: int

    @property
    def box(self) -> Box:
        """The rectangle that it covers."""
        rows, columns = self.cells.shape
        return Box(self.left, self.bottom, self.left + columns * self.resolution,
                   self.bottom + rows * self.resolution)


@dataclasses.dataclass(frozen=True, eq=False)
class Dock:
    """A dock, and how far its infrared beams reach.

    Attributes:
        pose: of a robot that is docked and faces the dock.
        halo: corners (n, 2) [m] of the area in which its force field is received.
        field: corners (n, 2) [m] of the area in which its buoys are received.
    """

    pose: Pose
    halo: Array
    field: Array


@dataclasses.dataclass(frozen=True, eq=False)
class MapFeatures:
    """What the files of a map contain besides the cells of /map.

    Attributes:
        docks: none if the map has none, or if its files cannot be read on this machine.
        carpet, cliff: bool (rows, columns), a value for each cell of the map; None if the map has none.
        is_known: whether the files were read.
    """

    docks: Tuple[Dock, ...] = ()
    carpet: Optional[Array] = None
    cliff: Optional[Array] = None
    is_known: bool = False


@dataclasses.dataclass(frozen=True, eq=False)
class Path:
    """The path that a robot drove.

    Attributes:
        points: (n, 2) [m]; a row of NaN separates two parts that are not connected.
        number: as long as it stays the same, points are only added.
    """

    points: Array
    number: int


class Obstacle(NamedTuple):
    """Something that the map does not show.

    Attributes:
        pose: of its centre.
        length, width: along and across its heading [m].
        is_round: whether it is a disc, or a box.
        is_low: whether the laser passes over it.
    """

    pose: Pose
    length: float
    width: float
    is_round: bool
    is_low: bool


class Battery(NamedTuple):
    """Charge 0..1, [V], [A] (negative while discharging), and `charging`, `full` or `on battery`; NaN: unknown."""

    share: float
    voltage: float
    current: float
    state: str


class Cleaning(NamedTuple):
    """How much of the floor is swept: shares 0..1, areas [m^2], distance driven [m], when [s]; NaN: unknown."""

    coverage: float
    cleaned_area: float
    reachable_area: float
    dirt: float
    distance: float
    time: float = math.nan


class Mission(NamedTuple):
    """What the cleaner makes a robot do.

    Attributes:
        state: in a few words, such as `cleaning`; YIELDING while a person drives the robot.
        is_active: whether there is a goal.
        strategy: name of the cleaning strategy in use; empty if the goal is not a cleaning.
        message: one line for a person.
    """

    state: str
    is_active: bool
    strategy: str
    message: str

    @property
    def is_cleaning(self) -> bool:
        """Whether the goal is a cleaning, in whatever state: it may also return, charge, or yield."""
        return self.is_active and bool(self.strategy)


class Size(NamedTuple):
    """Radius of a robot and width of its brush [m]."""

    radius: float = DriveConfig.radius
    brush: float = BrushConfig.width


@dataclasses.dataclass(frozen=True, eq=False)
class Robot:
    """One robot; a value that was not received yet is None.

    Attributes:
        name: its topics are below this name.
        bumper: left and right switch.
        has_fallen: whether a wheel hangs over a cliff, so that it cannot drive.
        message: the debug message of battery_status, for a person.
        beams: ends (n, 2) of the laser's beams [m]; None while they are not shown.
        believed: where its localisation believes it to be; None if none tells.
        particles: positions (n, 2) where that holds it possible to be [m]; None likewise.
        planned: corners (n, 2) of the path that its cleaner follows [m]; None if none tells.
        going_to: where its cleaner brings it at the moment; None if to no point.
        elapsed, left: how long its mission takes already, and probably still [s]; None: unknown, or it has none.
        report: lines about its last cleaning, since that ended.
        has_cleaner: whether a cleaner takes goals for it.
        can_resume: whether its cleaner has an interrupted cleaning to resume; None: unknown.
    """

    name: str
    pose: Pose
    size: Size = Size()
    bumper: Tuple[bool, bool] = (False, False)
    has_fallen: bool = False
    brushes_up: Optional[bool] = None
    message: str = ''
    battery: Optional[Battery] = None
    cleaning: Optional[Cleaning] = None
    mission: Optional[Mission] = None
    path: Optional[Path] = None
    beams: Optional[Array] = None
    believed: Optional[Pose] = None
    particles: Optional[Array] = None
    planned: Optional[Array] = None
    going_to: Optional[Point] = None
    elapsed: Optional[float] = None
    left: Optional[float] = None
    report: Tuple[str, ...] = ()
    has_cleaner: bool = False
    can_resume: Optional[bool] = None


class Simulation(NamedTuple):
    """The simulator, and how time passes.

    Attributes:
        node: full name of the simulator's node; empty if no simulator runs.
        speed: reached, times real time; None if unknown.
        wanted: wanted speed, times real time; 0: as fast as possible; None if the simulator does not decide it.
        is_paused: whether simulated time is stopped.
        is_simulated: whether time is that of /clock, so that the speed can change.
        time: stamp of the newest reading [s]; None before the first.
        services: names of the simulator's services, below the name of its node.
    """

    node: str = ''
    speed: Optional[float] = None
    wanted: Optional[float] = None
    is_paused: bool = False
    is_simulated: bool = False
    time: Optional[float] = None
    services: FrozenSet[str] = frozenset()


@dataclasses.dataclass(frozen=True, eq=False)
class Snapshot:
    """Everything that the window shows.

    Attributes:
        plan: OCCUPIED, FREE or UNKNOWN for each cell, as in nav_msgs/OccupancyGrid.
        known: what the robot's own map shows in each cell of the plan, likewise; None if the plan is that map.
        map_frame: pose of the frame in which robots are sent somewhere, in that of the plan; None if it is unknown.
        coverage: 100 swept, 0 still to sweep, -1 out of reach, for each cell of the plan.
        obstacles: what stands or moves on the floor without being on the plan.
        selected: name of the robot that the keys drive and the panel describes; it may be absent.
        target: where a person may send the selected robot; None while none is chosen.
        missing: what the window waits for, and how to start it; empty if a robot and a map are there.
    """

    plan: Optional[Grid] = None
    known: Optional[Grid] = None
    map_frame: Optional[Pose] = Pose(0.0, 0.0, 0.0)
    coverage: Optional[Grid] = None
    features: MapFeatures = MapFeatures()
    robots: Tuple[Robot, ...] = ()
    obstacles: Tuple[Obstacle, ...] = ()
    selected: str = 'rumba'
    simulation: Simulation = Simulation()
    target: Optional[Point] = None
    missing: str = ''

    @property
    def robot(self) -> Optional[Robot]:
        """The selected robot."""
        return next((robot for robot in self.robots if robot.name == self.selected), None)

    @property
    def is_complete(self) -> bool:
        """Whether everything was received that a complete picture shows."""
        robot = self.robot
        return None not in (self.plan, self.coverage, robot) and robot is not None and None not in (
            robot.battery, robot.cleaning, robot.brushes_up)
