"""What actions and observations are, as spaces of Gymnasium."""

from typing import Any

import numpy as np

from rumba_evaluation.learning.coverage_task import MOVES
from rumba_evaluation.learning.task_config import DISCRETE, TaskConfig

try:
    import gymnasium
    from gymnasium import spaces
    from gymnasium.vector import AutoresetMode
except ImportError:
    raise ImportError("the learning environment needs Gymnasium 1.1 or later: pip install 'gymnasium>=1.1'") from None

__all__ = ['AutoresetMode', 'actions', 'gymnasium', 'observations']
INFRARED = 9  # each of three receivers tells of three beams


def actions(config: TaskConfig) -> Any:
    """Numbers of moves; or forward velocity, angular velocity and brush, each from -1 to 1."""
    if config.actions == DISCRETE:
        return spaces.Discrete(len(MOVES))
    return spaces.Box(-1.0, 1.0, (3,), np.float32)


def observations(config: TaskConfig) -> Any:
    """What a robot sees, by name; all but the maps are float32.

    ranges: (beams) [0..1] of the range of the laser, counter-clockwise from straight back; 1 if nothing is there.
    bumper: (2) whether the left and the right switch are pressed, 0 or 1.
    cliff: (4) whether there is no floor on the left, front left, front right and right, 0 or 1.
    battery: (1) state of charge [0..1].
    dock: (9) force field, green and red buoy, 0 or 1, as received all around, by the left and by the right receiver.
    odometry: (6) x, y [m], cosine and sine of the heading, v [m/s], w [rad/s], by the encoders, with their drift.
    maps: (2 for each scale, size, size) uint8; if any are wanted. As for `Worlds.surroundings`.
    """
    def box(low: float, high: float, length: int) -> Any:
        return spaces.Box(low, high, (length,), np.float32)
    parts = {'ranges': box(0.0, 1.0, config.beams), 'bumper': box(0.0, 1.0, 2), 'cliff': box(0.0, 1.0, 4),
             'battery': box(0.0, 1.0, 1), 'dock': box(0.0, 1.0, INFRARED), 'odometry': box(-np.inf, np.inf, 6)}
    if config.maps:
        parts['maps'] = spaces.Box(0, 255, (2 * config.maps, config.map_size, config.map_size), np.uint8)
    return spaces.Dict(parts)
