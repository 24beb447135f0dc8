"""A verdict on a robot's run: what is asked of it, and what was measured. The caller owns time and topics.

Two kinds of conditions:

A goal (coverage, reach, docked) is to be met. The coverage that counts is the newest; a place that was reached stays
reached, whatever comes later; docked is a robot whose contacts are closed, after they were open: one that never left
its dock has not docked. So `coverage` and `docked` together ask for a robot that is on its dock after it cleaned.

A guard (battery, collisions, fields) must hold in every message. What broke it once broke it for good; the run goes
on all the same, so that the verdict tells of every condition.

A run begins with the first message. It is over as soon as all goals are met at once, with every guard heard at least
once, or when the time is up; without any goal, when the time is up. What comes later counts no more. A condition of
which nothing was heard is not met, nor is a guard that could not be judged to the end.
"""

import abc
import math
from typing import Any, Callable, List, NamedTuple, Optional, Sequence

from rumba_sim.model.geometry import Pose, wrap_angle


class Condition(abc.ABC):
    """One thing that is asked of a run.

    Attributes:
        name: letters, digits and _, unique among the conditions of a run.
        asked: what is asked, in words.
        is_guard: whether it must hold throughout, not once.
        is_heard: whether anything was measured.
    """

    is_guard = False

    def __init__(self, name: str, asked: str) -> None:
        """Nothing is measured yet."""
        self.name = name
        self.asked = asked
        self.is_heard = False

    def hear(self, value: Any) -> None:
        """Take a measured value."""
        self.is_heard = True
        self._take(value)

    @property
    def is_met(self) -> bool:
        """Whether it is met, by what was heard until now."""
        return self.is_heard and self._is_met()

    def measured(self) -> str:
        """What was measured, in words."""
        return self._measured() if self.is_heard else 'nothing'

    @abc.abstractmethod
    def _take(self, value: Any) -> None:
        """Take a measured value."""

    @abc.abstractmethod
    def _is_met(self) -> bool:
        """Whether it is met, by the values taken."""

    @abc.abstractmethod
    def _measured(self) -> str:
        """The values taken, in words."""


class Coverage(Condition):
    """So much of the floor is swept; hears shares [0..1]."""

    def __init__(self, least: float) -> None:
        """Ask for a share [0..1]."""
        super().__init__('coverage', f'at least {100.0 * least:.1f} % of the floor swept')
        self._least = least
        self._newest = math.nan

    def _take(self, value: float) -> None:
        self._newest = value

    def _is_met(self) -> bool:
        return self._newest >= self._least

    def _measured(self) -> str:
        return f'{100.0 * self._newest:.1f} %'


class Reach(Condition):
    """The robot was at a pose once; hears poses in the map frame."""

    def __init__(self, name: str, target: Pose, distance: float, angle: float) -> None:
        """Ask for a target within a distance [m] and an angle [rad]; a heading of NaN is any."""
        heading = '' if math.isnan(target.theta) else f' and heading {target.theta:.2f} rad within {angle:.2f} rad'
        super().__init__(name, f'to reach ({target.x:.2f}, {target.y:.2f}) m within {distance:.2f} m{heading}')
        self._target, self._distance, self._angle = target, distance, angle
        self._nearest, self._off = math.inf, math.inf
        self._is_reached = False

    def _take(self, value: Pose) -> None:
        distance = math.hypot(value.x - self._target.x, value.y - self._target.y)
        off = 0.0 if math.isnan(self._target.theta) else abs(wrap_angle(value.theta - self._target.theta))
        self._nearest = min(self._nearest, distance)
        if distance <= self._distance:
            self._off = min(self._off, off)
            self._is_reached = self._is_reached or off <= self._angle

    def _is_met(self) -> bool:
        return self._is_reached

    def _measured(self) -> str:
        if self._is_reached or math.isinf(self._off):
            return f'{self._nearest:.2f} m from it at the nearest'
        return f'there, with a heading {self._off:.2f} rad off at the least'


class Docked(Condition):
    """The robot is on its dock, to which it came; hears whether the contacts are closed."""

    def __init__(self) -> None:
        """Nothing is known of its past."""
        super().__init__('docked', 'to come to the dock')
        self._is_docked = self._was_off = False

    def _take(self, value: bool) -> None:
        self._is_docked = value
        self._was_off = self._was_off or not value

    def _is_met(self) -> bool:
        return self._is_docked and self._was_off

    def _measured(self) -> str:
        if not self._is_docked:
            return 'off the dock'
        return 'on the dock' if self._was_off else 'on the dock, which it never left'


