"""A controller that makes a turtle draw a square, from the pose of the turtle alone."""

import math
from typing import Optional, Tuple

SIDE = 2.0  # [m]
SPEED, TURN_RATE = 1.0, 0.4 * math.pi  # [m/s], [rad/s] at most
GAIN = 4.0  # [1/s] speed per distance to the end of a side or turn, so that a late command does no harm
SLOWEST = 0.05  # share of SPEED and TURN_RATE that is never undercut, so that the turtle arrives
NEAR, ALIGNED = 0.005, 0.002  # [m], [rad] that count as arrived


class Square:
    """Drives a side, then a quarter turn to the left, and so on; knows neither ROS nor the clock."""

    def __init__(self) -> None:
        """Start with a side at the first pose."""
        self._start: Optional[Tuple[float, float, float]] = None
        self._is_turning = False

    def command(self, x: float, y: float, theta: float) -> Tuple[float, float]:
        """Return the command at x, y [m], theta [rad]: speed forward [m/s] and turn rate [rad/s]."""
        if self._start is None:
            self._start = x, y, theta
        left = self._left(x, y, theta)
        if left < (ALIGNED if self._is_turning else NEAR):
            self._start = x, y, theta
            self._is_turning = not self._is_turning
            left = self._left(x, y, theta)
        limit = TURN_RATE if self._is_turning else SPEED
        rate = limit * min(1.0, max(SLOWEST, GAIN * left / limit))
        return (0.0, rate) if self._is_turning else (rate, 0.0)

    def _left(self, x: float, y: float, theta: float) -> float:
        """Return what is left of this side [m] or turn [rad]; negative if the turtle went too far."""
        assert self._start is not None
        from_x, from_y, from_theta = self._start
        if self._is_turning:
            return 0.5 * math.pi - math.remainder(theta - from_theta, 2.0 * math.pi)
        return SIDE - ((x - from_x) * math.cos(from_theta) + (y - from_y) * math.sin(from_theta))
