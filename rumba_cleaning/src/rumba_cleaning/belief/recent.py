"""What a robot without a map knows of the floor: what it sensed lately, placed by its wheels."""

import collections
import math
from typing import Deque, List, Optional, Tuple

from rumba_cleaning.behaviour import Observation, direction
from rumba_localisation.edges import JUMP
from rumba_sim.model.common.geometry import Pose, hypot

# [m] of way at least, and twice that at most: with wheels that differ by 1 %, the heading errs by 0.04 rad after a
# metre, and what was seen at its beginning is 0.02 m off, as much as the guard spares.
REMEMBERED = 1.0


class Recent:
    """The last metres of a robot.

    Its wheels turn on, or slip, while the bumper touches something: until the robot has stopped, they count 5 cm that
    it does not drive. What it remembers would be off by as much. So it takes no pose to be beyond what it touches.
    """

    def __init__(self) -> None:
        """Remember nothing."""
        self._last: Optional[Observation] = None  # with the pose that the wheels tell
        self._lead = 0.0, 0.0  # [m] by which that is ahead of where the robot is
        self._at: Optional[Pose] = None
        self._way = 0.0  # [m]
        self._forgets_at = -1.0  # [m] of that
        self._observations: Deque[Tuple[float, Observation]] = collections.deque()  # after the way until then

    def corrected(self, observation: Observation) -> Observation:
        """The observation with the pose at which the robot must be, if it cannot pass what it touches."""
        last, self._last = self._last, observation
        pose, before = observation.pose, observation.pose if last is None else last.pose
        step = pose.x - before.x, pose.y - before.y
        left, right = observation.bumper
        if hypot(*step) > JUMP:
            self._lead = 0.0, 0.0
        elif left or right:
            angle = before.theta + direction(left, right)
            against = max(step[0] * math.cos(angle) + step[1] * math.sin(angle), 0.0)
            if last is not None and not any(last.bumper):
                against *= 0.5  # the contact began in between
            self._lead = self._lead[0] + against * math.cos(angle), self._lead[1] + against * math.sin(angle)
        return observation._replace(pose=pose._replace(x=pose.x - self._lead[0], y=pose.y - self._lead[1]))

    def noted(self, observation: Observation) -> Tuple[bool, List[Observation]]:
        """Whether it is time to forget the floor, and the observations by which to know it then, this one the last."""
        pose, last = observation.pose, self._at or observation.pose
        self._at = pose
        self._way += hypot(pose.x - last.x, pose.y - last.y)
        self._observations.append((self._way, observation))
        if self._way <= self._forgets_at:
            return False, [observation]
        self._forgets_at = self._way + REMEMBERED
        while self._way - self._observations[0][0] > REMEMBERED:
            self._observations.popleft()
        return True, [each for _, each in self._observations]
