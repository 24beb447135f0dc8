"""Keeps the wheels of a robot without a map on the floor, by what it saw on its last metres."""

import collections
from typing import Deque, Optional, Tuple

from rumba_cleaning.behaviour import Observation
from rumba_cleaning.edges.guard import Guard, Knowledge
from rumba_sim.model.common.geometry import Pose, hypot

# [m] of way at least, and twice that at most: with wheels that differ by 1 %, the heading errs by 0.04 rad after a
# metre, and what was seen at its beginning is 0.02 m off, as much as the guard spares.
REMEMBERED = 1.0
# A robot that forgets comes to every edge as if it had never seen it: faster ones fell down the stairs of the
# apartment, one of them in a tight bend.
SAFE_SPEED = 0.25  # [m/s] of its wheels, in any bend
WARY_GUESS = 1  # cells: without these, what it has forgotten holds it beside edges, until it gives up; our choice


class RecentGuard(Guard):
    """A guard that forgets, since the wheels soon do not tell any more where it was what the robot saw."""

    def __init__(self, context: Knowledge) -> None:
        """Guard the robot of a context, whose plan is always that of a few metres around it."""
        super().__init__(context, SAFE_SPEED, SAFE_SPEED, WARY_GUESS)
        self._at: Optional[Pose] = None
        self._way = 0.0  # [m]
        self._forgets_at = -1.0  # [m] of that
        self._recent: Deque[Tuple[float, Observation]] = collections.deque()  # what it saw, after the way until then

    def see(self, observation: Observation) -> None:
        """Remember what the cliff sensors see; forget what they saw long ago."""
        pose, last = observation.pose, self._at or observation.pose
        self._at = pose
        self._way += hypot(pose.x - last.x, pose.y - last.y)
        self._recent.append((self._way, observation))
        if self._way <= self._forgets_at:
            super().see(observation)
            return
        self._forgets_at = self._way + REMEMBERED
        self._context.begin_anew(pose)
        while self._way - self._recent[0][0] > REMEMBERED:
            self._recent.popleft()
        for _, each in self._recent:
            super().see(each)


def guard(context: Knowledge) -> Guard:
    """The guard that suits a robot with a map, or without one."""
    return Guard(context) if context.has_map else RecentGuard(context)
