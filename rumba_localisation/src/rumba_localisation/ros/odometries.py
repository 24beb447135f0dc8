"""The newest poses by odometry, to be found by the stamp of a scan."""

import bisect
from typing import List, NamedTuple, Optional

import rospy

from rumba_sim.model.common.geometry import Pose, wrap_angle

KEPT = 200  # messages: four seconds at 50 Hz


class Stamped(NamedTuple):
    """A pose by odometry and its time."""

    stamp: rospy.Time
    pose: Pose


class Odometries:
    """Poses in the order of their stamps."""

    def __init__(self) -> None:
        """None came yet."""
        self._known: List[Stamped] = []

    def add(self, stamp: rospy.Time, pose: Pose) -> None:
        """A message came; one that is older than the newest begins a new time: a simulator was started again."""
        if self._known and stamp < self._known[-1].stamp:
            self._known.clear()
        self._known.append(Stamped(stamp, pose))
        del self._known[:-KEPT]

    def at(self, stamp: rospy.Time) -> Optional[Pose]:
        """The pose at a time, between two messages if need be; None while it is not known."""
        index = bisect.bisect_left([each.stamp for each in self._known], stamp)
        if index == len(self._known):
            return None
        after = self._known[index]
        if after.stamp == stamp:
            return after.pose
        return _between(self._known[index - 1], after, stamp) if index > 0 else None

    def is_before(self, stamp: rospy.Time) -> bool:
        """Whether a time is older than all that is known, so that its pose will never be."""
        return bool(self._known) and stamp < self._known[0].stamp


def _between(before: Stamped, after: Stamped, stamp: rospy.Time) -> Pose:
    share = (stamp - before.stamp).to_sec() / (after.stamp - before.stamp).to_sec()
    (x, y, theta), (to_x, to_y, to_theta) = before.pose, after.pose
    turn = wrap_angle(to_theta - theta)
    return Pose(x + share * (to_x - x), y + share * (to_y - y), wrap_angle(theta + share * turn))
