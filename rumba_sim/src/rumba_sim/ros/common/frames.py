"""Names of the frames of a robot, after REP 105."""

from typing import NamedTuple

from rumba_sim.model.simulation.robot import FIRST

MAP = 'map'
WORLD = 'world'  # of what only a simulator knows, while a robot makes a map of its own


class Frames(NamedTuple):
    """The frames of a robot's poses, velocities and readings."""

    odom: str
    base_footprint: str
    base_link: str
    laser: str


def prefix(robot: str) -> str:
    """What the names of the frames of a robot begin with, by its name: nothing for `rumba`."""
    return '' if robot == FIRST else f'{robot}/'


def frames(robot: str) -> Frames:
    """The frames of a robot by its name, which is a prefix of all names but those of `rumba`."""
    return Frames(*(prefix(robot) + name for name in Frames._fields))
