"""A verdict on a robot's run: its conditions and the measured values. The caller supplies time and values.

There are two kinds of conditions:

A goal (coverage, reach, docked) must be met at the end. For coverage the newest value counts. A waypoint that was
reached once counts as reached. For docked, the contacts must be closed after they were open: a robot that never left
its dock has not docked. So `coverage` and `docked` together require that the robot is on its dock after it has cleaned.

A guard (battery, collisions, fields) must hold in every message. If it is violated once, it has failed; the run goes
on nevertheless, so that the verdict covers every condition.

A run begins with the first message. It ends as soon as all goals are met at the same time and each guard has a value,
or when the time limit is reached; without any goal, only at the time limit. Later values are ignored. A condition
without any value has failed, and so has a guard if the run was aborted. If the run is void, all conditions have failed.
"""

import abc
import math
import reprlib
from typing import Any, Callable, List, NamedTuple, Optional, Sequence

from rumba_sim.model.geometry import Pose, wrap_angle


class Condition(abc.ABC):
    """One requirement of a run.

    Attributes:
        name: letters, digits and _, unique among the conditions of a run.
        required: the requirement, in words.
        is_guard: whether it must hold in every message; else it must be met at the end.
        is_measured: whether there was a value.
    """

    is_guard = False

    def __init__(self, name: str, required: str) -> None:
        """There is no value yet."""
        self.name = name
        self.required = required
        self.is_measured = False

    def update(self, value: Any) -> None:
        """Take a measured value."""
        self.is_measured = True
        self._update(value)

    @property
    def is_met(self) -> bool:
        """Whether it is met by the values so far; not without any."""
        return self.is_measured and self._is_met()

    def measured(self) -> str:
        """The measured values, in words."""
        return self._measured() if self.is_measured else 'nothing'

    @abc.abstractmethod
    def _update(self, value: Any) -> None:
        """Take a measured value."""

    @abc.abstractmethod
    def _is_met(self) -> bool:
        """Whether it is met by the values so far, of which there is at least one."""

    @abc.abstractmethod
    def _measured(self) -> str:
        """The values, in words; there is at least one."""


class Coverage(Condition):
    """A share of the floor is swept; the values are shares [0..1]."""

    def __init__(self, least: float) -> None:
        """Require a share [0..1]."""
        super().__init__('coverage', f'at least {100.0 * least:.1f} % of the floor swept')
        self._least = least
        self._newest = math.nan

    def _update(self, value: float) -> None:
        self._newest = value

    def _is_met(self) -> bool:
        return self._newest >= self._least

    def _measured(self) -> str:
        return f'{100.0 * self._newest:.1f} %'


class Reach(Condition):
    """The robot was at a waypoint once; the values are poses in the map frame."""

    def __init__(self, name: str, waypoint: Pose, distance: float, angle: float) -> None:
        """Require a waypoint within a distance [m] and an angle [rad]; a heading of NaN allows any."""
        any_heading = math.isnan(waypoint.theta)
        heading = '' if any_heading else f' and heading {waypoint.theta:.2f} rad within {angle:.2f} rad'
        super().__init__(name, f'to reach ({waypoint.x:.2f}, {waypoint.y:.2f}) m within {distance:.2f} m{heading}')
        self._waypoint, self._distance, self._angle = waypoint, distance, angle
        self._nearest, self._least_error = math.inf, math.inf  # [m], and of the heading within the distance [rad]
        self._is_reached = False

    def _update(self, value: Pose) -> None:
        waypoint = self._waypoint
        distance = math.hypot(value.x - waypoint.x, value.y - waypoint.y)
        error = 0.0 if math.isnan(waypoint.theta) else abs(wrap_angle(value.theta - waypoint.theta))
        self._nearest = min(self._nearest, distance)
        if distance <= self._distance:
            self._least_error = min(self._least_error, error)
            self._is_reached = self._is_reached or error <= self._angle

    def _is_met(self) -> bool:
        return self._is_reached

    def _measured(self) -> str:
        if self._is_reached or math.isinf(self._least_error):
            return f'a smallest distance of {self._nearest:.2f} m'
        return f'the position, with a smallest error of the heading of {self._least_error:.2f} rad'


class Docked(Condition):
    """The robot has come to its dock; the values tell whether the contacts are closed."""

    def __init__(self) -> None:
        """The contacts have not been open yet."""
        super().__init__('docked', 'to come to the dock')
        self._is_docked = self._was_off = False

    def _update(self, value: bool) -> None:
        self._is_docked = value
        self._was_off = self._was_off or not value

    def _is_met(self) -> bool:
        return self._is_docked and self._was_off

    def _measured(self) -> str:
        if not self._is_docked:
            return 'off the dock'
        return 'on the dock' if self._was_off else 'on the dock, which it never left'


