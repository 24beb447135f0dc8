"""Names of the frames of a robot, after REP 105."""

from typing import NamedTuple

from rumba_sim.model.robot import FIRST

MAP = 'map'
WORLD = 'world'  # of what only a simulator knows, while a robot makes a map of its own


class Frames(NamedTuple):
    """The frames of a robot's poses, velocities and readings."""

    odom: str
    base_footprint: str
    base_link: str
    laser: str


def frames(robot: str) -> Frames:
    """The frames of a robot by its name, which is a prefix of all names but those of `rumba`."""
    prefix = '' if robot == FIRST else f'{robot}/'
    return Frames(*(prefix + name for name in Frames._fields))
