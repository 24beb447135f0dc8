"""What can be required of any fields of any topics, such as those of the node that is marked. All are guards."""

import math
import reprlib
from typing import Any, List, Tuple

from rumba_evaluation.verdicts.conditions import Condition


class FieldCondition(Condition):
    """A condition on fields.

    Attributes:
        paths: of the fields, such as `rumba/battery_state/voltage`; a topic alone stands for whole messages.
    """

    is_guard = True

    def __init__(self, kind: str, paths: List[str], required: str) -> None:
        """Require something of the fields at these paths."""
        name = ''.join(letter if letter.isalnum() else '_' for letter in paths[0].strip('/'))
        super().__init__(f'{kind}{name}', required)
        self.paths = paths

    def reading(self, number: int, value: Any) -> Any:
        """The value for `update`, if the field of that number, from 0 on, has a value."""
        return value


class Field(FieldCondition):
    """A field of a topic stays within a range, both ends allowed; the values are those of the field."""

    def __init__(self, path: str, low: float, high: float) -> None:
        """Require a range of the field at a path such as `rumba/battery_state/voltage`."""
        super().__init__('field_', [path], f'{path} always within {low:g} to {high:g}')
        self._low, self._high = low, high
        self._lowest, self._highest = math.inf, -math.inf
        self._count = self._inside = 0
        self._problem = ''

    def _update(self, value: Any) -> None:
        is_number = _is_number(value)
        if is_number:
            self._lowest, self._highest = min(self._lowest, value), max(self._highest, value)
            self._inside += self._low <= value <= self._high
        elif not self._problem:
            self._problem = f'{reprlib.repr(value)}, which is not a number'
        self._count += 1

    def _is_met(self) -> bool:
        return not self._problem and self._low <= self._lowest and self._highest <= self._high

    def figures(self) -> Tuple[float, float]:
        """The share of the values that are in the range."""
        return self._inside / max(self._count, 1), 1.0

    def _measured(self) -> str:
        return self._problem or f'{self._lowest:g} to {self._highest:g}'


class Agreement(FieldCondition):
    """Each value of a field is near to the newest one of another field; the values are pairs of number and value."""

    def __init__(self, path: str, other: str, tolerance: float) -> None:
        """Require that the field at a path differs at most by the tolerance from the other one."""
        super().__init__('agree_', [path, other], f'{path} within {tolerance:g} of {other}')
        self._tolerance = tolerance
        self._other = math.nan
        self._count = self._inside = 0
        self._worst = 0.0

    def reading(self, number: int, value: Any) -> Any:
        """The number of the field, and its value."""
        return number, value

    def update(self, value: Tuple[int, Any]) -> None:
        """Take a value of one of the fields; before the other one has any, there is nothing to compare."""
        number, newest = value
        if number == 1:
            self._other = newest if _is_number(newest) else math.nan
        elif not math.isnan(self._other):
            super().update(newest)

    def _update(self, value: Any) -> None:
        difference = abs(value - self._other) if _is_number(value) else math.inf
        self._worst = max(self._worst, difference)
        self._inside += difference <= self._tolerance
        self._count += 1

    def _is_met(self) -> bool:
        return self._inside == self._count

    def figures(self) -> Tuple[float, float]:
        """The share of the values that agree."""
        return self._inside / max(self._count, 1), 1.0

    def _measured(self) -> str:
        return f'{self._inside} of {self._count} values, a largest difference of {self._worst:g}'


class Rate(FieldCondition):
    """Messages come so often, on average over the whole run; the values are messages."""

    def __init__(self, topic: str, low: float, high: float) -> None:
        """Require a rate [Hz], in the time of the robot."""
        super().__init__('rate_', [topic], f'{topic} at {low:g} to {high:g} Hz')
        self._low, self._high = low, high
        self._count = 0
        self._duration = 0.0

    def finish(self, duration: float) -> None:
        """The run has ended after a time [s]."""
        self._duration = duration

    def _update(self, _: Any) -> None:
        self._count += 1

    @property
    def _rate(self) -> float:
        return self._count / self._duration if self._duration else math.nan

    def _is_met(self) -> bool:
        return not self._duration or self._low <= self._rate <= self._high

    def figures(self) -> Tuple[float, float]:
        """The rate, up to the lowest that is required."""
        return min(self._rate, self._low), self._low

    def _measured(self) -> str:
        return f'{self._rate:.1f} Hz'


def _is_number(value: Any) -> bool:
    return isinstance(value, (bool, int, float)) and not math.isnan(value)
