"""The parameters of the cleaner."""

import dataclasses
import math
from typing import Optional

from rosgraph.names import is_legal_base_name

from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_sim.model.common.config import part, section, setting
from rumba_sim.model.common.errors import ConfigError
from rumba_sim.model.common.geometry import Pose
from rumba_sim.ros.common.names import check_names
from rumba_sim.ros.common.own_robots import own_robot_setting


@dataclasses.dataclass(frozen=True)
class GoToPositionSettings:
    """What the service go_to_position answers."""

    answer: str = setting('velocity', 'velocity: a speed in linear_x [m/s] and a turn rate in angular_z [rad/s], to be '
                                      'commanded as they are. Heading, as servers of the lesson answer: a heading in '
                                      'angular_z [rad], to turn to first, and then a speed in linear_x [m/s]: -1, '
                                      'backward, or 0 at the target',
                          choices=('velocity', 'heading'))


@dataclasses.dataclass(frozen=True)
class Settings(CleaningConfig):
    """The node's private parameters: which robot works, where and how."""

    robot: str = setting('rumba', 'name of the robot, below which its topics are')
    own_robot: str = own_robot_setting()
    home: str = setting('', 'where a robot of your own ends, or its dock if it docks: x y theta [m, rad] on the map; '
                            'empty: where it began')
    docks: bool = setting(False, 'whether a robot of your own docks by itself on seek_dock')
    team: str = setting('', 'names of all robots that share the floor, its own among them, with spaces between: '
                            'each gives way to those before it; empty: it works alone')
    map: str = setting('', 'name of a map of rumba_sim, or path of a map_server YAML file; empty: that of the '
                           'simulator')
    mapping: bool = setting(False, 'whether the floor is being mapped: its plan is that of the topic map, as it grows, '
                                   'and not that of a file')
    mapless: bool = setting(False, 'whether the robot works without map, localisation and laser, for cleaning_time: '
                                   'with the strategies wander, bounce, spiral or wall_follow')
    seed: int = setting(1, 'of all that is random', '', 0, 2 ** 31 - 1)
    strategies: str = setting('', 'Python modules to import for further strategies, with commas between them')
    autostart: bool = setting(False, 'whether to begin with a goal of clean, without waiting for one')
    go_to_position: GoToPositionSettings = section(GoToPositionSettings, 'what the service go_to_position answers')

    def __post_init__(self) -> None:
        """Check the names of robots, which are parts of the names of topics."""
        check_names(self, 'robot')
        names = self.team.split()
        if names and self.robot not in names or len(set(names)) < len(names) or not all(
                map(is_legal_base_name, names)):
            raise ConfigError(f'team is {self.team!r}: must be names of robots, each of them once, and {self.robot!r} '
                              'among them')
        if self.mapless and (self.mapping or self.laser):
            raise ConfigError(f'{"mapping" if self.mapping else "laser"} is true: must be false with mapless')
        if self.own_robot and (self.mapless or names[1:] or not (self.map or self.mapping)):
            raise ConfigError('own_robot is given: must come with map, or with mapping, and with neither mapless nor '
                              'team')
        if self.home_pose is not None and not self.own_robot:
            raise ConfigError('home is given: must come with own_robot: a Rumba ends on its dock')
        if self.docks and not self.own_robot:
            raise ConfigError('docks is true: must come with own_robot: a Rumba is led to its dock')
        if self.docks and self.mapping and self.home:
            raise ConfigError('home is given: must be empty with docks and mapping: the dock is where the robot begins')
        if self.mapless and len(names) > 1:
            raise ConfigError(f'team is {self.team!r}: must be empty with mapless: without a pose, a robot has nothing '
                              'to report')
        if self.mapping and len(names) > 1:
            raise ConfigError(f'team is {self.team!r}: must be empty with mapping: each robot would make a map of its '
                              'own, in a frame of its own')

    @property
    def home_pose(self) -> Optional[Pose]:
        """Where a robot without a dock ends; None: where it began.

        Raises:
            ConfigError: it is no pose.
        """
        if not self.home:
            return None
        try:
            pose = Pose(*map(float, self.home.split()))
        except (ValueError, TypeError):
            pose = Pose(math.nan, math.nan, math.nan)
        if not all(map(math.isfinite, pose)):
            raise ConfigError(f'home is {self.home!r}: must be x y theta [m, rad], with spaces between them')
        return pose

    @property
    def cleaning(self) -> CleaningConfig:
        """How to work."""
        return part(self, CleaningConfig)