class Battery(Condition):
    """The charge never falls below a limit; the values are charges [%]."""

    is_guard = True

    def __init__(self, least: float) -> None:
        """Require a charge [%]."""
        super().__init__('battery', f'never less than {least:.1f} % of charge')
        self._least = least
        self._lowest = math.inf

    def update(self, value: float) -> None:
        """Take a charge [%]; one that is not finite (not measured) is ignored."""
        if math.isfinite(value):
            super().update(value)

    def _update(self, value: float) -> None:
        self._lowest = min(self._lowest, value)

    def _is_met(self) -> bool:
        return self._lowest >= self._least

    def _measured(self) -> str:
        return f'a lowest charge of {self._lowest:.1f} %'


class Collisions(Condition):
    """The number of collisions is limited; the values tell whether the bumper is pressed."""

    is_guard = True

    def __init__(self, most: int) -> None:
        """Allow a number of collisions; a bumper that stays pressed is one collision."""
        super().__init__('collisions', f'at most {most} collision{"" if most == 1 else "s"}')
        self._most = most
        self._count = 0
        self._is_pressed = False

    def _update(self, value: bool) -> None:
        self._count += value and not self._is_pressed
        self._is_pressed = value

    def _is_met(self) -> bool:
        return self._count <= self._most

    def _measured(self) -> str:
        return str(self._count)


class Field(Condition):
    """A field of a topic stays within a range, both ends allowed; the values are those of the field."""

    is_guard = True

    def __init__(self, path: str, low: float, high: float) -> None:
        """Require a range of the field at a path such as `rumba/battery_state/voltage`."""
        super().__init__('field_' + ''.join(letter if letter.isalnum() else '_' for letter in path.strip('/')),
                         f'{path} always within {low:g} to {high:g}')
        self.path = path
        self._low, self._high = low, high
        self._lowest, self._highest = math.inf, -math.inf
        self._problem = ''

    def _update(self, value: Any) -> None:
        is_number = isinstance(value, (bool, int, float)) and not math.isnan(value)
        if is_number:
            self._lowest, self._highest = min(self._lowest, value), max(self._highest, value)
        elif not self._problem:
            self._problem = f'{reprlib.repr(value)}, which is not a number'

    def _is_met(self) -> bool:
        return not self._problem and self._low <= self._lowest and self._highest <= self._high

    def _measured(self) -> str:
        return self._problem or f'{self._lowest:g} to {self._highest:g}'


class Verdict(NamedTuple):
    """The verdict on one condition."""

    name: str
    is_met: bool
    words: str


class Judge:
    """Judges one run.

    Attributes:
        conditions: all conditions of the run.
        is_over: whether the verdicts are final.
    """

    def __init__(self, conditions: Sequence[Condition], time_limit: float) -> None:
        """The run has not begun; `time_limit` [s] is of the same clock as the times that the caller gives."""
        self.conditions = list(conditions)
        self.is_over = False
        self._time_limit = time_limit
        self._began: Optional[float] = None
        self._passed = 0.0
        self._is_complete = self._is_void = False
        self._reason = ''

    def update(self, condition: Condition, value: Any, now: float) -> None:
        """Take a value of one of the conditions, measured at a time [s]."""
        self.check_time(now)
        if self.is_over:
            return
        if self._began is None:
            self._began = now
        condition.update(value)
        goals = [one for one in self.conditions if not one.is_guard]
        if goals and all(one.is_met for one in goals) and all(one.is_measured for one in self.conditions):
            self._end('', is_complete=True)

    def check_time(self, now: float) -> None:
        """End the run if the time [s] has reached the limit, or has gone back."""
        if self.is_over or self._began is None:
            return
        if now - self._began < self._passed:  # as it is computed below: a sum would differ by rounding
            self.annul(f'the time went back from {self._began + self._passed:.1f} s to {now:.1f} s')
            return
        self._passed = now - self._began
        if self._passed >= self._time_limit:
            self._passed = self._time_limit
            self._end('the time limit is reached', is_complete=True)

    def abort(self, reason: str) -> None:
        """End the run early, for a reason in words."""
        if not self.is_over:
            self._end(reason, is_complete=False)

    def annul(self, reason: str) -> None:
        """Make the run void, also one that is over, for a reason in words."""
        if not self._is_void:
            self._is_void = True
            self._end('; '.join(filter(None, (self._reason, reason))), is_complete=False)

    def _end(self, reason: str, is_complete: bool) -> None:
        self.is_over, self._reason, self._is_complete = True, reason, is_complete

    def verdicts(self, source: Callable[[Condition], str]) -> List[Verdict]:
        """The verdict on each condition; `source` gives the topics from which its values come."""
        return [self._verdict(condition, source) for condition in self.conditions]

    def _verdict(self, condition: Condition, source: Callable[[Condition], str]) -> Verdict:
        is_met = condition.is_met and (self._is_complete or not condition.is_guard) and not self._is_void
        topics = '' if condition.is_measured else f' on {source(condition)}'
        reason = f': {self._reason}' if self._reason else ''
        return Verdict(condition.name, is_met,
                       f'{condition.name}: required {condition.required}; measured {condition.measured()}{topics} '
                       f'after {self._passed:.1f} s of {self._time_limit:g} s{reason}')
