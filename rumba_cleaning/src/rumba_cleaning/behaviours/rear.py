"""What is behind a robot that backs off from an edge: one that pushes against that slides aside, over the edge.

The wheels turn meanwhile, so that a pose that is reckoned from them is that of a robot that backs off well.
"""

import math

import numpy as np

from rumba_cleaning.behaviour import Observation

# All figures below are our choice.
GAP = 0.03  # [m] from the body to what a beam met: three standard deviations of its range
BEHIND = 0.5  # of a beam, the least cosine of its angle to the back: to 60 degrees off
STRAIGHT = 0.8  # the same on its trail, to 37 degrees off: what stands more beside it was there as the robot came by
MOST = 0.06  # [m] back while the sensors see an edge: a robot that moves sees it no more by then, or drives along it


class Rear:
    """Watches how far a robot backs off, and what its laser sees behind it."""

    def __init__(self, radius: float) -> None:
        """Watch for a body of this radius [m]."""
        self._reach = radius + GAP
        self.rest()

    def rest(self) -> None:
        """The robot stands still, or somebody else drives it."""
        self._backed = 0.0  # [m] since the cliff sensors saw no edge, and about straight
        self._heading = 0.0  # [rad] in which it backed off last

    def watch(self, observation: Observation, driven: float) -> None:
        """Take note of an observation, and of how far the wheels have driven forward since the one before [m]."""
        heading = observation.pose.theta
        if not any(observation.cliffs) or math.cos(heading - self._heading) < BEHIND:
            self._backed = 0.0
        if any(observation.cliffs) and driven < 0.0:
            self._backed, self._heading = self._backed - driven, heading

    def is_closed(self, observation: Observation, is_on_trail: bool = False) -> bool:
        """Whether the robot must not go back.

        On its trail, nothing is behind it that it did not pass, but for what moves; that is seen by a laser.
        """
        if is_on_trail and observation.scan is not None:
            return self._is_seen(observation, STRAIGHT)
        return self._backed > MOST or self._is_seen(observation, BEHIND)

    def _is_seen(self, observation: Observation, least: float) -> bool:
        """Whether the laser sees something behind, by a beam whose angle to the back has at least that cosine."""
        if observation.scan is None:
            return False
        points = observation.scan.points
        ranges = np.hypot(points[:, 0], points[:, 1])
        return bool(((ranges < self._reach) & (points[:, 0] < -least * ranges)).any())
