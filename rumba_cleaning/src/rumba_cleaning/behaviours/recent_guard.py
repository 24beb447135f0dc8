"""Keeps the wheels of a robot without a map on the floor, by what it saw on its last metres."""

import collections
import math
from typing import Deque, Tuple

from rumba_cleaning.behaviour import Observation
from rumba_cleaning.behaviours.caution import WITHOUT_MAP
from rumba_cleaning.behaviours.guard import Guard
from rumba_cleaning.belief.context import Context
from rumba_sim.model.geometry import wrap_angle

# [m] of wear at least, and twice that at most: what was seen at its beginning is a few centimetres off by then.
REMEMBERED = 2.0
TURN = 0.5  # [m] of wear for each metre that a wheel drives around the middle of the robot; our choice
CONTACT = 0.2  # [m] of wear for each contact: the wheels turn on, or the robot slides; our choice


class RecentGuard(Guard):
    """A guard that forgets, since the wheels soon do not tell any more where it was what the robot saw."""

    def __init__(self, context: Context) -> None:
        """Guard the robot of a context, whose plan is always that of a few metres around it."""
        super().__init__(context, WITHOUT_MAP)
        self._context = context
        self._turn = TURN * 0.5 * context.robot.drive.wheel_base  # [m/rad] of wear
        self._wear = 0.0  # [m] of way, turns and contacts
        self._forgets_at = -1.0  # [m] of that
        self._recent: Deque[Tuple[float, Observation]] = collections.deque()  # what it saw, and the wear until then

    def see(self, observation: Observation) -> None:
        """Remember what the cliff sensors see; forget what they saw long ago."""
        if self._recent:
            self._wear += self._since(self._recent[-1][1], observation)
        self._recent.append((self._wear, observation))
        if self._wear <= self._forgets_at:
            super().see(observation)
            return
        self._forgets_at = self._wear + REMEMBERED
        came_from = None  # the first time, a person has put it there
        while self._wear - self._recent[0][0] > REMEMBERED:
            came_from = self._recent.popleft()[1].pose
        self._context.begin_anew(observation.pose, came_from)
        for _, each in self._recent:
            super().see(each)

    def _since(self, last: Observation, observation: Observation) -> float:
        """The wear between observations [m]."""
        pose, before = observation.pose, last.pose
        way = math.hypot(pose.x - before.x, pose.y - before.y)
        is_contact = any(observation.bumper) and not any(last.bumper)
        return way + self._turn * abs(wrap_angle(pose.theta - before.theta)) + (CONTACT if is_contact else 0.0)


def guard(context: Context) -> Guard:
    """The guard that suits a robot with a map, or without one."""
    return Guard(context) if context.has_map else RecentGuard(context)
