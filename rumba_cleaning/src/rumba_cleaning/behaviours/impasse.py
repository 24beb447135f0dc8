"""Notices where a robot is stopped again and again, and closes the way ahead of it there."""

from typing import Optional

from rumba_cleaning.behaviours.travel import mark
from rumba_cleaning.belief.context import Context
from rumba_sim.model.common.geometry import Pose, hypot

NEAR = 0.2  # [m] in which a robot that is stopped is still at the same place: more than it backs off
OFTEN = 6  # times, one after the other: an obstacle in the way is outlined by fewer touches from so near; our choice


class Impasse:
    """A gap as wide as the robot: each touch marks one side of it, which is free floor once the robot has turned."""

    _place: Optional[Pose] = None
    _times = 0

    def stop(self, context: Context, pose: Pose) -> None:
        """Take note that something unknown stopped the robot at a pose."""
        place = self._place
        if place is None or hypot(pose.x - place.x, pose.y - place.y) > NEAR:
            self._place, self._times = pose, 0
        self._times += 1
        if self._times % OFTEN == 0:
            mark(context, pose, 0.0, touches=False)
