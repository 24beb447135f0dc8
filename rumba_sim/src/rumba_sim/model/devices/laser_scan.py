"""What the laser of a robot of a world tells, as a driver of one tells it."""

from typing import NamedTuple

import numpy as np

from rumba_sim.model.kernel import Array
from rumba_sim.model.settings.laser_config import LaserConfig
from rumba_sim.model.settings.mounting import Mounting
from rumba_sim.model.simulation.world import World


BRIGHTEST = 4000.0  # intensity of an echo from right beside the laser; our choice: no maker tells what its numbers mean


class LaserScan(NamedTuple):
    """A sensor_msgs/LaserScan with the same numbers, which are those of a float32, and where the laser is mounted."""

    ranges: Array  # float32 (beams) [m]
    angle_min: float  # of the first beam, frame of the laser [rad]
    angle_increment: float  # from beam to beam [rad]
    range_min: float  # [m]
    range_max: float  # [m]
    mounting: Mounting


def laser_scan(world: World, name: str) -> LaserScan:
    """Measure with the laser of a robot of a world.

    Raises:
        WorldError: there is no robot of that name.
    """
    laser = world.config.laser
    angle_min, increment, range_min, range_max = (
        float(np.float32(value)) for value in (laser.first_angle, laser.increment, laser.range_min, laser.range_max))
    return LaserScan(world.scan(name).astype(np.float32), angle_min, increment, range_min, range_max,
                     Mounting(laser.x, laser.y, laser.yaw, laser.upside_down))


def intensities(ranges: Array, laser: LaserConfig) -> Array:
    """How strong the echoes of measured ranges are, float64 (beams): weaker from farther away.

    It is 0 where there is no echo.
    """
    is_echo = np.isfinite(ranges) & (ranges > 0.0) & (ranges < laser.range_max)
    return np.where(is_echo, np.round(BRIGHTEST / (1.0 + np.where(is_echo, ranges, 0.0))), 0.0)
