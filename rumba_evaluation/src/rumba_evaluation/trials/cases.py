"""What is evaluated: a grid of cases, under conditions that all of them share; and what is known of each afterwards."""

import dataclasses
import itertools
import math
from typing import List, NamedTuple, Sequence, Tuple

from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_sim.model.config import setting
from rumba_sim.model.errors import ConfigError

DOCK, ANYWHERE = 'dock', 'anywhere'
SUCCEEDED, FAILED, TIME_OUT, CRASHED = 'succeeded', 'failed', 'time out', 'crashed'
LEVELS = (80, 90, 95, 98, 99)  # [%] of coverage: the time to each is reported
Curve = Tuple[float, ...]


class Case(NamedTuple):
    """One mission to run."""

    map: str  # as the user named it
    strategy: str
    seed: int
    robots: int


@dataclasses.dataclass(frozen=True)
class Conditions:
    """What all cases of an evaluation share."""

    start: str = setting(DOCK, f'where robots begin, {DOCK} (where the map says) or {ANYWHERE} (drawn from the seed)')
    drain: float = setting(1.0, 'how many times faster than a real one the battery runs down and fills', '', 0.0, 1e4)
    target: float = setting(CleaningConfig().target_coverage, 'share of the reachable floor after which a mission '
                            'ends', '', 0.0, 1.0)
    bound: float = setting(12.0, 'times T, without charging, after which a mission is given up', '', 0.01, 1e6)

    def __post_init__(self) -> None:
        """There are two kinds of start."""
        if self.start not in (DOCK, ANYWHERE):
            raise ConfigError(f'start is {self.start!r}: must be {DOCK} or {ANYWHERE}')


@dataclasses.dataclass(frozen=True)
class Result:
    """How a mission went; of several robots the sum, where nothing else is said.

    Working time is the time since the beginning without that in which all robots that still have a mission charge.
    """

    outcome: str  # SUCCEEDED if all robots did, else TIME_OUT if any was still at work, else FAILED; or CRASHED
    message: str  # how each mission ended
    area: float  # [m^2] of floor that a brush can reach from the map's start
    ideal_time: float  # [s] T: to sweep that with one brush at the cleaning speed, nothing twice
    coverage: float  # [0..1] at the end, as it truly is
    dirt_left: float  # [0..1]
    time: float  # [s]
    charging_time: float  # [s] of that
    charges: int
    distance: float  # [m]
    turns: float  # whole turns, to either side
    collisions: int  # how often a bumper was pressed
    charge_used: float  # [Ah] out of the battery, at a drain of 1
    energy: float  # [Wh] the same
    energy_per_area: float  # [Wh/m^2] swept; NaN where nothing was
    docked: int  # robots at the contacts in the end
    penetrated: bool  # a robot was inside a wall by more than 1 mm, or fell from a cliff
    x: float  # [m] where the first robot began, map frame
    y: float  # [m]
    theta: float  # [rad]
    curve: Curve  # [s] working time until 1 %, 2 %, ... were swept, as far as the mission came

    def time_to(self, percent: int) -> float:
        """Working time until so much was swept [s]; inf where it never was."""
        return self.curve[percent - 1] if percent <= len(self.curve) else math.inf

    def multiple_to(self, percent: int) -> float:
        """The same in multiples of T."""
        return self.time_to(percent) / self.ideal_time


def grid(maps: Sequence[str], strategies: Sequence[str], seeds: Sequence[int], robots: Sequence[int]) -> List[Case]:
    """All cases, seeds of one map, strategy and number of robots together; what is given twice counts once."""
    unique = (dict.fromkeys(values) for values in (maps, strategies, robots, seeds))
    return [Case(map, strategy, seed, count) for map, strategy, count, seed in itertools.product(*unique)]
