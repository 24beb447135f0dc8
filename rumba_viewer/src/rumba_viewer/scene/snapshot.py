"""What the window shows at one moment, and nothing of where it came from: no ROS, no Qt."""

import dataclasses
from typing import Any, NamedTuple, Optional, Tuple

from rumba_sim.model.geometry import Pose
from rumba_sim.model.robot_config import BrushConfig, DriveConfig

Array = Any  # numpy.ndarray


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
        number: another one for every other content; painters keep by it what they made of a grid.
    """

    cells: Array
    resolution: float
    left: float
    bottom: float
    number: int

    @property
    def box(self) -> Box:
        """Where it lies."""
        rows, columns = self.cells.shape
        return Box(self.left, self.bottom, self.left + columns * self.resolution,
                   self.bottom + rows * self.resolution)


@dataclasses.dataclass(frozen=True, eq=False)
class Dock:
    """The dock, and where its beams reach.

    Attributes:
        pose: of a robot that stands at the contacts and faces the dock.
        halo: corners (n, 2) [m] of the floor on which its force field is received.
        field: corners (n, 2) [m] of the floor on which its buoys are received.
    """

    pose: Pose
    halo: Array
    field: Array


@dataclasses.dataclass(frozen=True, eq=False)
class Place:
    """What a map's files tell beyond its cells.

    Attributes:
        dock: None where there is none, or where the files cannot be read from here.
        carpet, cliff: bool (rows, columns) as the map's cells; None where there is none.
        is_known: whether the files were read.
    """

    dock: Optional[Dock] = None
    carpet: Optional[Array] = None
    cliff: Optional[Array] = None
    is_known: bool = False


@dataclasses.dataclass(frozen=True, eq=False)
class Path:
    """The way that a robot drove.

    Attributes:
        points: (n, 2) [m]; a row of NaN lifts the pen.
        number: as long as it stays, points are only added.
    """

    points: Array
    number: int


class Battery(NamedTuple):
    """Charge 0..1, [V], [A] (negative out of the battery; NaN: unknown), and `charging`, `full` or `on battery`."""

    share: float
    voltage: float
    current: float
    state: str


class Cleaning(NamedTuple):
    """How far the floor is clean: shares 0..1, areas [m^2], way [m]."""

    coverage: float
    cleaned_area: float
    reachable_area: float
    dirt: float
    distance: float


class Mission(NamedTuple):
    """What the cleaner has a robot do.

    Attributes:
        state: in a word or two, as `cleaning`.
        is_active: whether there is a goal.
        strategy: in use; empty where none is.
        message: one line for a person.
    """

    state: str
    is_active: bool
    strategy: str
    message: str


class Size(NamedTuple):
    """What a robot is like [m]."""

    radius: float = DriveConfig.radius
    brush: float = BrushConfig.width


@dataclasses.dataclass(frozen=True, eq=False)
class Robot:
    """One robot; what it did not tell yet is None.

    Attributes:
        name: below which its topics are.
        bumper: left and right switch.
        message: the debug message of battery_status.
        beams: ends (n, 2) of the laser's beams in the robot's frame [m]; None while it is not shown.
        has_cleaner: whether a cleaner takes goals for it.
    """

    name: str
    pose: Pose
    size: Size = Size()
    bumper: Tuple[bool, bool] = (False, False)
    brushes_up: Optional[bool] = None
    message: str = ''
    battery: Optional[Battery] = None
    cleaning: Optional[Cleaning] = None
    mission: Optional[Mission] = None
    path: Optional[Path] = None
    beams: Optional[Array] = None
    has_cleaner: bool = False


class Simulation(NamedTuple):
    """How time passes.

    Attributes:
        speed: measured, times real time; None where nobody tells.
        wanted: what it shall be; 0: as fast as possible; None where nobody tells.
        is_paused: whether time stands still.
        is_simulated: whether /clock is told, so that the speed can change.
        time: stamp of the newest reading [s]; None before the first.
        is_controlled: whether there is a simulator that serves pause, step, reset and so on.
    """

    speed: Optional[float] = None
    wanted: Optional[float] = None
    is_paused: bool = False
    is_simulated: bool = False
    time: Optional[float] = None
    is_controlled: bool = False


@dataclasses.dataclass(frozen=True, eq=False)
class Snapshot:
    """All of it.

    Attributes:
        plan: OCCUPIED, FREE or UNKNOWN of each cell, as nav_msgs/OccupancyGrid has it.
        coverage: 100 swept, 0 still to sweep, -1 out of reach, on the cells of the plan.
        selected: name of the robot that keys drive and the panel tells of; it need not be there.
        missing: what the window waits for, and how to start it; empty where a robot is there.
    """

    plan: Optional[Grid] = None
    coverage: Optional[Grid] = None
    place: Place = Place()
    robots: Tuple[Robot, ...] = ()
    selected: str = 'rumba'
    simulation: Simulation = Simulation()
    missing: str = ''

    @property
    def robot(self) -> Optional[Robot]:
        """The selected robot."""
        return next((robot for robot in self.robots if robot.name == self.selected), None)

    @property
    def is_complete(self) -> bool:
        """Whether all is there that makes a good picture."""
        robot = self.robot
        return None not in (self.plan, self.coverage, robot) and robot is not None and None not in (
            robot.battery, robot.cleaning, robot.brushes_up)
