"""Where maps are, by name or path; and how a simulator publishes its own."""

import atexit

import rospy
from nav_msgs.msg import OccupancyGrid
from nav_msgs.srv import GetMap, GetMapResponse

from rumba_sim.model import named_maps
from rumba_sim.model.errors import WorldError
from rumba_sim.model.floor_plan import FloorPlan
from rumba_sim.ros.common import conversions, master_watch, peers
from rumba_sim.ros.common.paths import absolute


def map_path(name: str) -> str:
    """The absolute path of a map, given by its path or, if it is a map of this package, by its name.

    Raises:
        MapError: no map of this package has that name.
    """
    return absolute(name) if named_maps.is_path(name) else named_maps.path(name)


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


def tell_map(plan: FloorPlan, stamp: rospy.Time) -> None:
    """Publish a map as map_server does, also at a master that is started later."""
    message = conversions.grid(plan, plan.occupancy, stamp)
    rospy.Publisher('/map', OccupancyGrid, queue_size=1, latch=True).publish(message)
    rospy.Service(SERVICE, GetMap, lambda _: GetMapResponse(message))
    _reservation.release()
    master_watch.before_return(refuse_second)
    master_watch.after_return(_reservation.release)
