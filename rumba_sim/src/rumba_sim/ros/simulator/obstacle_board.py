"""The obstacles of a simulator as others see them: how they come and go, and where they are."""

from typing import Any, Callable, Dict, Tuple

import rospy
from std_msgs.msg import Header
from visualization_msgs.msg import MarkerArray

from rumba_msg.srv import AddObstacleRequest, RemoveObstacleRequest
from rumba_sim.model.simulation import obstacle_file
from rumba_sim.model.simulation.world import World
from rumba_sim.ros.common.obstacle_markers import TOPIC, markers
from rumba_sim.ros.participants.requests import Requests
from rumba_sim.ros.robot.latecomers import Latecomers

RATE = 5  # [Hz] of simulated time, while something moves


class ObstacleBoard:
    """Changes and publishes the obstacles of a world; only the owner of the world calls it."""

    def __init__(self, world: World, requests: Requests, stamp: Callable[[], rospy.Time], frame: str,
                 is_exam: bool) -> None:
        """Open the topic.

        Args:
            world: where the obstacles are.
            requests: to the owner of the world.
            stamp: the time of the world.
            frame: that of the world.
            is_exam: whether nobody may see the obstacles.
        """
        self._world = world
        self._stamp = stamp
        self._frame = frame
        self._period = max(round(world.step_rate / RATE), 1)
        self._publisher = None if is_exam else rospy.Publisher(
            TOPIC, MarkerArray, Latecomers(requests, self._message), queue_size=10)

    def add(self, request: AddObstacleRequest) -> Tuple[str]:
        """Add an obstacle.

        Raises:
            RumbaError: it cannot be added.
        """
        self._world.add_obstacle(obstacle_file.obstacle(request.name, values(request)))
        self.publish()
        return ('',)

    def remove(self, request: RemoveObstacleRequest) -> Tuple[str]:
        """Take an obstacle away.

        Raises:
            WorldError: there is no obstacle of that name.
        """
        self._world.remove_obstacle(request.name)
        self.publish()
        return ('',)

    def publish_if_due(self, ticks: int) -> None:
        """Publish where the obstacles are, if some of them move and it is time for it."""
        if self._world.obstacles.has_movers and ticks % self._period == 0:
            self.publish()

    def publish(self) -> None:
        """Publish where the obstacles are, if somebody listens; others get it when they begin to listen."""
        if self._publisher is not None and self._publisher.get_num_connections():
            self._publisher.publish(self._message())

    def _message(self) -> MarkerArray:
        return markers(self._world.obstacles.poses(), Header(stamp=self._stamp(), frame_id=self._frame))


def values(request: AddObstacleRequest) -> Dict[str, Any]:
    """What a request says, by the keys of an obstacle file."""
    found: Dict[str, Any] = {'height': request.height}
    if request.radius:
        found['radius'] = request.radius
    if request.length or request.width:
        found['size'] = [request.length, request.width]
    if not request.waypoints:
        return {**found, 'pose': [request.pose.x, request.pose.y, request.pose.theta]}
    waypoints = [[waypoint.x, waypoint.y, waypoint.theta] for waypoint in request.waypoints]
    return {**found, 'waypoints': waypoints, 'speed': request.speed, 'loop': request.is_loop,
            'pause': [request.pause_min, request.pause_max]}
