"""What is behind a robot that backs off from an edge: one that pushes against that slides aside, over the edge.

The wheels turn meanwhile, so that a pose that is reckoned from them is that of a robot that backs off well; then the
cliff sensors tell, or the laser. Other poses show that it slides.
"""

import math
from typing import Optional

import numpy as np

from rumba_cleaning.behaviour import Observation
from rumba_cleaning.edges.slip import heading_between
from rumba_sim.model.common.geometry import Pose, hypot

# All figures below are our choice.
GAP = 0.03  # [m] from the body to what a beam met: three standard deviations of its range
BEHIND = 0.5  # of a beam, the least cosine of its angle to the back: to 60 degrees off
STRAIGHT = 0.8  # the same on its trail, to 37 degrees off: what stands more beside it was there as the robot came by
MOST = 0.06  # [m] back while the sensors see an edge: a robot that moves sees it no more by then, or drives along it
LEAST = 0.03  # [m] back, for its way to tell whether it slides: three times what it drives until its wheels turn
SLIDES = 0.4  # share of that by which it may be off its way: it is, along a wall at 24 degrees to its way or steeper


class Rear:
    """Watches how far a robot backs off, whether it slides, and what its laser sees behind it."""

    def __init__(self, radius: float) -> None:
        """Watch for a body of this radius [m]."""
        self._reach = radius + GAP
        self.rest()

    def rest(self) -> None:
        """The robot stands still, or somebody else drives it."""
        self._heading = 0.0  # [rad] in which it backed off last
        self._backed = 0.0  # [m] since the cliff sensors saw no edge, and about straight
        self._gone = 0.0  # [m] back since it drove ahead, and about straight
        self._off = 0.0, 0.0  # [m] from where that led, to where it is
        self._ahead = 0.0  # [m] since it backed off

    def watch(self, last: Optional[Pose], observation: Observation, driven: float) -> None:
        """Take note of an observation, and of how far the wheels have driven forward since the last pose [m]."""
        pose = observation.pose
        self._ahead = self._ahead + driven if driven >= 0.0 else 0.0
        has_turned = math.cos(pose.theta - self._heading) < BEHIND
        if has_turned or not any(observation.cliffs):
            self._backed = 0.0
        if has_turned or self._ahead > LEAST:
            self._gone, self._off = 0.0, (0.0, 0.0)
        if driven < 0.0:
            self._heading = pose.theta
            self._backed -= driven if any(observation.cliffs) else 0.0
            if last is not None:
                along = heading_between(last, pose)
                self._gone -= driven
                self._off = (self._off[0] + pose.x - last.x - driven * math.cos(along),
                             self._off[1] + pose.y - last.y - driven * math.sin(along))

    def is_closed(self, observation: Observation, is_on_trail: bool = False) -> bool:
        """Whether the robot must not go back.

        On its trail, nothing is behind it that it did not pass, but for what moves; that is seen by a laser.
        """
        if is_on_trail and observation.scan is not None:
            return self._is_seen(observation, STRAIGHT)
        return self._backed > MOST or self._slides or self._is_seen(observation, BEHIND)

    @property
    def _slides(self) -> bool:
        """Whether the robot does not come back by the way that its wheels drive."""
        return self._gone > LEAST and hypot(*self._off) > SLIDES * self._gone

    def _is_seen(self, observation: Observation, least: float) -> bool:
        """Whether the laser sees something behind, by a beam whose angle to the back has at least that cosine."""
        if observation.scan is None:
            return False
        points = observation.scan.points
        ranges = np.hypot(points[:, 0], points[:, 1])
        return bool(((ranges < self._reach) & (points[:, 0] < -least * ranges)).any())
