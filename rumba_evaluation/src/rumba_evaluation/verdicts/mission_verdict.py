"""A verdict on a robot's run: its conditions and the measured values. The caller supplies time and values.

A goal must be met at the end, a guard in every message: see `conditions`. A guard that is violated once has failed; the
run goes on nevertheless, so that the verdict covers every condition.

A run begins with the first message. It ends as soon as all goals are met at the same time and each guard has a value,
or when the time limit is reached; without any goal, only at the time limit. Later values are ignored. A condition
without any value has failed, and so has a guard if the run was aborted. If the run is void, all conditions have failed.
"""

from typing import Any, Callable, Dict, List, NamedTuple, Optional, Sequence

from rumba_evaluation.verdicts.conditions import Condition
from rumba_sim.model.common.geometry import Pose


class Verdict(NamedTuple):
    """The verdict on one condition."""

    name: str
    is_met: bool
    words: str
    counts: bool = True  # whether a part of it can be met: not in a void run


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
        self._place: Optional[Pose] = None
        self._violations: Dict[str, str] = {}  # the first of each guard that is violated, in words

    def locate(self, place: Pose) -> None:
        """The robot is at a pose in the map frame; values that come next are measured there."""
        if not self.is_over:
            self._place = place

    def update(self, condition: Condition, value: Any, now: float) -> None:
        """Take a value of one of the conditions, measured at a time [s]."""
        self.check_time(now)
        if self.is_over:
            return
        if self._began is None:
            self._began = now
        condition.update(value)
        if condition.is_guard and condition.is_measured and not condition.is_met:
            self._violations.setdefault(condition.name,
                                        f'; violated first after {self._passed:.1f} s{self._where(",")}')
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
        for condition in self.conditions:
            condition.finish(self._passed)

    def verdicts(self, source: Callable[[Condition], str],
                 silence: Callable[[Condition], str] = lambda _: '') -> List[Verdict]:
        """The verdict on each condition.

        Args:
            source: gives the topics from which the values of a condition come.
            silence: tells of a condition without any value why that may be; empty if nothing is known.
        """
        return [self._verdict(condition, source, silence) for condition in self.conditions]

    def _verdict(self, condition: Condition, source: Callable[[Condition], str],
                 silence: Callable[[Condition], str]) -> Verdict:
        counts = not self._is_void and (self._is_complete or not condition.is_guard)
        is_met = condition.is_met and counts
        topics = cause = ''
        if not condition.is_measured:
            topics, why = f' on {source(condition)}', '' if self._is_void else silence(condition)
            cause = f'; {why}' if why else ''
        reason = f': {self._reason}' if self._reason else ''
        where = ''
        if not is_met:
            where = self._violations.get(condition.name, '') if condition.is_guard else self._where('; the robot was')
        return Verdict(condition.name, is_met,
                       f'{condition.name}: required {condition.required}; measured {condition.measured()}{topics} '
                       f'after {self._passed:.1f} s of {self._time_limit:g} s{reason}{where}{cause}', counts)

    def _where(self, link: str) -> str:
        return f'{link} at ({self._place.x:.2f}, {self._place.y:.2f}) m' if self._place is not None else ''
