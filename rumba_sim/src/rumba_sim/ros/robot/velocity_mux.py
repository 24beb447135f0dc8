"""Decides which of several inputs drives a robot, by the rule of twist_mux."""

from typing import Dict, NamedTuple, Sequence


class Input(NamedTuple):
    """A source of velocity commands."""

    name: str
    priority: int  # an input of higher priority overrides one of lower priority
    timeout: float  # [s] after its last command an input overrides others no longer


class VelocityMux:
    """Lets a command pass unless an input of higher priority has sent one within its timeout."""

    def __init__(self, inputs: Sequence[Input]) -> None:
        """No input has sent a command yet."""
        self._inputs = {each.name: each for each in inputs}
        self._last: Dict[str, float] = {}

    def passes(self, name: str, now: float) -> bool:
        """Note that an input sends a command, and tell whether the robot shall follow it.

        Args:
            name: of the input.
            now: [s] of a clock that never runs backward.
        """
        self._last[name] = now
        priority = self._inputs[name].priority
        return not any(each.priority > priority and self._is_active(each, now) for each in self._inputs.values())

    def _is_active(self, each: Input, now: float) -> bool:
        return each.name in self._last and now - self._last[each.name] < each.timeout
