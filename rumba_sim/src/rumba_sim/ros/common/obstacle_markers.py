"""The obstacles of a world as markers, for windows such as viewer and rviz: pure functions."""

from typing import Iterable, Tuple

from geometry_msgs.msg import Point, Vector3
from geometry_msgs.msg import Pose as PoseMessage
from std_msgs.msg import ColorRGBA, Header
from visualization_msgs.msg import Marker, MarkerArray

from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.simulation.obstacle import Obstacle
from rumba_sim.ros.common.conversions import quaternion

TOPIC = 'simulator/obstacles'
FIXED, MOVER = ColorRGBA(0.55, 0.4, 0.25, 1.0), ColorRGBA(0.7, 0.3, 0.5, 1.0)


def markers(obstacles: Iterable[Tuple[Obstacle, Pose]], header: Header) -> MarkerArray:
    """All obstacles where they are: each replaces what was shown before, and has its name as its namespace."""
    return MarkerArray([Marker(header=header, action=Marker.DELETEALL),
                        *(_marker(obstacle, pose, header) for obstacle, pose in obstacles)])


def _marker(obstacle: Obstacle, pose: Pose, header: Header) -> Marker:
    width = 2.0 * obstacle.radius
    return Marker(
        header=header, ns=obstacle.name, action=Marker.ADD, type=Marker.CYLINDER if obstacle.radius else Marker.CUBE,
        pose=PoseMessage(Point(pose.x, pose.y, 0.5 * obstacle.height), quaternion(pose.theta)),
        scale=Vector3(obstacle.length or width, obstacle.width or width, obstacle.height),
        color=MOVER if obstacle.stops else FIXED)
