"""What a robot that is not ours is like, by a file of its owner: settings named as those of a Rumba, and its frames."""

import dataclasses
from typing import Any, Mapping, NamedTuple, Optional

from rumba_sim.model.common import yaml_file
from rumba_sim.model.common.config import from_mapping, part, section, setting
from rumba_sim.model.common.errors import ConfigError
from rumba_sim.model.settings.mounting import Mounting
from rumba_sim.model.settings.robot_config import RobotConfig


@dataclasses.dataclass(frozen=True)
class FramesConfig:
    """Names of frames."""

    odom: str = setting('odom', 'frame of the odometry')
    base: str = setting('base_link', 'frame of the robot, in the middle between its wheels, x ahead')


@dataclasses.dataclass(frozen=True)
class OwnRobotConfig(RobotConfig):
    """What the file may say."""

    frames: FramesConfig = section(FramesConfig, 'names of frames')


class OwnRobot(NamedTuple):
    """What the file says."""

    config: RobotConfig
    frames: FramesConfig
    mounting: Optional[Mounting]  # of the laser, if the file has its x, y, yaw or upside_down; None: tf tells it


def load(path: str) -> OwnRobot:
    """Read a file.

    Raises:
        ConfigError: it cannot be read, or a key or a value is wrong; the message begins with the path.
    """
    given = yaml_file.read_mapping(path, ConfigError)
    settings = from_mapping(OwnRobotConfig, given, path)
    for name, value in vars(settings.frames).items():
        if not value.strip('/'):
            raise ConfigError(f'{path}: frames/{name} is {value!r}: must be the name of a frame')
    return OwnRobot(part(settings, RobotConfig), settings.frames, _mounting(settings, given.get('laser')))


def _mounting(settings: RobotConfig, laser: Any) -> Optional[Mounting]:
    if not isinstance(laser, Mapping) or not set(laser) & set(Mounting._fields):
        return None
    return Mounting(*(getattr(settings.laser, name) for name in Mounting._fields))
