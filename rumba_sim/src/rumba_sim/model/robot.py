"""One Rumba: its commands, its true state, and the readings of its sensors."""

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
    """Default name of a robot: rumba, rumba2, rumba3, ... for the numbers 1, 2, 3, ..."""
    return FIRST if number == 1 else f'{FIRST}{number}'


class Twist(NamedTuple):
    """Velocity of the body: forward [m/s] and counter-clockwise [rad/s]."""

    v: float
    w: float


class Infrared(NamedTuple):
    """Beams of the dock that each receiver gets: sums of the bits FORCE_FIELD, GREEN_BUOY, RED_BUOY of `kernel`."""

    omni: int
    left: int
    right: int


class Start(NamedTuple):
    """How a robot begins, and begins again after a reset."""

    pose: Pose  # [m, rad] in the map frame
    state_of_charge: float = 1.0  # [0..1]
    brushes_up: bool = False


class Robot:
    """A robot in a world; made by `World.spawn` and moved by `World.step`.

    Attributes:
        name: name, unique in its world.
        start: how it began.
        config: configuration of the robot.
        state: its record (`kernel.ROBOT`) in the array of the world.
    """

    def __init__(self, name: str, start: Start, config: RobotConfig, state: Record) -> None:
        """Wrap a record of a world."""
        self.name = name
        self.start = start
        self.config = config
        self.state = state

    def command(self, v: float, w: float, tick: int) -> None:
        """Command a velocity.

        It is cut to the limits of the drive; after `drive/command_timeout` without a command the robot stops.

        Args:
            v: forward velocity [m/s].
            w: angular velocity, counter-clockwise [rad/s].
            tick: the present tick of the world.

        Raises:
            CommandError: a velocity is not a finite number; the previous command stays in force.
        """
        if not (math.isfinite(v) and math.isfinite(w)):
            raise CommandError(f'{self.name}: velocity {v} m/s, {w} rad/s: must be finite numbers')
        self.state['command_v'] = v
        self.state['command_w'] = w
        self.state['command_tick'] = tick

    @property
    def pose(self) -> Pose:
        """True pose, map frame."""
        state = self.state
        return Pose(float(state['x']), float(state['y']), float(state['theta']))

    @property
    def twist(self) -> Twist:
        """Velocity from the true speeds of the wheels."""
        left, right = float(self.state['left_speed']), float(self.state['right_speed'])
        return Twist(0.5 * (left + right), (right - left) / self.config.drive.wheel_base)

    @property
    def odometry(self) -> Pose:
        """Pose by its encoders, in a frame whose origin is its first pose."""
        state = self.state
        return Pose(float(state['odom_x']), float(state['odom_y']), float(state['odom_theta']))

    @property
    def odometry_twist(self) -> Twist:
        """Velocity by its encoders."""
        return Twist(float(self.state['odom_v']), float(self.state['odom_w']))

    @property
    def ticks(self) -> Tuple[int, int]:
        """Encoder ticks of the left and the right wheel since the start."""
        return int(self.state['left_ticks']), int(self.state['right_ticks'])

    @property
    def battery(self) -> Battery:
        """Copy of the state of its battery."""
        config = self.config.battery
        return Battery(config, float(self.state['charge']) / config.capacity, float(self.state['current']))

    @property
    def brushes_up(self) -> bool:
        """Whether the brushes are lifted and stopped."""
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
        """Direction of a contact with the body, counter-clockwise from its front [rad]; None without a contact."""
        angle = float(self.state['contact_angle'])
        return None if math.isnan(angle) else angle

    @property
    def bumps(self) -> int:
        """How often the bumper was pressed since the start."""
        return int(self.state['bumps'])

    @property
    def is_docked(self) -> bool:
        """Whether the charging contacts are closed."""
        return bool(self.state['docked'])

    @property
    def has_fallen(self) -> bool:
        """Whether a wheel is over a cliff: the robot cannot drive until it is put elsewhere."""
        return bool(self.state['fallen'])

    @property
    def distance(self) -> float:
        """Distance driven since the start [m]."""
        return float(self.state['distance'])

    @property
    def brush_time(self) -> float:
        """Time with the brushes down and a battery that is not empty, since the start [s]."""
        return float(self.state['brush_time'])


def put(state: Record, pose: Pose) -> None:
    """Put a robot at a pose, at rest; its odometry does not notice."""
    for name in ('left_speed', 'right_speed', 'command_v', 'command_w', 'odom_v', 'odom_w'):
        state[name] = 0.0
    state['x'], state['y'], state['theta'] = pose
    state['command_tick'] = kernel.NEVER
    state['contact_angle'] = math.nan
    for name in ('bumper', 'fallen', 'docked', 'sweeps'):
        state[name] = 0


def begin(state: Record, start: Start, capacity: float, scales: Array) -> None:
    """Fill the record of a new robot.

    Args:
        state: the record.
        start: how the robot begins.
        capacity: of its battery [Ah].
        scales: scale errors of the left and the right wheel.
    """
    state.fill(0)
    put(state, start.pose)
    state['charge'] = capacity * start.state_of_charge
    state['brushes_up'] = start.brushes_up
    state['left_scale'], state['right_scale'] = 1.0 + scales[0], 1.0 + scales[1]
