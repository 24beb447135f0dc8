"""How particles follow the odometry."""

import math

import numpy as np

from rumba_localisation.localiser_config import LocaliserConfig
from rumba_sim.model.common.geometry import Pose, wrap_angle
from rumba_sim.model.kernel import Array

STRAIGHT = 0.01  # [m] a shorter way has no direction that could be told from noise


def noise(count: int, generator: np.random.Generator) -> Array:
    """Errors of the first turn, the way and the last turn of so many particles: float64 (3, count), standard normal."""
    return generator.standard_normal((3, count))


def moved(poses: Array, before: Pose, after: Pose, config: LocaliserConfig, errors: Array) -> Array:
    """Sample where a robot is after a movement, for each pose where it may have been.

    Probabilistic Robotics (Thrun, Burgard, Fox 2005), table 5.6: a turn, a straight way, a turn, each with an error.

    Args:
        poses: float64 (any, 3), x, y [m] and heading [rad].
        before, after: poses by odometry.
        errors: as of `noise`. Those of a scale, as of a carpet or a worn wheel, are the same from movement to movement:
            with the same errors the deviation of a way in parts is that of the whole, and grows with its length.

    Returns:
        float64 (any, 3), new.
    """
    distance = math.hypot(after.x - before.x, after.y - before.y)
    turn = wrap_angle(after.theta - before.theta)
    first = wrap_angle(math.atan2(after.y - before.y, after.x - before.x) - before.theta) if distance > STRAIGHT else (
        0.5 * turn)
    if abs(first) > 0.5 * math.pi:  # backwards
        first, distance = wrap_angle(first + math.pi), -distance
    last = wrap_angle(turn - first)
    way = distance + errors[1] * math.sqrt(
        config.odom_alpha3 * distance ** 2 + config.odom_alpha4 * (first ** 2 + last ** 2))
    heading = poses[:, 2] + first + errors[0] * _deviation(first, distance, config)
    return np.stack([poses[:, 0] + way * np.cos(heading), poses[:, 1] + way * np.sin(heading),
                     heading + last + errors[2] * _deviation(last, distance, config)], axis=1)


def _deviation(turn: float, distance: float, config: LocaliserConfig) -> float:
    """Standard deviation of a turn [rad]: half the variance that comes from driving, since there are two turns."""
    return math.sqrt(config.odom_alpha1 * turn ** 2 + 0.5 * config.odom_alpha2 * distance ** 2)
