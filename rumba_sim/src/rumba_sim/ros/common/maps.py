"""Where maps lie, those of this package by name, and that of the running simulator; and how that tells it."""

import os
import pathlib
import time

import rospkg
import rospy
from nav_msgs.msg import OccupancyGrid
from nav_msgs.srv import GetMap, GetMapResponse

from rumba_sim.model.errors import MapError, WorldError
from rumba_sim.model.floor_plan import FloorPlan
from rumba_sim.ros.common import conversions, node

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


def map_of_simulator(simulator: str) -> str:
    """The path of the map that a simulator runs, by its name; waits for one that is about to start.

    Raises:
        MapError: there is no simulator.
    """
    parameter = rospy.resolve_name(f'{simulator}/{FLOOR_PLAN}')
    end = time.monotonic() + PATIENCE
    # A simulator that was killed leaves its parameter behind: only what serves something tells the truth.
    while not (node.is_served(f'{simulator}/reset') and rospy.has_param(parameter)):
        if rospy.is_shutdown():
            raise rospy.ROSInterruptException('the node ends')
        if time.monotonic() > end:
            raise MapError(f'no simulator tells its map, {parameter}: start one, or name a map: _map:=studio')
        time.sleep(PERIOD)
    return str(rospy.get_param(parameter))


# --- for a node that is a simulator -----------------------------------------------------------------------------------

def refuse_second() -> None:
    """Refuse to share a master with another simulator: they would fight over /clock, /map and the frames.

    Raises:
        WorldError: somebody serves a map already.
    """
    if node.is_served('/static_map'):
        raise WorldError('/static_map is served already: end the other simulator, or map_server, or give this one a '
                         'master of its own with ROS_MASTER_URI')


def tell_map(plan: FloorPlan, path: str, stamp: rospy.Time) -> None:
    """Publish a map as map_server does, and tell by a parameter where it lies.

    The parameter is good once the node serves `~reset`: that must come later.
    """
    message = conversions.grid(plan, plan.occupancy, stamp)
    rospy.Publisher('/map', OccupancyGrid, queue_size=1, latch=True).publish(message)
    rospy.Service('/static_map', GetMap, lambda _: GetMapResponse(message))
    rospy.set_param(f'~{FLOOR_PLAN}', os.path.abspath(path))
