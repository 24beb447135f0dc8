"""The parameters of the simulator: what the robots are like, and how the node runs."""

import dataclasses
from typing import NamedTuple

from rumba_sim.model.config import names, part, section, setting
from rumba_sim.model.errors import ConfigError
from rumba_sim.model.robot_config import RobotConfig

MAX_RATE = 1000


class Due(NamedTuple):
    """Which messages are due at a tick."""

    odom: bool
    ground_truth: bool
    scan: bool
    sensors: bool
    battery: bool
    cleaning: bool


@dataclasses.dataclass(frozen=True)
class Rates:
    """How often messages are published, in simulated time; each divides the step rate. 0: never."""

    odom: int = setting(50, 'odom, and the transforms of odom and map', 'Hz', 0, MAX_RATE)
    ground_truth: int = setting(10, 'ground_truth', 'Hz', 0, MAX_RATE)
    scan: int = setting(10, 'scan', 'Hz', 0, MAX_RATE)
    sensors: int = setting(10, 'bumper, cliff and dock_status', 'Hz', 0, MAX_RATE)
    battery: int = setting(5, 'battery_status and battery_state', 'Hz', 0, MAX_RATE)
    cleaning: int = setting(1, 'cleaning_status and coverage', 'Hz', 0, MAX_RATE)

    def due(self, ticks: int, step_rate: float) -> Due:
        """What is due at a tick: where no whole number of ticks gives a rate, at the next after each period."""
        return Due(*(ticks * rate // step_rate > (ticks - 1) * rate // step_rate for rate in self._all()))

    def check(self, step_rate: int) -> None:
        """Refuse rates that no whole number of ticks gives.

        Raises:
            ConfigError: a rate does not divide the step rate.
        """
        for name, rate in zip(names(Rates), self._all()):
            if rate and step_rate % rate:
                possible = [str(rate) for rate in range(1, step_rate + 1) if step_rate % rate == 0]
                raise ConfigError(f'rates/{name} is {rate}: must divide step_rate, {step_rate}: one of 0, '
                                  + ', '.join(possible))

    def _all(self) -> Due:
        return Due(self.odom, self.ground_truth, self.scan, self.sensors, self.battery, self.cleaning)


@dataclasses.dataclass(frozen=True)
class Settings(RobotConfig):
    """Parameters of the simulator, with their defaults.

    `rosrun rumba_sim simulator --config` prints this file. A copy, changed, is given as `_config:=PATH`, or
    `roslaunch rumba_sim simulator.launch config:=PATH`; what it leaves out keeps its default. Single parameters go
    before it: `_battery/drain:=60`.

    Sources of the figures:
      OI: iRobot Roomba 600 Open Interface specification
      libcreate, create_robot: drivers of the Create 2
      Create 3, create3_sim: documentation and simulator of the Create 3
      makers, owners, published measurements: data of battery makers, and what owners measured and published
    """

    map: str = setting('apartment', 'name of a map of this package, or path of a map_server YAML file')
    speed: float = setting(1.0, 'times real time; 0: as fast as possible', '', 0.0, 1e6)
    robots: int = setting(1, 'robots at the beginning: rumba, rumba2, rumba3, ...', '', 0, 1000)
    seed: int = setting(1, 'of all that is random', '', 0, 2 ** 31 - 1)
    step_rate: int = setting(50, 'ticks in a second of simulated time', 'Hz', 1, MAX_RATE)
    percentage: float = setting(100.0, 'charge to begin with', '%', 0.0, 100.0)
    brushes_up: bool = setting(False, 'whether the brushes are lifted at the beginning')
    localisation: bool = setting(True, 'whether map -> odom is published: the perfect correction of odometry')
    config: str = setting('', 'path of a YAML file with any of these; parameters go before it')
    rates: Rates = section(Rates, 'how often messages are published; each divides step_rate')

    def __post_init__(self) -> None:
        """Rates must fit the step rate."""
        self.rates.check(self.step_rate)

    @property
    def robot(self) -> RobotConfig:
        """The part that says what the robots are like."""
        return part(self, RobotConfig)


TUNABLE = ['speed', 'drive/command_timeout', 'odometry/noise', 'laser/noise', 'battery/drain',
           *(f'rates/{name}' for name in names(Rates))]
