"""The parameter of a node that names the file of a robot that is not ours, and the frames that follow from it."""

from typing import Any, Optional

from rumba_sim.model.common.config import setting
from rumba_sim.model.settings.own_robot import OwnRobot, load
from rumba_sim.ros.common.frames import Frames, frames
from rumba_sim.ros.common.paths import absolute


def own_robot_setting() -> Any:
    """The field of a node's settings."""
    return setting('', 'path of a YAML file that says what a robot of your own is like; empty: the robot is a Rumba')


def own_robot(path: str) -> Optional[OwnRobot]:
    """What the file says; None if no file is named.

    Raises:
        ConfigError: as for `load`.
    """
    return load(absolute(path)) if path else None


def frames_of(robot: str, own: Optional[OwnRobot]) -> Frames:
    """The frames of a robot: by its file, or, if it has none, by its name."""
    if own is None:
        return frames(robot)
    odom, base = own.frames.odom.lstrip('/'), own.frames.base.lstrip('/')
    return Frames(odom, base, base, '')
