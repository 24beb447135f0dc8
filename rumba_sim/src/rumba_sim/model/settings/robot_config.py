"""The configuration of a Rumba: every figure with its unit, its range and its source.

Sources: OI is the iRobot Roomba 600 Open Interface specification; libcreate and create_robot are drivers of the
Create 2; create3_sim and Create 3 are the simulator and the documentation of the Create 3; makers and owners are data
of battery makers and measurements by owners.
"""

import dataclasses
import math
from typing import Tuple

from rumba_sim.model.common.config import section, setting
from rumba_sim.model.common.errors import ConfigError
from rumba_sim.model.common.geometry import TURN
from rumba_sim.model.settings.battery import BatteryConfig
from rumba_sim.model.settings.laser_config import LaserConfig


@dataclasses.dataclass(frozen=True)
class DriveConfig:
    """Body and wheels."""

    radius: float = setting(0.17425, 'radius of the body, a disc (create_robot: diameter 0.3485)', 'm', 0.02, 5.0)
    wheel_base: float = setting(0.235, 'distance between the wheels (libcreate)', 'm', 0.01, 10.0)
    wheel_diameter: float = setting(0.072, 'diameter of a wheel (libcreate)', 'm', 0.001, 10.0)
    ticks_per_turn: float = setting(508.8, 'encoder ticks per turn of a wheel (OI)', '', 1.0, 1e6)
    max_speed: float = setting(0.5, 'largest speed of a wheel over the ground (OI)', 'm/s', 0.01, 10.0)
    max_turn_rate: float = setting(1.9, 'largest angular velocity of the body (Create 3)', 'rad/s', 0.01, 50.0)
    acceleration: float = setting(0.9, 'acceleration of a wheel (Create 3)', 'm/s^2', 0.01, 1000.0)
    dead_band: float = setting(0.011, 'a wheel that is commanded a lower speed stands still (owners)', 'm/s', 0.0, 0.1)
    command_timeout: float = setting(0.5, 'the robot stops if it gets no command for this time (create_robot: 0.2, '
                                          'turtlesim: 1)', 's', 0.02, 60.0)


@dataclasses.dataclass(frozen=True)
class OdometryConfig:
    """Errors of the wheels."""

    scale_error: float = setting(0.01, 'standard deviation of the scale of each wheel, drawn once for each robot '
                                       '(our choice: a wheel worn by 0.4 mm)', '', 0.0, 0.2)
    noise: float = setting(0.002, 'standard deviation of the distance of a wheel after 1 m; it grows with the square '
                                  'root of the distance (our choice)', 'm', 0.0, 0.1)
    floor_traction: float = setting(0.98, 'driven distance / distance that the encoder counts, on hard floor (owners)',
                                    '', 0.5, 1.0)
    carpet_traction: float = setting(0.92, 'the same on carpet (owners)', '', 0.5, 1.0)


@dataclasses.dataclass(frozen=True)
class BumperConfig:
    """The contact switches at the front."""

    field: float = setting(2.6, 'angle of the body that the bumper covers, half to each side (our choice: 150 degrees)',
                           'rad', 0.1, TURN)
    overlap: float = setting(0.35, 'angle in the middle in which a contact presses both switches (our choice: '
                                   '20 degrees)', 'rad', 0.0, 3.0)


@dataclasses.dataclass(frozen=True)
class CliffConfig:
    """The cliff sensors under the front (OI: there are four; their positions are our choice).

    The outer ones look 1.7 cm outside the wheels, so that no corner of 90 degrees comes to a wheel between two readings
    of a robot that drives straight at 0.3 m/s and looks ten times a second: the first reading that shows the corner
    leaves it the 0.05 m within which it brakes.
    """

    distance: float = setting(0.165, 'distance from the centre of the robot (our choice: 1 cm inside the rim)', 'm',
                              0.0, 5.0)
    inner_angle: float = setting(0.32, 'angle from straight ahead to front left and front right', 'rad', 0.0, math.pi)
    outer_angle: float = setting(0.95, 'angle from straight ahead to left and right', 'rad', 0.0, math.pi)
    hold: float = setting(0.1, 'a sensor that saw a cliff reports it for so long, so that a reader at 10 Hz misses '
                               'none (our choice)', 's', 0.0, 10.0)

    @property
    def angles(self) -> Tuple[float, float, float, float]:
        """Of the left, front left, front right and right sensor, from straight ahead [rad]."""
        return self.outer_angle, self.inner_angle, -self.inner_angle, -self.outer_angle


@dataclasses.dataclass(frozen=True)
class DockConfig:
    """Contacts of the dock, and the infrared beams that lead to them."""

    contact_distance: float = setting(0.075, 'the contacts close within this distance (create3_sim)', 'm', 0.001, 1.0)
    contact_angle: float = setting(0.105, 'and within this error of the heading (create3_sim: 6 degrees)', 'rad',
                                   0.01, 3.0)
    release_distance: float = setting(0.1, 'closed contacts open beyond this distance, which is larger so that they do '
                                           'not flicker', 'm', 0.001, 1.0)
    release_angle: float = setting(0.157, 'or beyond this error of the heading (9 degrees)', 'rad', 0.01, 3.0)
    buoy_range: float = setting(3.0, 'range of the red and the green buoy (our choice)', 'm', 0.1, 100.0)
    buoy_field: float = setting(0.873, 'angle that both buoys cover together (create3_sim: 50 degrees)', 'rad',
                                0.05, 3.0)
    buoy_overlap: float = setting(0.087, 'angle about the axis in which both buoys are received (our choice: '
                                         '5 degrees)', 'rad', 0.0, 1.0)
    halo: float = setting(0.6, 'range of the force field (create3_sim)', 'm', 0.0, 10.0)

    def __post_init__(self) -> None:
        """Refuse contacts that open before they close: they would flicker."""
        for what in ('distance', 'angle'):
            contact, release = getattr(self, f'contact_{what}'), getattr(self, f'release_{what}')
            if release < contact:
                raise ConfigError(f'dock/release_{what} is {release:g}: must not be below contact_{what}, {contact:g}')


@dataclasses.dataclass(frozen=True)
class BrushConfig:
    """The brush."""

    width: float = setting(0.17, 'width of the main brush, under the centre of the robot (the usual size; none is '
                                 'published)', 'm', 0.01, 10.0)
    pickup: float = setting(0.9, 'share of the dirt that one pass removes (our choice)', '', 0.0, 0.999)


@dataclasses.dataclass(frozen=True)
class RobotConfig:
    """The whole configuration of a robot."""

    drive: DriveConfig = section(DriveConfig, 'body and wheels')
    odometry: OdometryConfig = section(OdometryConfig, 'errors of the wheels')
    bumper: BumperConfig = section(BumperConfig, 'the contact switches at the front')
    cliff: CliffConfig = section(CliffConfig, 'the cliff sensors under the front')
    laser: LaserConfig = section(LaserConfig, 'the laser scanner on top')
    dock: DockConfig = section(DockConfig, 'contacts of the dock, and the infrared beams that lead to them')
    brush: BrushConfig = section(BrushConfig, 'the brush')
    battery: BatteryConfig = section(BatteryConfig, 'battery and charger')