class Battery(Condition):
    """The charge never falls below a limit; hears charges [%]."""

    is_guard = True

    def __init__(self, least: float) -> None:
        """Ask for a charge [%]."""
        super().__init__('battery', f'never less than {least:.1f} % of charge')
        self._least = least
        self._lowest = math.inf

    def hear(self, value: float) -> None:
        """Take a charge [%]; NaN is none, not measured."""
        if not math.isnan(value):
            super().hear(value)

    def _take(self, value: float) -> None:
        self._lowest = min(self._lowest, value)

    def _is_met(self) -> bool:
        return self._lowest >= self._least

    def _measured(self) -> str:
        return f'{self._lowest:.1f} % at the least'


class Collisions(Condition):
    """The bumper is pressed anew no more often than allowed; hears whether it is pressed."""

    is_guard = True

    def __init__(self, most: int) -> None:
        """Allow so many."""
        super().__init__('collisions', f'at most {most} collision{"" if most == 1 else "s"}')
        self._most = most
        self._count = 0
        self._is_pressed = False

    def _take(self, value: bool) -> None:
        self._count += value and not self._is_pressed
        self._is_pressed = value

    def _is_met(self) -> bool:
        return self._count <= self._most

    def _measured(self) -> str:
        return str(self._count)


class Field(Condition):
    """A field of a topic stays within a range, both ends allowed; hears numbers."""

    is_guard = True

    def __init__(self, path: str, low: float, high: float) -> None:
        """Ask for a range of the field at a path, as in `rumba/battery_state/voltage`."""
        super().__init__('field_' + ''.join(letter if letter.isalnum() else '_' for letter in path.strip('/')),
                         f'{path} always within {low:g} to {high:g}')
        self.path = path
        self._low, self._high = low, high
        self._lowest, self._highest = math.inf, -math.inf
        self._trouble = ''

    def _take(self, value: Any) -> None:
        number = isinstance(value, (bool, int, float)) and not math.isnan(value)
        if number:
            self._lowest, self._highest = min(self._lowest, value), max(self._highest, value)
        elif not self._trouble:
            self._trouble = f'{value!r}, which is no number'

    def _is_met(self) -> bool:
        return not self._trouble and self._low <= self._lowest and self._highest <= self._high

    def _measured(self) -> str:
        return self._trouble or f'{self._lowest:g} to {self._highest:g}'


class Verdict(NamedTuple):
    """What is said of one condition."""

    name: str
    is_met: bool
    words: str


class Judge:
    """Judges one run.

    Attributes:
        conditions: all that is asked.
        is_over: whether the verdicts are final.
    """

    def __init__(self, conditions: Sequence[Condition], time_limit: float) -> None:
        """The run has not begun; it may take so long [s], of the time that the caller tells."""
        self.conditions = list(conditions)
        self.is_over = False
        self._time_limit = time_limit
        self._began: Optional[float] = None
        self._passed = 0.0
        self._is_complete = False
        self._reason = ''

    def hear(self, condition: Condition, value: Any, now: float) -> None:
        """Take a value for one of the conditions, measured at a time [s] that never runs backward."""
        self.look(now)
        if self.is_over:
            return
        if self._began is None:
            self._began = now
        condition.hear(value)
        goals = [one for one in self.conditions if not one.is_guard]
        if goals and all(one.is_met for one in goals) and all(one.is_heard for one in self.conditions):
            self._end('', is_complete=True)

    def look(self, now: float) -> None:
        """See whether the time [s] is up."""
        if self.is_over or self._began is None:
            return
        self._passed = now - self._began
        if self._passed >= self._time_limit:
            self._passed = self._time_limit
            self._end('the time was up', is_complete=True)

    def give_up(self, reason: str) -> None:
        """The run ends early, for a reason in words."""
        if not self.is_over:
            self._end(reason, is_complete=False)

    def _end(self, reason: str, is_complete: bool) -> None:
        self.is_over, self._reason, self._is_complete = True, reason, is_complete

    def verdicts(self, source: Callable[[Condition], str]) -> List[Verdict]:
        """What is to be said of each condition; `source` names where its values should have come from."""
        return [self._verdict(condition, source) for condition in self.conditions]

    def _verdict(self, condition: Condition, source: Callable[[Condition], str]) -> Verdict:
        is_met = condition.is_met and (self._is_complete or not condition.is_guard)
        silence = '' if condition.is_heard else f' on {source(condition)}'
        reason = f': {self._reason}' if self._reason else ''
        return Verdict(condition.name, is_met,
                       f'{condition.name}: asked {condition.asked}; measured {condition.measured()}{silence} '
                       f'after {self._passed:.1f} s of {self._time_limit:g} s{reason}')
