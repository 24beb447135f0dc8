"""Notices that a robot does not get out of a small area: obstacles are around it, or something that moves pins it."""

from typing import Optional, Tuple

from rumba_cleaning.behaviours.travel import LONGEST
from rumba_sim.model.common.geometry import Pose

AREA = 1.0  # [m] side of the area: what is larger is floor that is worth cleaning; our choice
CLEANING = 400.0  # [s] that a robot may clean there: longer than it may try at one place; our choice
RETURNING = 120.0  # [s] that it may try to get home from there after that; our choice
REASON = f'has not got out of {AREA:g} m by {AREA:g} m for {CLEANING:g} s: something is all around the robot'


class Confinement:
    """Counts for how long a robot has been within a small area, although it was to drive.

    Attributes:
        time: for which it has [s].
        is_known: whether it was given up to clean there, so that the robot has less time to get home.
    """

    def __init__(self) -> None:
        """Be free."""
        self.is_known = False
        self.rest()

    def rest(self) -> None:
        """Begin to count from the next pose on."""
        self.time = 0.0
        self._area: Optional[Tuple[float, float, float, float]] = None  # [m] left, bottom, right, top

    def watch(self, pose: Pose, dt: float) -> None:
        """Take note of where a robot is that has been driving, or planning how to, for `dt` [s]."""
        left, bottom, right, top = self._area or (pose.x, pose.y, pose.x, pose.y)
        self._area = min(left, pose.x), min(bottom, pose.y), max(right, pose.x), max(top, pose.y)
        self.time += min(dt, LONGEST)
        if max(self._area[2] - self._area[0], self._area[3] - self._area[1]) > AREA:
            self.rest()
            self.is_known = False

    @property
    def is_hopeless(self) -> bool:
        """Whether the robot has tried for too long."""
        return self.time > (RETURNING if self.is_known else CLEANING)
