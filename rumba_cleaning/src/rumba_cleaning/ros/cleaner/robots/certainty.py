"""How certain the pose of a robot is, by what its localisation tells."""

import math
from typing import Callable, Optional

import rospy
from geometry_msgs.msg import PoseWithCovarianceStamped

from rumba_cleaning.behaviour import CERTAIN, UNKNOWN, Covariance
from rumba_cleaning.ros.cleaner.robots.location import QUEUE
from rumba_sim.ros.running import peers

TOPIC = 'amcl_pose'
STALE = 2.0  # [s] of the robot's time without a pose: the laser, or the localisation, is silent


class Certainty:
    """The newest amcl_pose of a robot. If nobody publishes it, map -> odom is taken for true.

    Attributes:
        stamp: of the newest one; 0 before the first.
    """

    def __init__(self, robot: str, on_pose: Callable[[], None]) -> None:
        """Listen to a robot, by its name; `on_pose` is called in a thread of rospy."""
        self.stamp = rospy.Time()
        self._covariance: Optional[Covariance] = None
        self._on_pose = on_pose
        self._subscriber = rospy.Subscriber(f'{robot}/{TOPIC}', PoseWithCovarianceStamped, self._take, queue_size=QUEUE)
        self._is_expected = _has_publisher(self._subscriber.resolved_name)  # and it was not heard yet

    def _take(self, message: PoseWithCovarianceStamped) -> None:
        numbers = message.pose.covariance
        x, y, theta = ((numbers[6 * row], numbers[6 * row + 1], numbers[6 * row + 5]) for row in (0, 1, 5))
        self._covariance = (x, y, theta) if all(map(math.isfinite, (*x, *y, *theta))) else UNKNOWN
        self.stamp = message.header.stamp
        self._is_expected = False
        self._on_pose()

    @property
    def is_told(self) -> bool:
        """Whether a localisation tells it, or was there already when this node started."""
        return self._is_expected or bool(self._subscriber.get_num_connections())

    def forget(self) -> None:
        """Know nothing of what was told of a time that is over."""
        self._covariance, self.stamp = None, rospy.Time()

    def covariance(self, now: rospy.Time) -> Covariance:
        """Of x, y and heading, at a time of the robot."""
        if self._covariance is None:
            return CERTAIN
        return self._covariance if (now - self.stamp).to_sec() <= STALE else UNKNOWN


def _has_publisher(topic: str) -> bool:
    """Whether the master knows a publisher of a topic, given by its full name."""
    try:
        return bool(peers.publishers(topic))
    except peers.NO_ANSWER:  # it is being restarted
        return False
