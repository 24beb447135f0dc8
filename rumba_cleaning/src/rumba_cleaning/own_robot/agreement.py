"""Whether a robot does what it is commanded, by its odometry."""

import collections
import math
from typing import Deque, NamedTuple, Optional

from rumba_sim.model.common.geometry import Pose, wrap_angle

WINDOW = 3.0  # [s] over which movements are compared
SETTLED = 0.8  # [s] after a command changed its sign, from which on it is compared: robots lag, and brake first
TURN, WAY = 0.6, 0.2  # [rad], [m] that must be commanded in that time to tell anything
OPPOSED = 0.3  # share of it that the odometry must tell in the opposite direction
STILL = 0.05  # share of it that an odometry tells at most that does not move
LONGEST = 1.0  # [s] between two messages; after more, the comparison starts again

TURNS_BACK = 'odometry turns the other way than commanded'
GOES_BACK = 'odometry goes the other way than commanded'
STANDS = 'odometry does not move although the robot is commanded to'


class _Step(NamedTuple):
    until: float  # [s]
    asked: float  # [m] or [rad]
    told: float


class _Axis:
    """One kind of movement: what was commanded and what the odometry told, while the command kept its sign."""

    def __init__(self, least: float) -> None:
        self._least = least  # that must be commanded
        self._rate = 0.0
        self._since: Optional[float] = None  # [s] when the sign changed; None: at the next step
        self._steps: Deque[_Step] = collections.deque()

    def command(self, rate: float) -> None:
        if rate * self._rate <= 0.0:
            self.begin()
        self._rate = rate

    def begin(self) -> None:
        self._since = None
        self._steps.clear()

    def add(self, dt: float, told: float, now: float) -> None:
        self._since = now if self._since is None else self._since
        if now - self._since > SETTLED:
            self._steps.append(_Step(now, self._rate * dt, told))
            while self._steps[0].until < now - WINDOW:
                self._steps.popleft()

    @property
    def tells(self) -> bool:
        return abs(sum(step.asked for step in self._steps)) > self._least

    @property
    def is_opposed(self) -> bool:
        return self._share() < -OPPOSED

    @property
    def is_still(self) -> bool:
        return abs(self._share()) < STILL

    def _share(self) -> float:
        """What was told / what was commanded; 1 if that was too little to tell anything."""
        if not self.tells:
            return 1.0
        return sum(step.told for step in self._steps) / sum(step.asked for step in self._steps)


class Agreement:
    """Compares what was commanded with what the odometry tells.

    Attributes:
        is_tested: whether turns were commanded for long enough to tell anything of them.
    """

    def __init__(self) -> None:
        """Nothing is known."""
        self._turn, self._way = _Axis(TURN), _Axis(WAY)
        self._last: Optional[Pose] = None
        self._when = 0.0
        self.is_tested = False

    def command(self, v: float, w: float) -> None:
        """A velocity is commanded, [m/s] and [rad/s], until the next one."""
        self._way.command(v)
        self._turn.command(w)

    def observe(self, pose: Pose, now: float) -> str:
        """Where the robot is by odometry, at a time [s]; returns what is wrong, or an empty text."""
        last, dt = self._last, now - self._when
        self._last, self._when = pose, now
        if last is None or not 0.0 < dt <= LONGEST:
            self._turn.begin()
            self._way.begin()
            return ''
        middle = last.theta + 0.5 * wrap_angle(pose.theta - last.theta)
        self._turn.add(dt, wrap_angle(pose.theta - last.theta), now)
        self._way.add(dt, (pose.x - last.x) * math.cos(middle) + (pose.y - last.y) * math.sin(middle), now)
        self.is_tested |= self._turn.tells
        if self._turn.is_opposed:
            return TURNS_BACK
        if self._way.is_opposed:
            return GOES_BACK
        return STANDS if self._turn.is_still or self._way.is_still else ''
