"""What ROS 1 cannot forbid in an examination, and a judge can see at the master while the run lasts."""

from typing import Any, Dict, Mapping, Sequence


class Examination:
    """Watches whether parameters stay as they were launched.

    Attributes:
        problem: why the run does not count, in words; empty if nothing is wrong so far.
    """

    def __init__(self, launched: Mapping[str, Any], nodes: Sequence[str]) -> None:
        """Nothing was seen yet.

        Args:
            launched: values of parameters by their names, or by parts of their names, one in another.
            nodes: full names of the nodes that no other node may give a parameter.
        """
        self.problem = ''
        self._launched = _by_full_name(launched)
        self._nodes = tuple(f'{node}/' for node in nodes)

    def look(self, parameters: Mapping[str, Any]) -> None:
        """Compare all parameters that there are now, by parts of their names, one in another."""
        if self.problem:
            return
        now = _by_full_name(parameters)
        found = {name: 'is gone' if name not in now else 'was changed' for name, value in self._launched.items()
                 if name not in now or now[name] != value}
        found.update((name, 'is new') for name in now
                     if name not in self._launched and name.startswith(self._nodes))
        if found:
            words = ' and '.join(f'the parameter {name} {what}' for name, what in sorted(found.items()))
            self.problem = f'{words}: in an examination nobody may do that'


def _by_full_name(parameters: Mapping[str, Any], before: str = '') -> Dict[str, Any]:
    found: Dict[str, Any] = {}
    for name, value in parameters.items():
        full_name = f'{before}/{name.strip("/")}'
        found.update(_by_full_name(value, full_name) if isinstance(value, Mapping) else {full_name: value})
    return found
