"""The constants of the kernel, computed from the configuration of the robots and a floor plan."""

import math
import typing
from typing import Any, Dict, NamedTuple

import numpy as np

from rumba_sim.model.common.errors import ConfigError, MapError
from rumba_sim.model.kernel import Array
from rumba_sim.model.kernel.sweeping.samples import MOST_PASSES
from rumba_sim.model.maps.floor_plan import FloorPlan
from rumba_sim.model.settings.robot_config import RobotConfig

FORMATS: Dict[Any, str] = {float: 'f8', int: 'i8', bool: '?', Array: f'({MOST_PASSES + 1},)f8'}


class Constants(NamedTuple):
    """Everything that stays the same from tick to tick; no field has a default, so that none can be forgotten."""

    # time and floor
    dt: float  # duration of a tick [s]
    origin_x: float  # lower left corner of cell (0, 0), map frame [m]
    origin_y: float
    resolution: float  # side of a cell [m]
    has_layers: bool  # whether the floor has cliffs or carpets
    # body and wheels
    radius: float  # [m]
    reach: float  # interpolated clearance at which the body touches a wall [m]
    wheel_base: float  # [m]
    ticks_per_metre: float
    max_speed: float  # of a wheel [m/s]
    max_turn_rate: float  # [rad/s]
    acceleration: float  # of a wheel [m/s^2]
    dead_band: float  # of a wheel [m/s]
    timeout_ticks: int  # a command is in force for so many ticks
    noise: float  # standard deviation of a wheel after 1 m [m]
    floor_traction: float  # driven distance / counted distance
    carpet_traction: float
    # cliff sensors
    has_cliffs: bool  # whether the floor has any
    cliff_distance: float  # from the centre of the robot [m]
    cliff_inner: float  # angle from straight ahead to the inner ones [rad]
    cliff_outer: float  # and to the outer ones [rad]
    cliff_hold: int  # a sensor tells of a cliff for so many ticks
    # bumper and laser
    bumper_half: float  # half of the angle that the bumper covers [rad]
    overlap_half: float  # half of the angle in which a contact presses both switches [rad]
    range_min: float  # [m]
    range_max: float  # [m]
    range_noise: float  # standard deviation of a range, at least [m]
    relative_noise: float  # and in proportion to the range
    range_bias: float  # standard deviation among lasers of their systematic errors, at least [m]
    relative_bias: float  # and in proportion to the range
    range_step: float  # ranges are multiples of it [m]; 0: they are any numbers
    too_far: float  # what is told instead of a range if there is no echo [m]
    too_near: float  # and for less than range_min [m]
    dropouts: float  # probability that an echo is missed
    sure_range: float  # up to this range [m]; it rises to 1 at range_max
    beam_width: float  # angle that a beam covers [rad]
    mixing_depth: float  # surfaces that are farther apart do not mix [m]
    laser_x: float  # where the laser is, frame of the robot [m]
    laser_y: float
    first_beam: float  # direction of the first beam, frame of the robot [rad]
    beam_step: float  # angle from beam to beam, frame of the robot [rad]
    beams_per_turn: int  # so many of them are a full turn
    # dock
    contact_distance: float  # the contacts close at or below [m]
    contact_angle: float  # and [rad]
    release_distance: float  # the contacts open above [m]
    release_angle: float  # or [rad]
    buoy_range: float  # [m]
    buoy_half: float  # half of the angle that both buoys cover together [rad]
    buoy_overlap_half: float  # half of the angle in which both are received [rad]
    halo: float  # range of the force field [m]
    # brush
    brush_width: float  # [m]
    sample_pitch: float  # side of the squares of the floor that hold one sample point each [m]
    takes: Array  # share of the first dirt that a pass takes, after 0, 1, ... MOST_PASSES others: float64
    # battery
    capacity: float  # [Ah]
    idle_current: float  # [A]
    wheel_current_slow: float  # [A]
    wheel_current: float  # [A]
    wheel_speed: float  # [m/s]
    brush_current: float  # [A]
    charge_current: float  # [A]
    trickle_current: float  # [A]
    taper_start: float  # state of charge [0..1]
    drain: float  # factor on the change of charge


RECORD = np.dtype((np.record, np.dtype(
    [(name, FORMATS[kind]) for name, kind in typing.get_type_hints(Constants).items()], align=True)))


