"""One Rumba: its commands, its true state, and the readings of its sensors."""

import math
from typing import Any, MutableSequence, NamedTuple, Optional, Tuple

import numpy as np

from rumba_sim.model.common.errors import CommandError
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.kernel import Array, Record
from rumba_sim.model.kernel.records import NEVER, ROBOT
from rumba_sim.model.kernel.sensors.bumper import LEFT, RIGHT
from rumba_sim.model.settings.battery import Battery
from rumba_sim.model.settings.robot_config import RobotConfig

FIRST = 'rumba'  # name of the first robot
PLAIN = np.dtype((np.void, ROBOT))  # its elements are read in half the time that those of np.record take


def _places(*names: str) -> Tuple[int, ...]:
    """Where fields of the record of a robot are in its memory, in units of their own size."""
    fields: Any = ROBOT.fields
    return tuple(fields[name][1] // fields[name][0].itemsize for name in names)


# Floating-point numbers, whole numbers, and single bytes of the record.
X, Y, THETA, LEFT_SPEED, RIGHT_SPEED, COMMAND_V, COMMAND_W, ODOM_X, ODOM_Y, ODOM_THETA, ODOM_V, ODOM_W = _places(
    'x', 'y', 'theta', 'left_speed', 'right_speed', 'command_v', 'command_w', 'odom_x', 'odom_y', 'odom_theta',
    'odom_v', 'odom_w')
CHARGE, CURRENT, DISTANCE, BRUSH_TIME, CONTACT_ANGLE = _places(
    'charge', 'current', 'distance', 'brush_time', 'contact_angle')
COMMAND_TICK, LEFT_TICKS, RIGHT_TICKS, BUMPS = _places('command_tick', 'left_ticks', 'right_ticks', 'bumps')
BUMPER, BRUSHES_UP, DOCKED, FALLEN = _places('bumper', 'brushes_up', 'docked', 'fallen')


def nth_name(number: int) -> str:
    """Default name of a robot: rumba, rumba2, rumba3, ... for the numbers 1, 2, 3, ..."""
    return FIRST if number == 1 else f'{FIRST}{number}'


class Twist(NamedTuple):
    """Velocity of the body: forward [m/s] and counter-clockwise [rad/s]."""

    v: float
    w: float


class Infrared(NamedTuple):
    """Beams of the dock that each receiver gets: sums of FORCE_FIELD, GREEN_BUOY, RED_BUOY (`kernel.dock`)."""

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
        state: its record (of type ROBOT) in the array of the world.
    """

    def __init__(self, name: str, start: Start, config: RobotConfig, record: Array) -> None:
        """Wrap a record of a world, as for `hold`."""
        self.name = name
        self.start = start
        self.config = config
        self.hold(record)

    def hold(self, record: Array) -> None:
        """Be in this record from now on: an array of one record of type ROBOT.

        Its fields are read through memoryviews, which takes a fifth of the time that it takes through NumPy.
        """
        self.state: Record = record.view(PLAIN)[0]
        memory: Tuple[Any, ...] = tuple(memoryview(record.view(kind)) for kind in ('f8', 'i8', 'u1'))
        self._floats: MutableSequence[float] = memory[0]
        self._integers: MutableSequence[int] = memory[1]
        self._bytes: MutableSequence[int] = memory[2]

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
        floats = self._floats
        floats[COMMAND_V], floats[COMMAND_W], self._integers[COMMAND_TICK] = v, w, tick

    @property
    def pose(self) -> Pose:
        """True pose, map frame."""
        floats = self._floats
        return Pose(floats[X], floats[Y], floats[THETA])

    @property
    def twist(self) -> Twist:
        """Velocity from the true speeds of the wheels."""
        left, right = self._floats[LEFT_SPEED], self._floats[RIGHT_SPEED]
        return Twist(0.5 * (left + right), (right - left) / self.config.drive.wheel_base)

    @property
    def odometry(self) -> Pose:
        """Pose by its encoders, in a frame whose origin is its first pose."""
        floats = self._floats
        return Pose(floats[ODOM_X], floats[ODOM_Y], floats[ODOM_THETA])

    @property
    def odometry_twist(self) -> Twist:
        """Velocity by its encoders."""
        return Twist(self._floats[ODOM_V], self._floats[ODOM_W])

    @property
    def ticks(self) -> Tuple[int, int]:
        """Encoder ticks of the left and the right wheel since the start."""
        return self._integers[LEFT_TICKS], self._integers[RIGHT_TICKS]

    @property
    def battery(self) -> Battery:
        """Copy of the state of its battery."""
        config = self.config.battery
        return Battery(config, self._floats[CHARGE] / config.capacity, self._floats[CURRENT])

    @property
    def brushes_up(self) -> bool:
        """Whether the brushes are lifted and stopped."""
        return bool(self._bytes[BRUSHES_UP])

    @brushes_up.setter
    def brushes_up(self, up: bool) -> None:
        self._bytes[BRUSHES_UP] = bool(up)

    @property
    def bumper(self) -> Tuple[bool, bool]:
        """Whether the left and the right switch are pressed."""
        bits = self._bytes[BUMPER]
        return bool(bits & LEFT), bool(bits & RIGHT)

    @property
    def contact_angle(self) -> Optional[float]:
        """Direction of a contact with the body, counter-clockwise from its front [rad]; None without a contact."""
        angle = self._floats[CONTACT_ANGLE]
        return None if math.isnan(angle) else angle

    @property
    def bumps(self) -> int:
        """How often the bumper was pressed since the start."""
        return self._integers[BUMPS]

    @property
    def is_docked(self) -> bool:
        """Whether the charging contacts are closed."""
        return bool(self._bytes[DOCKED])

    @property
    def has_fallen(self) -> bool:
        """Whether a wheel is over a cliff: the robot cannot drive until it is put elsewhere."""
        return bool(self._bytes[FALLEN])

    @property
    def distance(self) -> float:
        """Distance driven since the start [m]."""
        return self._floats[DISTANCE]

    @property
    def brush_time(self) -> float:
        """Time with the brushes down and a battery that is not empty, since the start [s]."""
        return self._floats[BRUSH_TIME]


def put(state: Record, pose: Pose) -> None:
    """Put a robot at a pose, at rest; its odometry does not notice."""
    for name in ('left_speed', 'right_speed', 'command_v', 'command_w', 'odom_v', 'odom_w'):
        state[name] = 0.0
    state['x'], state['y'], state['theta'] = pose
    state['command_tick'] = NEVER
    state['contact_angle'] = math.nan
    for name in ('bumper', 'fallen', 'docked', 'sweeps', 'cliff_ticks'):
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
