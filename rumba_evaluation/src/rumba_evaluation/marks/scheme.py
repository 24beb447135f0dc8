"""Points for the conditions of a run, and why they were lost.

A condition that is met earns its points, and one that is met in part earns a part if there is partial credit for it.
Guards earn no larger share of their points than the goals of theirs: a robot that stands still breaks no guard, and
deserves nothing for it. Goals are the task and guards the rules in words for students.
"""

import math
from typing import Dict, List, NamedTuple, Optional, Sequence

from rumba_evaluation.verdicts.conditions import Condition
from rumba_evaluation.verdicts.mission_verdict import Verdict
from rumba_sim.model.common.errors import ConfigError

DIGITS = 2  # of points after the decimal point


class Mark(NamedTuple):
    """Points for one thing that is marked."""

    name: str
    score: float
    max_score: float
    reason: str  # one sentence: what was measured, and why points were lost


class Credit(NamedTuple):
    """Partial credit: nothing for the worthless figure, everything for the required one."""

    worthless: float
    exponent: float = 1.0  # of the curve between them: above 1, the last steps earn most


class Scheme:
    """How many points each condition earns.

    Attributes:
        points: points by the name of the condition.
    """

    def __init__(self, conditions: Sequence[Condition], points: str = '', partial: str = '') -> None:
        """Understand a teacher's texts.

        Args:
            conditions: all conditions of the run.
            points: as in "coverage 8; collisions 2"; empty: one point each.
            partial: as in "coverage 0.1; collisions 20 2": the worthless figure, and the exponent of the curve.

        Raises:
            ConfigError: a text cannot be understood, or names no condition, or not each that needs points.
        """
        self._conditions = {condition.name: condition for condition in conditions}
        given = self._named('points', points)
        self.points = {name: _points(name, given.get(name) if points else ['1']) for name in self._conditions}
        self._credits = {name: _credit(self._conditions[name], words)
                         for name, words in self._named('partial', partial).items()}
        if not sum(self.points.values()) > 0.0:
            raise ConfigError('points are all 0: give at least one condition more')

    def _named(self, setting: str, text: str) -> Dict[str, List[str]]:
        """The words behind each name of a condition."""
        found: Dict[str, List[str]] = {}
        for part in filter(None, map(str.split, text.split(';'))):
            name, *words = part
            if name not in self._conditions:
                raise ConfigError(f'{setting} names {name!r}: must be one of ' + ', '.join(self._conditions))
            if name in found:
                raise ConfigError(f'{setting} names {name} twice')
            found[name] = words
        return found

    def marks(self, verdicts: Sequence[Verdict]) -> List[Mark]:
        """The points of each condition, by the verdicts on them."""
        shares = {verdict.name: self._share(verdict) for verdict in verdicts}
        goals = [name for name, condition in self._conditions.items() if not condition.is_guard]
        most = sum(self.points[name] for name in goals)
        earned = sum(shares[name] * self.points[name] for name in goals) / most if most else 1.0
        return [self._mark(verdict, shares[verdict.name], earned) for verdict in verdicts]

    def _share(self, verdict: Verdict) -> float:
        credit = self._credits.get(verdict.name)
        if verdict.is_met or credit is None or not verdict.counts:
            return float(verdict.is_met)
        share = self._conditions[verdict.name].share(credit.worthless)
        return float(share ** credit.exponent)

    def _mark(self, verdict: Verdict, share: float, earned: float) -> Mark:
        most = self.points[verdict.name]
        is_scaled = self._conditions[verdict.name].is_guard and earned < 1.0 and share > 0.0
        score = round(most * share * (earned if is_scaled else 1.0), DIGITS)
        lost = f'{number(most - score)} of {number(most)} points lost: ' if score < most else ''
        scaled = self._scaled(share, earned) if is_scaled else ''
        return Mark(verdict.name, score, most, lost + verdict.words + scaled)

    def _scaled(self, share: float, earned: float) -> str:
        """Why a guard of which a share is met earns only a part of that, in words."""
        task = ' and '.join(name for name, condition in self._conditions.items()
                            if not condition.is_guard and self.points[name])
        kept, factor = 'kept', 'too'
        if share < 1.0:
            kept = f'kept in part, which is worth {_percent(share)} of its points'
            factor = f'of {_percent(share)}'
        done = f'no points for {task} are earned, so this earns none'
        if earned:
            done = f'{_percent(earned)} of the points for {task} are earned, so this earns {_percent(earned)} {factor}'
        return f'; the rule was {kept}, but rules count only as far as the task is done: {done}'


def _percent(share: float) -> str:
    return f'{100.0 * share:.0f} %'


def nothing(points: Dict[str, float], reason: str) -> List[Mark]:
    """No points for anything, for one reason."""
    return [Mark(name, 0.0, most, f'{number(most)} of {number(most)} points lost: {reason}')
            for name, most in points.items()]


def number(points: float) -> str:
    """Points in words, without needless zeros."""
    return f'{round(points, DIGITS):g}'


def _points(name: str, words: Optional[Sequence[str]]) -> float:
    if words is None:
        raise ConfigError(f'points does not name {name}: give its points, which may be 0')
    numbers = _numbers(words)
    if len(numbers) != 1 or numbers[0] < 0.0:
        raise ConfigError(f'points has {name} {" ".join(words)!r}: must be one number, at least 0, "; " between '
                          'conditions')
    return numbers[0]


def _credit(condition: Condition, words: Sequence[str]) -> Credit:
    if not condition.has_degrees:
        raise ConfigError(f'partial names {condition.name}, which cannot be met in part')
    numbers = _numbers(words)
    if len(numbers) not in (1, 2) or not all(limit > 0.0 for limit in numbers[1:]):
        raise ConfigError(f'partial has {condition.name} {" ".join(words)!r}: must be the figure that is worth nothing '
                          'and, if wanted, the exponent of the curve, above 0; "; " between conditions')
    required = condition.figures()[1]
    if (numbers[0] < required) is not condition.is_more_better or numbers[0] == required:
        side = 'below' if condition.is_more_better else 'above'
        raise ConfigError(f'partial has {condition.name} {numbers[0]:g}: what is worth nothing must be {side} what is '
                          f'required, {required:g}')
    return Credit(*numbers)


def _numbers(words: Sequence[str]) -> List[float]:
    """The words as finite numbers; an empty list if one is none."""
    try:
        numbers = [float(word) for word in words]
    except ValueError:
        return []
    return numbers if all(map(math.isfinite, numbers)) else []
