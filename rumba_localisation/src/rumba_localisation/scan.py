"""What a laser tells, as points."""

import functools
import math
from typing import Any, NamedTuple, Optional

import numpy as np

from rumba_sim.model.kernel import Array

FEWEST = 10  # beams with an echo, fewer tell nothing
SILENT = 1.0  # [s] of the time of a robot without a scan, from which on its laser is silent: five scans at 5 Hz


class Scan(NamedTuple):
    """What a laser tells at one moment, in its own frame [m]."""

    points: Array  # float64 (any, 2), where beams with an echo end
    beyond: Array  # float64 (any, 2), as far as beams without an echo reach


def points(ranges: Array, angle_min: float, angle_increment: float) -> Array:
    """Where the beams of a scan that have an echo end, in the frame of the laser: float64 (any, 2) [m].

    Args:
        ranges: float (beams) [m]; an infinite one has no echo (REP 117).
        angle_min: direction of the first beam [rad].
        angle_increment: from beam to beam [rad].
    """
    has_echo = np.isfinite(ranges)
    return _directions(len(ranges), angle_min, angle_increment)[has_echo] * ranges[has_echo].astype(np.float64)[:, None]


@functools.lru_cache(maxsize=8)
def _directions(count: int, angle_min: float, angle_increment: float) -> Array:
    """Directions of beams: float64 (count, 2), unit vectors in the frame of the laser."""
    angles = angle_min + angle_increment * np.arange(count)
    return np.stack([np.cos(angles), np.sin(angles)], axis=1)


def scan_of(ranges: Array, angle_min: float, angle_increment: float, range_max: float) -> Scan:
    """A scan, by its ranges.

    Args:
        ranges: float (beams) [m]; +inf has no echo, -inf one that is too near (REP 117).
        angle_min: direction of the first beam [rad].
        angle_increment: from beam to beam [rad].
        range_max: up to which a beam without an echo met nothing [m].
    """
    met = points(ranges, angle_min, angle_increment)
    has_none = ranges == math.inf
    if not has_none.any():
        return Scan(met, met[:0])
    return Scan(met, points(np.where(has_none, range_max, np.nan), angle_min, angle_increment))


def told(message: Any) -> Optional[Scan]:
    """What a sensor_msgs/LaserScan tells; None if its angles or its range are no numbers."""
    if not all(map(math.isfinite, (message.angle_min, message.angle_increment, message.range_max))):
        return None
    return scan_of(np.asarray(message.ranges, np.float32), message.angle_min, message.angle_increment,
                   message.range_max)


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
