"""The parameters of the cleaner, and what it takes from the simulator beside it."""

import dataclasses

import rospy

from rumba_cleaning import strategies
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_sim.model import yaml_file
from rumba_sim.model.config import names, part, setting, updated
from rumba_sim.model.errors import ConfigError
from rumba_sim.model.robot_config import RobotConfig
from rumba_sim.ros.common.names import check_names

STRATEGIES = tuple(sorted(strategies.OWN))  # that every cleaner knows


@dataclasses.dataclass(frozen=True)
class Settings(CleaningConfig):
    """The node's private parameters: how a robot shall work, which, and where."""

    robot: str = setting('rumba', 'name of the robot, below which its topics are')
    map: str = setting('', 'name of a map of this package, or path of a map_server YAML file; empty: that of the '
                           'simulator')
    simulator: str = setting('simulator', 'name of the node that knows what the robot and its map are like: simulator '
                                          'or turtlesim_body')
    seed: int = setting(1, 'of all that is random', '', 0, 2 ** 31 - 1)
    strategies: str = setting('', 'Python modules to import for further strategies, with commas between them')
    autostart: bool = setting(False, 'whether to begin with a goal of clean, without waiting for one')

    def __post_init__(self) -> None:
        """Names of topics are made of the robot's name."""
        check_names(self, 'robot')

    @property
    def cleaning(self) -> CleaningConfig:
        """The part that says how to work."""
        return part(self, CleaningConfig)


def robot_of_simulator(simulator: str) -> RobotConfig:
    """What the robots of a simulator are like, by its name and parameters; the usual ones without it."""
    parameters = rospy.get_param(simulator, {})
    path = parameters.get('config', '')
    config = RobotConfig()
    for mapping in ([yaml_file.read_mapping(path, ConfigError)] if path else []) + [parameters]:
        known = {name: mapping[name] for name in names(RobotConfig) if name in mapping}
        config = updated(config, known, f'parameter of {rospy.resolve_name(simulator)}')
    return config
