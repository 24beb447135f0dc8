"""The kernel's record of constants, from a configuration and a floor plan."""

import math

import numpy as np

from rumba_sim.model import kernel
from rumba_sim.model.errors import ConfigError, MapError
from rumba_sim.model.floor_plan import FloorPlan
from rumba_sim.model.kernel import Array
from rumba_sim.model.robot_config import RobotConfig


def constants(config: RobotConfig, plan: FloorPlan, step_rate: float) -> Array:
    """An array of one record `kernel.CONSTANTS`.

    Raises:
        ConfigError: a robot would move by more than its radius in one tick.
        MapError: the cells are larger than the robot's radius.
    """
    drive = config.drive
    if drive.max_speed > drive.radius * step_rate:
        raise ConfigError(f'drive/max_speed is {drive.max_speed:g}: at {step_rate:g} ticks a second must be at most '
                          f'{drive.radius * step_rate:g} [m/s], a radius in a tick')
    if plan.resolution > drive.radius:
        raise MapError(f'{plan.name}: cells of {plan.resolution:g} m are too coarse for a robot of radius '
                       f'{drive.radius:g} m')
    k = np.zeros(1, kernel.CONSTANTS)
    for part in (drive, config.battery):
        for name in k.dtype.names or ():
            if hasattr(part, name):
                k[0][name] = getattr(part, name)
    _fill(k[0], config, plan)
    k[0]['dt'] = 1.0 / step_rate
    k[0]['timeout_ticks'] = max(round(drive.command_timeout * step_rate), 1)
    return k


def _fill(k: kernel.Record, config: RobotConfig, plan: FloorPlan) -> None:
    """What has another name here than in the configuration, or comes from the plan."""
    drive, odometry, bumper, laser, dock = config.drive, config.odometry, config.bumper, config.laser, config.dock
    k['origin_x'], k['origin_y'] = plan.origin
    k['resolution'] = plan.resolution
    # Bilinear interpolation of the distance to a corner is too large by resolution^2 / 8 * (second derivatives,
    # together 1 / distance), or by 5 % more, since these change within a cell: with so much more room the body itself
    # never overlaps a wall.
    k['reach'] = drive.radius + 1.05 * plan.resolution ** 2 / (8.0 * drive.radius)
    k['ticks_per_metre'] = drive.ticks_per_turn / (math.pi * drive.wheel_diameter)
    k['noise'] = odometry.noise
    k['floor_traction'], k['carpet_traction'] = odometry.floor_traction, odometry.carpet_traction
    k['bumper_half'], k['overlap_half'] = 0.5 * bumper.field, 0.5 * bumper.overlap
    k['range_min'], k['range_max'], k['range_noise'] = laser.range_min, laser.range_max, laser.noise
    for name in ('contact_distance', 'contact_angle', 'release_distance', 'release_angle', 'buoy_range', 'halo'):
        k[name] = getattr(dock, name)
    k['buoy_half'], k['buoy_overlap_half'] = 0.5 * dock.buoy_field, 0.5 * dock.buoy_overlap
    k['brush_width'], k['log_kept'] = config.brush.width, math.log1p(-config.brush.pickup)
    k['has_layers'] = plan.cliff is not None or plan.carpet is not None
    if plan.dock is not None:
        k['has_dock'] = True
        k['dock_x'], k['dock_y'], k['dock_theta'] = plan.dock
