"""How often the messages of a robot are published, and which of them are due at a tick."""

import dataclasses
import functools
from typing import NamedTuple, Tuple

from rumba_sim.model.common.config import names, setting
from rumba_sim.model.common.errors import ConfigError

MAX_RATE = 1000


class Due(NamedTuple):
    """Which messages are due at a tick."""

    odom: bool
    ground_truth: bool
    scan: bool
    sensors: bool
    battery: bool
    cleaning: bool


EVERYTHING = Due(*[True] * len(Due._fields))


@dataclasses.dataclass(frozen=True)
class Rates:
    """How often messages are published, in simulated time; each divides the step rate. 0: never."""

    odom: int = setting(50, 'odom, and the transforms of odom and map', 'Hz', 0, MAX_RATE)
    ground_truth: int = setting(10, 'ground_truth', 'Hz', 0, MAX_RATE)
    scan: int = setting(10, 'scan, no more often than laser/rate', 'Hz', 0, MAX_RATE)
    sensors: int = setting(10, 'bumper, cliff, dock_status and battery_state', 'Hz', 0, MAX_RATE)
    battery: int = setting(5, 'battery_status', 'Hz', 0, MAX_RATE)
    cleaning: int = setting(1, 'cleaning_status and coverage', 'Hz', 0, MAX_RATE)

    def due(self, ticks: int, step_rate: float) -> Due:
        """What is due at a tick, 1 or more: everything at the first, then the first tick after each period."""
        return _due(self._all(), (ticks - 1) % step_rate, step_rate)

    def check(self, step_rate: int) -> None:
        """Refuse rates whose period is no whole number of ticks.

        Raises:
            ConfigError: a rate does not divide the step rate.
        """
        for name, rate in zip(names(Rates), self._all()):
            if rate and step_rate % rate:
                possible = [str(rate) for rate in range(1, step_rate + 1) if step_rate % rate == 0]
                raise ConfigError(f'rates/{name} is {rate}: must divide step_rate, {step_rate}: one of 0, '
                                  + ', '.join(possible))

    def _all(self) -> Tuple[int, ...]:
        return self.odom, self.ground_truth, self.scan, self.sensors, self.battery, self.cleaning


@functools.lru_cache(maxsize=None)
def _due(rates: Tuple[int, ...], phase: float, step_rate: float) -> Due:
    """What is due so many ticks after a whole second."""
    return Due(*(phase * rate // step_rate > (phase - 1) * rate // step_rate for rate in rates))
