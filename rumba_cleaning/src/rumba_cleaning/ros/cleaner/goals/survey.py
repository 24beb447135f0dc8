"""The plan of a floor that is being mapped: by the topic of the map, and by where the robot stood on its dock."""

import time
from typing import Any, Optional, Tuple

import numpy as np
import rospy
from geometry_msgs.msg import PoseArray, PoseStamped
from nav_msgs.msg import OccupancyGrid

from rumba_cleaning.survey import Survey
from rumba_sim.model.common.errors import MapError
from rumba_sim.model.kernel import Array
from rumba_sim.model.maps.floor_plan import FloorPlan
from rumba_sim.ros.common.conversions import plane_pose
from rumba_sim.ros.participants.maps import floor_plan

MAP, DOCK, FRAMES = '/map', 'dock_pose', 'key_frames'  # topics
COMPLAIN_AFTER = 5.0  # [s] of the wall clock without a map
PERIOD = 0.05  # [s] between two looks for the first one


class SurveyListener(Survey):
    """Tells the newest plan that came."""

    def __init__(self, robot: str) -> None:
        """Listen to the map, and to the dock and the key frames of a robot, by its name."""
        self._map: Optional[OccupancyGrid] = None
        self._dock: Optional[PoseStamped] = None
        self._known: Optional[Tuple[Any, Any, FloorPlan]] = None  # after the messages of which it was made
        self._newest: Optional[PoseArray] = None  # key frames
        self._shown: Optional[PoseArray] = None  # those of a map that came
        self._frames: Array = np.empty((0, 3))  # these as an array
        rospy.Subscriber(MAP, OccupancyGrid, self._take_map, queue_size=1)
        rospy.Subscriber(f'{robot}/{DOCK}', PoseStamped, self._take_dock, queue_size=1)
        rospy.Subscriber(f'{robot}/{FRAMES}', PoseArray, self._take_frames, queue_size=1)

    def _take_map(self, message: OccupancyGrid) -> None:
        self._map = message

    def _take_dock(self, message: PoseStamped) -> None:
        self._dock = message

    def _take_frames(self, message: PoseArray) -> None:
        self._newest = message

    def wait(self) -> None:
        """Wait for the first map, until ROS shuts down."""
        begin, has_complained = time.monotonic(), False
        while self._map is None and not rospy.is_shutdown():
            if time.monotonic() - begin > COMPLAIN_AFTER and not has_complained:
                has_complained = True
                rospy.logwarn(f'waiting for a map on {MAP}: start the node mapper of rumba_localisation')
            time.sleep(PERIOD)

    def plan(self) -> FloorPlan:
        """The newest plan; the same object as long as it is the same.

        Raises:
            MapError: no map came, or it makes no sense.
        """
        told, dock = self._map, self._dock
        if told is None:
            raise MapError(f'no map came on {MAP} yet')
        if self._known is None or self._known[0] is not told or self._known[1] is not dock:
            plan = floor_plan(told)
            plan.dock = None if dock is None else plane_pose(dock.pose)
            self._known = told, dock, plan
        return self._known[2]

    def frames(self) -> Array:
        """The key frames of the newest map, or of one before that if they have not come yet; none if nobody tells any.

        The same object until others came.
        """
        told, newest = self._map, self._newest
        if told is not None and newest is not None and newest is not self._shown and (
                told.header.stamp >= newest.header.stamp):
            self._shown = newest
            self._frames = np.array([plane_pose(pose) for pose in newest.poses], np.float64).reshape(-1, 3)
        return self._frames
