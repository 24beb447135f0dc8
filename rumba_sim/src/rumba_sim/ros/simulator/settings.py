"""The parameters of the simulator: properties of the robots, and how the node runs."""

import dataclasses
import functools

import rosgraph

from rumba_sim.model.common.config import names, part, section, setting
from rumba_sim.model.common.errors import ConfigError, quoted
from rumba_sim.model.settings.interfaces import PRESETS, RUMBA
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.ros.robot.localisation import TRUTH, localisation_setting
from rumba_sim.ros.robot.rates import MAX_RATE, Rates

LOWEST_SPEED = 0.001  # [times real time] with the default step rate, a tick takes 20 s


@dataclasses.dataclass(frozen=True)
class Settings(RobotConfig):
    """Parameters of the simulator, with their defaults.

    `rosrun rumba_sim simulator --config` prints this file. Change a copy of it, and give that as `_config:=PATH`, or
    `roslaunch rumba_sim simulator.launch config:=PATH`; what the copy leaves out keeps its default. Single parameters
    override the file: `_battery/drain:=60`.

    Sources of the figures:
      OI: iRobot Roomba 600 Open Interface specification
      libcreate, create_robot: drivers of the Create 2
      Create 3, create3_sim: documentation and simulator of the Create 3
      makers, owners, published measurements: data of battery makers, and what owners measured and published
    """

    map: str = setting('apartment', 'name of a map of this package, or path of a map_server YAML file')
    speed: float = setting(1.0, f'multiple of real time, at least {LOWEST_SPEED}; 0: as fast as possible', '', 0.0,
                           1e6)
    robots: int = setting(1, 'number of robots at the start: rumba, rumba2, rumba3, ...', '', 0, 1000)
    seed: int = setting(1, 'seed of the random generators', '', 0, 2 ** 31 - 1)
    step_rate: int = setting(50, 'ticks per second of simulated time', 'Hz', 1, MAX_RATE)
    percentage: float = setting(100.0, 'charge at the start', '%', 0.0, 100.0)
    brushes_up: bool = setting(False, 'whether the brushes are lifted at the start')
    interface: str = setting(RUMBA, 'topics and frames of another robot, beside those of Rumba, for nodes that were '
                                    'written for it; sets the model of the laser too', presets=PRESETS)
    localisation: str = localisation_setting()
    obstacles: str = setting('', 'path of a YAML file of obstacles that the map does not show')
    config: str = setting('', 'path of a YAML file with any of these; parameters override it')
    state: str = setting('', 'path of a file: the world is saved there every minute of simulated time and at the end, '
                             'and goes on from there at the next start')
    lockstep: str = setting('auto', 'whether the world waits after each control tick for those who take part: true '
                                    '(/clock is published at any speed), false, or auto: if time is simulated',
                            choices=('auto', 'true', 'false'))
    lockstep_patience: float = setting(10.0, 'of the wall clock without a sign of a participant, after which the world '
                                             'goes on without it', 's', 0.1, 1e6)
    wait_for: str = setting('', 'who takes part from the first tick on, with spaces between: names of nodes that '
                                'answer, and topics of commands of others, for example `cleaner` or `rumba/cmd_vel`')
    exam: bool = setting(False, 'an examination: nothing is published that the robot could not know, as ground_truth, '
                                'coverage and obstacles; no perfect localisation, no services that change the world, '
                                'no tuning')
    rates: Rates = section(Rates, 'how often messages are published; each divides step_rate')

    def __post_init__(self) -> None:
        """Check that time passes noticeably, and that the rates divide the step rate."""
        if 0.0 < self.speed < LOWEST_SPEED:
            raise ConfigError(f'speed is {self.speed:g}: must be 0, or {LOWEST_SPEED} to 1000000')
        for name in self.wait_for.split():
            if not rosgraph.names.is_legal_name(name):
                raise ConfigError(f'wait_for has {quoted(name)}: must be names of nodes and topics, with spaces '
                                  'between')
        self.rates.check(self.step_rate)
        if self.exam and self.localisation == TRUTH:
            raise ConfigError('localisation is truth: in an examination (exam) it must be mcl or none')

    @property
    def told(self) -> 'Settings':
        """What nodes may know of the settings: in an examination not what makes this world differ from others."""
        return dataclasses.replace(self, seed=0, obstacles='', state='') if self.exam else self

    @functools.cached_property
    def paced_rates(self) -> Rates:
        """The rates, with scans no more often than the laser turns."""
        return dataclasses.replace(self.rates, scan=min(self.rates.scan, self.laser.rate_at(self.step_rate)))

    @property
    def robot(self) -> RobotConfig:
        """Properties of the robots."""
        return part(self, RobotConfig)


TUNABLE = ['speed', 'drive/command_timeout', 'odometry/noise', 'laser/noise', 'battery/drain',
           *(f'rates/{name}' for name in names(Rates))]
