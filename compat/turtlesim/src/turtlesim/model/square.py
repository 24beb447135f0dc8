"""A controller that has a turtle draw a square, from its pose alone."""

import math
from typing import Optional, Tuple

SIDE = 2.0  # [m]
SPEED, TURN_RATE = 1.0, 0.4 * math.pi  # [m/s], [rad/s] at most
GAIN = 4.0  # [1/s] slower the nearer the goal is, so that a late command does no harm
SLOWEST = 0.05  # of the above: it arrives
NEAR, ALIGNED = 0.005, 0.002  # [m], [rad] that count as arrived


class Square:
    """Turns of forward and a quarter turn to the left, for ever; knows neither ROS nor the clock."""

    def __init__(self) -> None:
        """Begin with a side, from wherever the turtle is."""
        self._start: Optional[Tuple[float, float, float]] = None
        self._is_turning = False

    def command(self, x: float, y: float, theta: float) -> Tuple[float, float]:
        """What to do at x, y [m], theta [rad]: speed forward [m/s] and turn rate [rad/s]."""
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
        """How far it is to the end of this side [m], or of this turn [rad]; negative where it went too far."""
        assert self._start is not None
        from_x, from_y, from_theta = self._start
        if self._is_turning:
            return 0.5 * math.pi - math.remainder(theta - from_theta, 2.0 * math.pi)
        return SIDE - ((x - from_x) * math.cos(from_theta) + (y - from_y) * math.sin(from_theta))
