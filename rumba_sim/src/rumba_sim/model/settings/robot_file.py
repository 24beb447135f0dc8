"""Files of what a robot is like: YAML with the settings of a robot that differ from the defaults."""

from rumba_sim.model.common.config import from_mapping
from rumba_sim.model.common.errors import ConfigError
from rumba_sim.model.common.yaml_file import read_mapping
from rumba_sim.model.settings.robot_config import RobotConfig


def load(path: str) -> RobotConfig:
    """Read a file with any of the sections and settings of a robot in `config/rumba.yaml`.

    Args:
        path: path of the file; empty: a robot with the defaults.

    Raises:
        ConfigError: the file cannot be read, or a setting is unknown, of the wrong type or out of range; the message
            begins with the path.
    """
    return from_mapping(RobotConfig, read_mapping(path, ConfigError), path) if path else RobotConfig()
