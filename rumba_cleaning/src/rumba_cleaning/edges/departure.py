"""A way from edges in two parts: the robot turns on the spot, either way round, and then drives straight on or back.

The shorter way round may be closed by an edge, and a turn alone may lead nowhere.
"""

import itertools
import math
from typing import Iterator, NamedTuple, Optional

import numpy as np

from rumba_cleaning.behaviour import Command
from rumba_cleaning.edges.cliff_map import CliffMap
from rumba_sim.model.common.geometry import Pose, wrap_angle
from rumba_sim.model.kernel import Array
from rumba_sim.model.settings.robot_config import DriveConfig

# All figures below are our choice.
TURN = 0.5  # [rad/s]
SLOW = 0.1  # [m/s]
LENGTH = 0.35  # [m] straight on
STEP = math.radians(5.0)  # between headings, and between points of a circle that are looked at
SPACING = 0.01  # [m] between points of a line that are looked at
AIMED = math.radians(2.0)  # nearer than this, the robot heads where it is to go
PAST = 0.3  # [rad] beyond that heading, at most, it turns back; farther off, it has not come to it yet
PUSH = 0.005  # [m] by which it may come nearer to a wall: it may touch that already


class Departure(NamedTuple):
    """Where a robot turns, and where it drives from there."""

    heading: float  # to which it turns [rad]
    side: int  # to which: 1 is the left, -1 the right
    way: int  # 1 is ahead, -1 back

    def command(self, pose: Pose) -> Command:
        """What a robot does at a pose."""
        off = wrap_angle(self.heading - pose.theta)
        if abs(off) <= AIMED:
            return Command(self.way * SLOW, 0.0)
        is_past = abs(off) < PAST and off * self.side < 0.0
        return Command(0.0, TURN * (-self.side if is_past else self.side))


class Search:
    """Looks for departures of one robot."""

    def __init__(self, cliff_map: CliffMap, drive: DriveConfig) -> None:
        """Look on a floor, for a robot with this drive."""
        self._cliff_map, self._half, self._radius = cliff_map, 0.5 * drive.wheel_base, drive.radius

    def find(self, pose: Pose, reserve: float, least: float, cells: int) -> Optional[Departure]:
        """The departure with the smallest turn; None: there is none.

        Args:
            pose: of the robot.
            reserve: from its wheels to an edge on the way [m].
            least: from its middle to an edge at the end [m].
            cells: beside floor that it knows, which it takes for floor too, if it has met a cliff that no map shows.
        """
        turns = {side: self._turns(pose, side, reserve, cells) for side in (1, -1)}
        headings = ((side, heading) for pair in zip(turns[1], turns[-1]) for side, heading in zip((1, -1), pair))
        for (side, heading), way in itertools.product(headings, (1, -1)):
            if heading is not None and self._leads_away(pose._replace(theta=heading), way, reserve, least, cells):
                return Departure(heading, side, way)
        return None

    def _turns(self, pose: Pose, side: int, reserve: float, cells: int) -> Iterator[Optional[float]]:
        """The headings that it can turn to on one side, the nearest first [rad]; None for each that it cannot."""
        is_open = True
        for count in range(round(2.0 * math.pi / STEP)):
            heading = pose.theta + side * count * STEP
            is_open = is_open and self._is_safe(self._wheels(pose._replace(theta=heading), np.zeros(1)), reserve, cells)
            yield heading if is_open else None

    def _leads_away(self, pose: Pose, way: int, reserve: float, least: float, cells: int) -> bool:
        """Whether straight on or back from a pose, there is floor, and no wall, and at the end room to turn."""
        ahead = way * np.arange(0.0, LENGTH, SPACING)
        if not self._is_safe(self._wheels(pose, ahead), reserve, cells):
            return False
        middle = np.array(pose[:2]) + ahead[:, np.newaxis] * (math.cos(pose.theta), math.sin(pose.theta))
        walls = self._cliff_map.near_walls(middle)
        return bool(walls.min() >= min(walls[0], self._radius) - PUSH
                    and self._cliff_map.clearances(middle[-1:])[0] >= least)

    def _wheels(self, pose: Pose, ahead: Array) -> Array:
        """The points under both wheels after so many distances (any) straight on [m]: float64 (any, 2)."""
        cos, sin = math.cos(pose.theta), math.sin(pose.theta)
        middle = np.stack([pose.x + ahead * cos, pose.y + ahead * sin], axis=-1)
        aside = self._half * np.array([-sin, cos])
        return np.concatenate([middle + aside, middle - aside])

    def _is_safe(self, points: Array, reserve: float, cells: int) -> bool:
        """Whether wheels can be at points (any, 2) [m]."""
        if self._cliff_map.clearances(points).min() < reserve:
            return False
        return not self._cliff_map.seen or self._cliff_map.are_known(points, cells)
