"""What a laser tells, as points: here alone is decided what a reading means."""

import functools
import math
from typing import Any, NamedTuple, Optional, Tuple

import numpy as np

from rumba_sim.model.kernel import Array
from rumba_sim.model.settings.mounting import CENTRE, Mounting

FEWEST = 10  # beams with an echo, fewer tell nothing
SILENT = 1.0  # [s] of the time of a robot without a scan, from which on its laser is silent: five scans at 5 Hz
FARTHEST = 100.0  # [m] no laser that sees a floor sees farther; drivers that tell 1e30 mean nothing
NEAREST = 0.005  # [m] no laser sees nearer: a beam without a length has no direction
DENSE = 2000  # beams in a scan, of more some are left out: they tell the same, and take memory for each place
WIDEST = 1.0  # [rad] between two echoes, up to which what lies between them is believed to be free


class Scan(NamedTuple):
    """What a laser tells at one moment, in the frame of the robot [m]."""

    points: Array  # float64 (any, 2), where beams with an echo end
    beyond: Array  # float64 (any, 2), as far as beams without an echo are believed to be free
    laser: Tuple[float, float] = (0.0, 0.0)  # where all beams begin


class Reading(NamedTuple):
    """How the readings of a laser are taken, whatever its messages say."""

    min_range: float = 0.0  # [m] a shorter one is none, as laser_min_range of amcl; 0: as the message says
    max_range: float = 0.0  # [m] a longer one is none, as laser_max_range of amcl; 0: as the message says
    usable: float = 0.0  # [m] so far a beam without an echo is free, as maxUrange of gmapping; 0: as far as echoes
    #                          beside it show


AS_TOLD = Reading()


def scan_of(ranges: Array, angle_min: float, angle_increment: float, range_max: float, range_min: float = 0.0,
            mounting: Mounting = CENTRE, reading: Reading = AS_TOLD) -> Scan:
    """A scan, by its ranges.

    A range is an echo from range_min on, and below range_max. What is infinite, or as long as range_max, has none
    (REP 117). All else tells nothing: NaN, -inf, 0, and what is shorter than range_min.

    A laser also misses echoes of what is near: black or shiny things, and glass. So a beam without one is believed to
    be free only as far as the straight line between the two echoes beside it, unless `reading` says more.

    Args:
        ranges: float (beams) [m].
        angle_min: direction of the first beam, frame of the laser [rad].
        angle_increment: from beam to beam [rad].
        range_max: of the laser [m].
        range_min: of the laser [m].
        mounting: of the laser.
        reading: how ranges are taken.
    """
    each = -(-len(ranges) // DENSE)
    if each > 1:
        ranges, angle_increment = ranges[::each], angle_increment * each
    nearest, farthest = reading.min_range or range_min, min(reading.max_range or range_max, FARTHEST)
    with np.errstate(invalid='ignore'):
        has_echo = (ranges >= max(nearest, NEAREST)) & (ranges < farthest)
        has_none = ranges >= farthest
    directions = _directions(len(ranges), angle_min, angle_increment, mounting)
    here = np.array(mounting[:2])
    met = directions[has_echo] * ranges[has_echo].astype(np.float64)[:, None] + here
    if not has_none.any():
        return Scan(met, met[:0], mounting[:2])
    free = np.maximum(_between_echoes(ranges, has_echo, angle_increment), reading.usable)
    has_none &= free > 0.0
    return Scan(met, directions[has_none] * free[has_none][:, None] + here, mounting[:2])


@functools.lru_cache(maxsize=8)
def _directions(count: int, angle_min: float, angle_increment: float, mounting: Mounting) -> Array:
    """Directions of beams: float64 (count, 2), unit vectors in the frame of the robot."""
    angles = angle_min + angle_increment * np.arange(count)
    if mounting.yaw or mounting.upside_down:
        angles = mounting.yaw + (-angles if mounting.upside_down else angles)
    return np.stack([np.cos(angles), np.sin(angles)], axis=1)


def _between_echoes(ranges: Array, has_echo: Array, angle_increment: float) -> Array:
    """How far the straight line between the echoes beside each beam is [m]: float64 (beams), 0 if there is none.

    Args:
        ranges: float (beams) [m].
        has_echo: bool (beams).
        angle_increment: from beam to beam [rad].
    """
    count, step = len(ranges), abs(angle_increment)
    echoes = np.flatnonzero(has_echo)
    if len(echoes) < 2 or step == 0.0:
        return np.zeros(count)
    turn = round(2.0 * math.pi / step)  # beams in a full turn
    if count >= turn:  # the last echo is beside the first
        echoes = np.concatenate([[echoes[-1] - turn], echoes, [echoes[0] + turn]])
    after = np.searchsorted(echoes, np.arange(count))
    has_both = (after > 0) & (after < len(echoes))
    after = np.where(has_both, after, 1)
    left, right = echoes[after - 1], echoes[after]
    to_left, to_right = (np.arange(count) - left) * step, (right - np.arange(count)) * step
    near, far = ranges[left % count].astype(np.float64), ranges[right % count].astype(np.float64)
    has_both &= (right - left) * step < WIDEST
    across = near * np.sin(to_left) + far * np.sin(to_right)
    return np.where(has_both & (across > 0.0),
                    near * far * np.sin(to_left + to_right) / np.where(across > 0.0, across, 1.0), 0.0)


def told(message: Any, mounting: Mounting = CENTRE, reading: Reading = AS_TOLD) -> Optional[Scan]:
    """What a sensor_msgs/LaserScan tells; None if it cannot be used: `fault` says why."""
    if fault(message) is not None:
        return None
    return scan_of(np.asarray(message.ranges, np.float32), message.angle_min, message.angle_increment,
                   message.range_max, message.range_min, mounting, reading)


def fault(message: Any) -> Optional[str]:
    """Why a sensor_msgs/LaserScan cannot be used; None if it can."""
    for field in ('angle_min', 'angle_increment', 'range_min', 'range_max'):
        if math.isnan(getattr(message, field)) or field.startswith('angle') and math.isinf(getattr(message, field)):
            return f'{field} is {getattr(message, field)}: must be a number'
    if message.range_max <= max(message.range_min, 0.0):
        return f'range_max is {message.range_max:g}: must be above 0 and above range_min, {message.range_min:g}'
    if message.angle_increment == 0.0 and len(message.ranges) > 1:
        return 'angle_increment is 0: must be the angle from beam to beam'
    return None


def is_blind(points: Array) -> bool:
    """Whether so few beams have an echo that they tell nothing."""
    return len(points) < FEWEST


def thinned(points: Array, count: int) -> Array:
    """At most `count` of the points, spread evenly."""
    return points if len(points) <= count else points[_spread(len(points), count)]


@functools.lru_cache(maxsize=1024)
def _spread(length: int, count: int) -> Array:
    """Indices, spread evenly from 0 to length - 1: int64 (count)."""
    return np.linspace(0, length - 1, count).astype(np.int64)
