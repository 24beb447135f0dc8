"""What keys do to the command; knows neither ROS nor the clock."""

import math
from typing import Optional, Tuple

from rumba_sim.ros.common.teleop import ANGULAR_RANGE, LINEAR_RANGE
from rumba_sim.ros.teleop_key.settings import Settings

# Shares of the linear and of the angular speed, and a name for people. The key m drives back along the arc of u.
FORWARD, BACKWARD = (1, 0, 'forward'), (-1, 0, 'backward')
LEFT, RIGHT, STOP = (0, 1, 'turn left'), (0, -1, 'turn right'), (0, 0, 'stop')
MOVES = {
    'u': (1, 1, 'forward left'), 'i': FORWARD, 'o': (1, -1, 'forward right'),
    'j': LEFT, 'k': STOP, 'l': RIGHT,
    'm': (-1, -1, 'backward left'), ',': BACKWARD, '.': (-1, 1, 'backward right'),
    'up': FORWARD, 'down': BACKWARD, 'left': LEFT, 'right': RIGHT,
}
# Factors of the linear and of the angular speed.
SPEEDS = {'q': (1.1, 1.1), 'z': (0.9, 0.9), 'w': (1.1, 1.0), 'x': (0.9, 1.0), 'e': (1.0, 1.1), 'c': (1.0, 0.9)}
ZEROS = 3  # commands to stop: a single one could get lost on a poor connection


class Driver:
    """Turns keys into commands.

    Attributes:
        linear, angular: speeds at which a key drives [m/s], [rad/s].
        until: the time until which the last move key counts [s].
    """

    def __init__(self, settings: Settings) -> None:
        """Start without a command, at the speeds of the settings."""
        self.linear = settings.linear
        self.angular = settings.angular
        self.until = -math.inf
        self._hold = settings.hold
        self._move = STOP
        self._zeros_left = 0

    @property
    def doing(self) -> str:
        """The present command, in words."""
        return self._move[-1]

    def press(self, key: str, now: float) -> bool:
        """Take a key at time `now` [s]: a speed key sets speeds, every other key starts a move or stops.

        Returns:
            Whether the command changes, so that it should be published at once.
        """
        if key in SPEEDS:
            linear, angular = SPEEDS[key]
            self.linear = _clamp(self.linear * linear, LINEAR_RANGE)
            self.angular = _clamp(self.angular * angular, ANGULAR_RANGE)
            return False
        before, self._move = self._move, MOVES.get(key, STOP)
        self.until = now + self._hold
        self._zeros_left = ZEROS
        return self._move != before or self._move is STOP

    def forget(self) -> None:
        """Forget the last key, and publish nothing more; the caller must stop the robot."""
        self.until, self._move, self._zeros_left = -math.inf, STOP, 0

    def command(self, now: float) -> Optional[Tuple[float, float]]:
        """What to publish now [m/s], [rad/s]: the move while its key counts, then zero a few times, then nothing."""
        if now >= self.until:
            self._move = STOP
            if self._zeros_left == 0:
                return None
            self._zeros_left -= 1
        linear, angular, _ = self._move
        return linear * self.linear, angular * self.angular


def _clamp(value: float, limits: Tuple[float, float]) -> float:
    low, high = limits
    return min(max(value, low), high)
