"""Where the frame of a map that a robot makes is in the world, for those who see both."""

import collections
import math
from typing import Callable, Deque, Tuple

import rospy
from geometry_msgs.msg import PoseWithCovarianceStamped

from rumba_sim.model.common.geometry import Pose, compose, inverse
from rumba_sim.ros.common.conversions import plane_pose
from rumba_sim.ros.participants.maps import FARTHEST
from rumba_sim.ros.participants.requests import Requests

KEPT = 100  # true poses: those of the scans with which a mapper may begin
FIRST_NUMBER = 1  # of the first message of a publisher; roscpp counts from 0


class MapAnchor:
    """Compares the first pose that a mapper tells, which defines the frame of its map, with the true one."""

    def __init__(self, robot: str, requests: Requests, on_found: Callable[[Pose], None]) -> None:
        """Listen to where a robot believes to be.

        Args:
            robot: its name.
            requests: to the owner of the world, in which `on_found` is called.
            on_found: called with the pose of the frame of the map in that of the world, once for each mapper.
        """
        self._requests = requests
        self._on_found = on_found
        self._poses: Deque[Tuple[rospy.Time, Pose]] = collections.deque(maxlen=KEPT)
        self._is_found = False
        self._subscriber = rospy.Subscriber(f'{robot}/amcl_pose', PoseWithCovarianceStamped, self._take)

    def note(self, stamp: rospy.Time, pose: Pose) -> None:
        """Remember where the robot really was when it was scanned from there."""
        self._poses.append((stamp, pose))

    def close(self) -> None:
        """Stop listening."""
        self._subscriber.unregister()

    def _take(self, message: PoseWithCovarianceStamped) -> None:
        """Called in a thread of rospy."""
        if message.header.seq <= FIRST_NUMBER or not self._is_found:
            self._requests.post(lambda: self._compare(message.header.stamp, plane_pose(message.pose.pose)))

    def _compare(self, stamp: rospy.Time, believed: Pose) -> None:
        true = next((pose for when, pose in self._poses if when == stamp), None)
        is_valid = all(math.isfinite(number) and abs(number) <= FARTHEST for number in believed)
        if true is not None and is_valid:
            self._is_found = True
            self._on_found(compose(true, inverse(believed)))
