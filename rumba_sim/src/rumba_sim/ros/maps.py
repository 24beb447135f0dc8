"""Where maps lie: those of this package by name, and that of the running simulator."""

import pathlib
import time

import rospkg
import rospy

from rumba_sim.model.errors import MapError
from rumba_sim.ros import node

FLOOR_PLAN = 'floor_plan'  # below the simulator's name: the absolute path of the map that it runs
PATIENCE = 10.0  # [s] of the wall clock, with a simulator that starts at the same time
PERIOD = 0.1  # [s]


def map_path(name: str) -> str:
    """The path of a map of this package by its name; a path is a path.

    Raises:
        MapError: no map of this package has that name.
    """
    if '/' in name or name.endswith(('.yaml', '.yml')):
        return name
    maps = pathlib.Path(rospkg.RosPack().get_path('rumba_sim'), 'maps')
    known = {path.stem: str(path) for path in sorted(maps.glob('*.yaml'))}
    if name not in known:
        raise MapError(f'there is no map {name!r}: give the path of a map_server YAML file, or one of '
                       + ', '.join(known))
    return known[name]


def map_of_simulator() -> str:
    """The path of the map that the simulator of this namespace runs; waits for one that is about to start.

    Raises:
        MapError: there is no simulator.
    """
    parameter = rospy.resolve_name(f'simulator/{FLOOR_PLAN}')
    end = time.monotonic() + PATIENCE
    # A simulator that was killed leaves its parameter behind: only what serves something tells the truth.
    while not (node.is_served('simulator/spawn') and rospy.has_param(parameter)):
        if rospy.is_shutdown():
            raise rospy.ROSInterruptException('the node ends')
        if time.monotonic() > end:
            raise MapError(f'no simulator tells its map, {parameter}: start one, or name a map: _map:=studio')
        time.sleep(PERIOD)
    return str(rospy.get_param(parameter))
