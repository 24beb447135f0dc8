"""Where maps are, by name or path; what a message of a map shows; and how a simulator publishes its own."""

import atexit
import math
from typing import Optional

import numpy as np
import rospy
from nav_msgs.msg import OccupancyGrid
from nav_msgs.srv import GetMap, GetMapResponse

from rumba_sim.model.common.errors import MapError, WorldError
from rumba_sim.model.maps import named_maps
from rumba_sim.model.maps.floor_plan import FloorPlan
from rumba_sim.ros.common import conversions
from rumba_sim.ros.common.frames import MAP
from rumba_sim.ros.common.paths import absolute
from rumba_sim.ros.running import master_watch, peers

FARTHEST = 1e6  # [m] of a coordinate, at most
TOPIC = '/map'
TRUE_TOPIC = 'simulator/map'  # the true map for onlookers, while a robot makes the one on TOPIC


def map_path(name: str) -> str:
    """The absolute path of a map, given by its path or, if it is a map of this package, by its name.

    Raises:
        MapError: no map of this package has that name.
    """
    return absolute(name) if named_maps.is_path(name) else named_maps.path(name)


def floor_plan(message: OccupancyGrid) -> FloorPlan:
    """The map of a message.

    Raises:
        MapError: its size disagrees with its data, it is turned, or its resolution is no length.
    """
    info = message.info
    # A float32 in the message: the shortest decimal that gives it is what map_server read.
    resolution = float(str(np.float32(info.resolution)))
    left, bottom = info.origin.position.x, info.origin.position.y
    if len(message.data) != info.width * info.height or not message.data:
        raise MapError(f'map: {len(message.data)} cells: must be width * height, {info.width} * {info.height}')
    if not (math.isfinite(resolution) and resolution > 0.0 and abs(left) <= FARTHEST and abs(bottom) <= FARTHEST):
        raise MapError(f'map: resolution {resolution} m, origin ({left}, {bottom}) m: must be a length and a place')
    if abs(conversions.heading(info.origin.orientation)) > 1e-6:
        raise MapError('map: its origin is turned: must have yaw 0')
    cells = np.array(message.data, np.int8).reshape(info.height, info.width)
    return FloorPlan('map', cells, resolution, (left, bottom))


# --- for a node that is a simulator -----------------------------------------------------------------------------------

SERVICE = '/static_map'  # there is one simulator at a master: all would publish /clock, /map and the frames
_reservation = peers.Reservation(SERVICE)


def refuse_second() -> None:
    """Refuse to share a master with another simulator; a third one has to wait until `tell_map`.

    Raises:
        WorldError: another node already serves a map, or is about to.
    """
    atexit.register(_reservation.release)
    if not _reservation.take():
        raise WorldError('another simulator starts at the same moment: only one of them can')
    if peers.is_served(SERVICE):
        raise WorldError('another node already serves /static_map: end the other simulator or map_server, or give this '
                         'one a master of its own with ROS_MASTER_URI')


def tell_map(plan: FloorPlan, stamp: rospy.Time, topic: Optional[str] = TOPIC, frame: str = MAP) -> None:
    """Publish a map as map_server does, also at a master that is started later.

    Args:
        plan: the map.
        stamp: of the message.
        topic: on which to publish it; None: on none. The service is there anyway.
        frame: of the map.
    """
    message = conversions.grid(plan, plan.occupancy, stamp, frame)
    if topic is not None:
        rospy.Publisher(topic, OccupancyGrid, queue_size=1, latch=True).publish(message)
    rospy.Service(SERVICE, GetMap, lambda _: GetMapResponse(message))
    _reservation.release()
    master_watch.before_return(refuse_second)
    master_watch.after_return(_reservation.release)
