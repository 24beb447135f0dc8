"""Notices that a robot which is to drive does not get away from a place."""

from typing import Optional

from rumba_sim.model.common.geometry import Pose, hypot

NEAR = 0.3  # [m] in which a robot is still at the same place: as far as it backs off, twice
LONGEST = 300.0  # [s] that it may try to get away; our choice


class Standstill:
    """Counts for how long a robot has been at one place, although it was to drive.

    Attributes:
        time: for which it has tried [s].
    """

    _place: Optional[Pose] = None
    time = 0.0

    @property
    def is_hopeless(self) -> bool:
        """Whether the robot has tried for too long: what keeps it may never end by itself."""
        return self.time > LONGEST

    def watch(self, pose: Pose, dt: float) -> None:
        """Take note of where a robot is that has been driving, or planning how to, for `dt` [s]."""
        place = self._place
        if place is None or hypot(pose.x - place.x, pose.y - place.y) > NEAR:
            self._place, self.time = pose, 0.0
        else:
            self.time += dt