def constants(config: RobotConfig, plan: FloorPlan, step_rate: float) -> Array:
    """The record of `Constants` that the kernel reads, as an array of one element.

    Raises:
        MapError: the cells are larger than the radius of a robot.
    """
    if plan.resolution > config.drive.radius:
        raise MapError(f'{plan.name}: cells of {plan.resolution:g} m are too coarse for a robot of radius '
                       f'{config.drive.radius:g} m')
    return np.array([tuple(_values(config, plan, step_rate))], RECORD)


def check_speed(config: RobotConfig, step_rate: float) -> None:
    """Check the highest speed of a robot.

    Raises:
        ConfigError: it could move by more than its radius in one tick.
    """
    drive = config.drive
    if drive.max_speed > drive.radius * step_rate:
        raise ConfigError(f'drive/max_speed is {drive.max_speed:g}: at {step_rate:g} ticks a second must be at most '
                          f'{drive.radius * step_rate:g} [m/s], a radius in a tick')


def _values(config: RobotConfig, plan: FloorPlan, step_rate: float) -> Constants:
    drive, odometry, bumper, laser = config.drive, config.odometry, config.bumper, config.laser
    dock, brush, battery = config.dock, config.brush, config.battery
    return Constants(
        dt=1.0 / step_rate, origin_x=plan.origin[0], origin_y=plan.origin[1], resolution=plan.resolution,
        has_layers=plan.cliff is not None or plan.carpet is not None,
        radius=drive.radius, reach=clearance_needed(drive.radius, plan.resolution), wheel_base=drive.wheel_base,
        ticks_per_metre=drive.ticks_per_turn / (math.pi * drive.wheel_diameter), max_speed=drive.max_speed,
        max_turn_rate=drive.max_turn_rate, acceleration=drive.acceleration, dead_band=drive.dead_band,
        timeout_ticks=max(round(drive.command_timeout * step_rate), 1), noise=odometry.noise,
        floor_traction=odometry.floor_traction, carpet_traction=odometry.carpet_traction,
        has_cliffs=plan.cliff is not None, cliff_distance=config.cliff.distance,
        cliff_inner=config.cliff.inner_angle, cliff_outer=config.cliff.outer_angle,
        cliff_hold=round(config.cliff.hold * step_rate),
        bumper_half=0.5 * bumper.field, overlap_half=0.5 * bumper.overlap,
        range_min=laser.range_min, range_max=laser.range_max, range_noise=laser.noise,
        relative_noise=laser.relative_noise, range_bias=laser.bias, relative_bias=laser.relative_bias,
        range_step=laser.resolution, too_far=laser.too_far, too_near=laser.too_near, dropouts=laser.dropouts,
        sure_range=laser.sure_range, beam_width=laser.beam_width, mixing_depth=laser.mixing_depth,
        laser_x=laser.x, laser_y=laser.y, first_beam=laser.first_in_robot, beam_step=laser.step_in_robot,
        beams_per_turn=laser.beams_in_turn,
        contact_distance=dock.contact_distance, contact_angle=dock.contact_angle,
        release_distance=dock.release_distance, release_angle=dock.release_angle, buoy_range=dock.buoy_range,
        buoy_half=0.5 * dock.buoy_field, buoy_overlap_half=0.5 * dock.buoy_overlap, halo=dock.halo,
        brush_width=brush.width, sample_pitch=plan.sample_pitch,
        takes=_takes(brush.pickup), capacity=battery.capacity,
        idle_current=battery.idle_current, wheel_current_slow=battery.wheel_current_slow,
        wheel_current=battery.wheel_current, wheel_speed=battery.wheel_speed, brush_current=battery.brush_current,
        charge_current=battery.charge_current, trickle_current=battery.trickle_current,
        taper_start=battery.taper_start, drain=battery.drain)


def clearance_needed(radius: float, resolution: float) -> float:
    """The interpolated clearance [m] that keeps a body of a radius [m] out of the walls.

    Bilinear interpolation of the distance to a corner is too large by resolution^2 / 8 * (sum of the second
    derivatives, which is 1 / distance), or by 5 % more, since the derivatives change within a cell. With a clearance
    that is larger by as much, the body itself never overlaps a wall.
    """
    return radius + 1.05 * resolution ** 2 / (8.0 * radius)


def _takes(pickup: float) -> Array:
    """Shares of the first dirt that passes take; a power of NumPy depends on its version and on the processor."""
    return np.array([pickup * (1.0 - pickup) ** passes for passes in range(MOST_PASSES + 1)])
