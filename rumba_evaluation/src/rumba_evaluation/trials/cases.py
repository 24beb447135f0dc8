"""Cases of an evaluation, the conditions that they share, and the result of each."""

import dataclasses
import itertools
import math
from typing import List, NamedTuple, Sequence, Tuple

from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.outcome import Outcome
from rumba_sim.model.common.config import setting
from rumba_sim.model.common.errors import ConfigError
from rumba_sim.model.settings.laser_config import IDEAL, MODELS

TRUTH, LOCALISED, ODOMETRY, SLAM, MAPLESS = POSES = 'truth', 'localised', 'odometry', 'slam', 'mapless'
DOCK, ANYWHERE = 'dock', 'anywhere'
LEVELS = (80, 90, 95, 98, 99)  # [%] of coverage; the time to each is reported
SEVERITY = {Outcome.SUCCEEDED: 0, Outcome.INCOMPLETE: 1, Outcome.TIMED_OUT: 3, Outcome.FALLEN: 4}
FAILURE = 2  # severity of all other outcomes
Curve = Tuple[float, ...]


class Case(NamedTuple):
    """One mission to run."""

    map: str  # the name or path that the user gave
    strategy: str
    seed: int
    robots: int


@dataclasses.dataclass(frozen=True)
class Conditions:
    """The conditions that all cases of an evaluation share."""

    start: str = setting(DOCK, f'where robots start: {DOCK} (the start of the map) or {ANYWHERE} (drawn from the seed)')
    pose: str = setting(TRUTH, f'where robots get their pose: {TRUTH}, {LOCALISED} (laser and odometry), {ODOMETRY} '
                               f'alone, {SLAM} (their own map, from the dock on) or {MAPLESS} (nowhere)')
    drain: float = setting(1.0, 'how many times faster than a real one the battery discharges and charges', '', 0.0,
                           1e4)
    target: float = setting(CleaningConfig().target_coverage, 'share of the reachable floor at which a mission ends',
                            '', 0.0, 1.0)
    obstacles: str = setting('', 'path of a YAML file of obstacles that the maps do not show; robots do not know them')
    robot: str = setting('', 'path of a YAML file of what robots are like, with the settings of a robot in '
                             'rumba_sim/config/rumba.yaml that are to be others')
    laser: bool = setting(False, 'whether robots drive around what their lasers see and the maps do not show')
    laser_model: str = setting(IDEAL, 'laser of the robots', choices=tuple(MODELS))
    margin: float = setting(CleaningConfig().margin, 'that plans keep between robot and walls, as the setting of '
                                                     'cleaner', 'm', 0.0, 0.5)
    bound: float = setting(12.0, 'working time, in multiples of T, after which a mission is stopped; '
                                 f'with pose {MAPLESS} they end by themselves', '', 0.01, 1e6)

    def __post_init__(self) -> None:
        """Check the kinds of start and pose."""
        if self.pose not in POSES:
            raise ConfigError(f'pose is {self.pose!r}: must be one of {", ".join(POSES)}')
        if self.start not in (DOCK, ANYWHERE):
            raise ConfigError(f'start is {self.start!r}: must be {DOCK} or {ANYWHERE}')
        if self.pose == SLAM and self.start != DOCK:
            raise ConfigError(f'start is {self.start!r}: must be {DOCK} with pose {SLAM}, or robots do not know where '
                              'their dock is')


@dataclasses.dataclass(frozen=True)
class Result:
    """How a mission went; the sum over several robots, unless stated otherwise.

    Working time is the time since the start without the time in which all robots that still have a mission charge.
    """

    outcome: Outcome  # of several robots the worst: a fall, no end, another failure, a target that was missed
    message: str  # how each mission ended
    area: float  # [m^2] of floor that a brush can reach from the map's start
    ideal_time: float  # [s] T: for one brush to sweep that area without any overlap, at the speed of cleaning
    coverage: float  # [0..1] at the end, true value
    dirt_left: float  # [0..1]
    time: float  # [s]
    charging_time: float  # [s] of that
    charges: int
    distance: float  # [m]
    turns: float  # rotation in multiples of 360 degrees, left and right added up
    collisions: int  # how often a bumper was pressed
    charge_used: float  # [Ah] out of the battery, at a drain of 1
    energy: float  # [Wh] the same
    energy_per_area: float  # [Wh/m^2] swept; NaN if nothing was swept
    docked: int  # robots on the dock at the end
    penetrated: bool  # a robot was inside a wall or an obstacle by more than 1 mm
    x: float  # [m] start of the first robot, map frame
    y: float  # [m]
    theta: float  # [rad]
    ticks: int  # of the world at the end ...
    digest: str  # ... and its digest: a mission through ROS in lockstep has the same
    curve: Curve  # [s] working time until 1 %, 2 %, ... were swept, up to the last percent that was reached

    @property
    def has_failed(self) -> bool:
        """Whether the mission missed its target, or that of any of several robots."""
        return self.outcome is not Outcome.SUCCEEDED

    def time_to(self, percent: int) -> float:
        """Working time until a percentage was swept [s]; inf if it never was."""
        return self.curve[percent - 1] if percent <= len(self.curve) else math.inf

    def multiple_to(self, percent: int) -> float:
        """The same in multiples of T."""
        return self.time_to(percent) / self.ideal_time


def severity(outcome: Outcome) -> int:
    """How bad an end is: 0 for success, 4 for a fall."""
    return SEVERITY.get(outcome, FAILURE)


def grid(maps: Sequence[str], strategies: Sequence[str], seeds: Sequence[int], robots: Sequence[int]) -> List[Case]:
    """All combinations, without duplicates; those that differ only in the seed follow one another."""
    unique = (dict.fromkeys(values) for values in (maps, strategies, robots, seeds))
    return [Case(map, strategy, seed, count) for map, strategy, count, seed in itertools.product(*unique)]
