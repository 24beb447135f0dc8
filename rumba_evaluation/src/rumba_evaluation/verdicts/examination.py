"""What ROS 1 cannot forbid in an examination, and a judge can see at the master while the run lasts."""

from typing import Any, List, Mapping, Sequence, Tuple

EXAMINER = '/simulator/examiner/'
ALLOWED = ('/recorder',)  # who may hear what is below EXAMINER, beside the judge
SIMULATOR = 'simulator'  # whose parameters stay as they are


class Examination:
    """Watches who hears the truth, and whether parameters change.

    Attributes:
        problem: why the run does not count, in words; empty if nothing is wrong so far.
    """

    def __init__(self, judge: str) -> None:
        """Nothing was seen yet; `judge` is the full name of the node that marks."""
        self.problem = ''
        self._allowed = {judge, *ALLOWED}
        self._parameters: Any = None

    def look(self, subscribers: Sequence[Tuple[str, List[str]]], parameters: Mapping[str, Any]) -> None:
        """Compare what the master tells with what it told before: subscribers by topic, and all parameters."""
        for topic, nodes in subscribers:
            others = sorted(set(nodes) - self._allowed)
            if EXAMINER in topic and others:
                self._report(f'{topic} is heard by {" and ".join(others)}')
        now = {name: value for name, value in parameters.items() if name in (SIMULATOR, 'use_sim_time')}
        if self._parameters is None:
            self._parameters = now
        for name, value in now.items():
            if value != self._parameters.get(name):
                changed = _first_difference(f'/{name}', self._parameters.get(name), value)
                self._report(f'the parameter {changed} was changed')

    def _report(self, words: str) -> None:
        """Note the first problem."""
        self.problem = self.problem or f'{words}: in an examination nobody may do that'


def _first_difference(name: str, before: Any, now: Any) -> str:
    """The full name of a parameter that differs, below a name."""
    if isinstance(before, Mapping) and isinstance(now, Mapping):
        for key in sorted({*before, *now}):
            if before.get(key) != now.get(key):
                return _first_difference(f'{name}/{key}', before.get(key), now.get(key))
    return name
