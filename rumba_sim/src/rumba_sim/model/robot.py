"""One Rumba: what it is told, and what its sensors and the world know of it."""

import math
from typing import NamedTuple, Optional, Tuple

from rumba_sim.model import kernel
from rumba_sim.model.battery import Battery
from rumba_sim.model.errors import CommandError
from rumba_sim.model.geometry import Pose
from rumba_sim.model.kernel import Array, Record
from rumba_sim.model.robot_config import RobotConfig

FIRST = 'rumba'  # name of the first robot


def nth_name(number: int) -> str:
    """Name of a robot that has none of its own: rumba, rumba2, rumba3, ...; the first has the number 1."""
    return FIRST if number == 1 else f'{FIRST}{number}'


class Twist(NamedTuple):
    """Velocity of the body: forward [m/s] and counter-clockwise [rad/s]."""

    v: float
    w: float


class Infrared(NamedTuple):
    """Sums of the dock's beams that each receiver gets: bits FORCE_FIELD, GREEN_BUOY, RED_BUOY of `kernel`."""

    omni: int
    left: int
    right: int


class Start(NamedTuple):
    """How a robot began, and begins again after a reset."""

    pose: Pose  # [m, rad] in the map frame
    state_of_charge: float = 1.0  # [0..1]
    brushes_up: bool = False


class Robot:
    """A robot of a world, which moves it; made by `World.spawn`.

    Attributes:
        name: unique in its world.
        start: how it began.
        config: its constants.
        state: its record (`kernel.ROBOT`) in the array of the world.
    """

    def __init__(self, name: str, start: Start, config: RobotConfig, state: Record) -> None:
        """Look at the record of a world."""
        self.name = name
        self.start = start
        self.config = config
        self.state = state

    def command(self, v: float, w: float, tick: int) -> None:
        """Ask for a velocity, forward [m/s] and counter-clockwise [rad/s], at a tick of the world.

        What exceeds the limits of the drive is cut; after `drive/command_timeout` without a command the robot stops.

        Raises:
            CommandError: a velocity is not a finite number; the command before stays in force.
        """
        if not (math.isfinite(v) and math.isfinite(w)):
            raise CommandError(f'{self.name}: velocity {v} m/s, {w} rad/s: must be finite numbers')
        self.state['command_v'] = v
        self.state['command_w'] = w
        self.state['command_tick'] = tick

    @property
    def pose(self) -> Pose:
        """Where it truly is, map frame."""
        state = self.state
        return Pose(float(state['x']), float(state['y']), float(state['theta']))

    @property
    def twist(self) -> Twist:
        """How its wheels turn, without their errors."""
        left, right = float(self.state['left_speed']), float(self.state['right_speed'])
        return Twist(0.5 * (left + right), (right - left) / self.config.drive.wheel_base)

    @property
    def odometry(self) -> Pose:
        """Where its encoders make it believe to be, in a frame that began where it was put."""
        state = self.state
        return Pose(float(state['odom_x']), float(state['odom_y']), float(state['odom_theta']))

    @property
    def odometry_twist(self) -> Twist:
        """How fast its encoders make it believe to be."""
        return Twist(float(self.state['odom_v']), float(self.state['odom_w']))

    @property
    def ticks(self) -> Tuple[int, int]:
        """Encoder ticks of the left and the right wheel since the start."""
        return int(self.state['left_ticks']), int(self.state['right_ticks'])

    @property
    def battery(self) -> Battery:
        """A copy of the state of its battery."""
        config = self.config.battery
        return Battery(config, float(self.state['charge']) / config.capacity, float(self.state['current']))

    @property
    def brushes_up(self) -> bool:
        """Whether the brushes are lifted and still."""
        return bool(self.state['brushes_up'])

    @brushes_up.setter
    def brushes_up(self, up: bool) -> None:
        self.state['brushes_up'] = up

    @property
    def bumper(self) -> Tuple[bool, bool]:
        """Whether the left and the right switch are pressed."""
        bits = int(self.state['bumper'])
        return bool(bits & kernel.LEFT), bool(bits & kernel.RIGHT)

    @property
    def contact_angle(self) -> Optional[float]:
        """Where something touches the body, counter-clockwise from its front [rad]; None where nothing does."""
        angle = float(self.state['contact_angle'])
        return None if math.isnan(angle) else angle

    @property
    def bumps(self) -> int:
        """How often the bumper was pressed anew."""
        return int(self.state['bumps'])

    @property
    def is_docked(self) -> bool:
        """Whether the charging contacts are closed."""
        return bool(self.state['docked'])

    @property
    def has_fallen(self) -> bool:
        """Whether a wheel hangs over a cliff: the robot cannot drive until somebody puts it elsewhere."""
        return bool(self.state['fallen'])

    @property
    def distance(self) -> float:
        """Way driven since the start [m]."""
        return float(self.state['distance'])

    @property
    def brush_time(self) -> float:
        """Time with brushes down and a charged battery since the start [s]."""
        return float(self.state['brush_time'])


def put(state: Record, pose: Pose) -> None:
    """Set a robot down at a pose, at rest; odometry does not notice."""
    for name in ('left_speed', 'right_speed', 'command_v', 'command_w', 'odom_v', 'odom_w'):
        state[name] = 0.0
    state['x'], state['y'], state['theta'] = pose
    state['command_tick'] = kernel.NEVER
    state['contact_angle'] = math.nan
    for name in ('bumper', 'fallen', 'docked'):
        state[name] = 0


def begin(state: Record, start: Start, capacity: float, scales: Array) -> None:
    """Fill the record of a new robot: capacity of its battery [Ah], scale errors of the left and right wheel."""
    state.fill(0)
    put(state, start.pose)
    state['charge'] = capacity * start.state_of_charge
    state['brushes_up'] = start.brushes_up
    state['left_scale'], state['right_scale'] = 1.0 + scales[0], 1.0 + scales[1]
