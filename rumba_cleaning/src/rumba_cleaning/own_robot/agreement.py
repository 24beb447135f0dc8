"""Whether a robot does what it is commanded, by its odometry."""

import collections
import math
from typing import Deque, NamedTuple, Optional

from rumba_sim.model.geometry import Pose, hypot, wrap_angle

WINDOW = 3.0  # [s] over which movements are compared; a robot answers a command much sooner
TURN, WAY = 0.6, 0.2  # [rad], [m] that must be commanded in that time to tell anything
OPPOSED = 0.3  # share of it that the odometry must tell in the opposite direction
STILL = 0.05  # share of it that an odometry tells at most that does not move
LONGEST = 1.0  # [s] between two messages; after more, the comparison begins anew

TURNS_BACK = 'odometry turns the other way than commanded'
GOES_BACK = 'odometry goes the other way than commanded'
STANDS = 'odometry does not move although the robot is commanded to'


class _Step(NamedTuple):
    until: float  # [s]
    asked_turn: float  # [rad]
    asked_way: float  # [m], forward
    turn: float
    way: float
    moved: float  # [m] in any direction


class Agreement:
    """Compares what was commanded with what the odometry tells."""

    def __init__(self) -> None:
        """Nothing is known."""
        self._v = self._w = 0.0
        self._last: Optional[Pose] = None
        self._when = 0.0
        self._steps: Deque[_Step] = collections.deque()

    def command(self, v: float, w: float) -> None:
        """A velocity is commanded, [m/s] and [rad/s], until the next one."""
        self._v, self._w = v, w

    def observe(self, pose: Pose, now: float) -> str:
        """Where the robot is by odometry, at a time [s]; returns what is wrong, or an empty text."""
        last, dt = self._last, now - self._when
        self._last, self._when = pose, now
        if last is None or not 0.0 < dt <= LONGEST:
            self._steps.clear()
            return ''
        dx, dy = pose.x - last.x, pose.y - last.y
        self._steps.append(_Step(now, self._w * dt, self._v * dt, wrap_angle(pose.theta - last.theta),
                                 _along(dx, dy, last.theta), hypot(dx, dy)))
        while self._steps[0].until < now - WINDOW:
            self._steps.popleft()
        return self._verdict()

    def _verdict(self) -> str:
        asked_turn, asked_way, turn, way, moved = (sum(part) for part in list(zip(*self._steps))[1:])
        turned, driven = abs(asked_turn) > TURN, abs(asked_way) > WAY
        if turned and turn * asked_turn < -OPPOSED * asked_turn ** 2:
            return TURNS_BACK
        if driven and not turned and way * asked_way < -OPPOSED * asked_way ** 2:
            return GOES_BACK
        if (turned or driven) and abs(turn) <= STILL * abs(asked_turn) + 1e-9 and (
                moved <= STILL * abs(asked_way) + 1e-9):
            return STANDS
        return ''


def _along(dx: float, dy: float, theta: float) -> float:
    return dx * math.cos(theta) + dy * math.sin(theta)
