"""Where floor ends, by what the cliff sensors of a robot tell on its way."""

import math
from typing import List, NamedTuple, Optional, Sequence, Tuple

from rumba_sim.model.common.geometry import Pose, compose
from rumba_sim.model.settings.robot_config import RobotConfig

JUMP = 0.5  # [m] from one pose to the next: somebody put the robot elsewhere; our choice, as in `Swept`


class Edge(NamedTuple):
    """Where a sensor came over an edge."""

    x: float  # half way between two readings [m], map frame
    y: float
    beyond: Tuple[float, float]  # where it was over no floor [m]


class Edges:
    """The newest reading of the cliff sensors, by which the next one tells where an edge is."""

    def __init__(self, robot: RobotConfig) -> None:
        """Know no reading."""
        cliff = robot.cliff
        self._sensors = [Pose(cliff.distance * math.cos(angle), cliff.distance * math.sin(angle), 0.0)
                         for angle in cliff.angles]
        self._last: Optional[Tuple[Pose, Tuple[bool, ...]]] = None

    def met(self, pose: Pose, cliffs: Sequence[bool]) -> List[Edge]:
        """Take a reading, and tell where edges are.

        A sensor that saw floor before came over an edge since then: that lies half way. One that saw none before either
        was beyond an edge at that reading; it need not be any more, since it holds what it saw since then.

        Args:
            pose: of the robot, map frame.
            cliffs: whether there is no floor under each sensor, from left to right.
        """
        last, before = (pose, ()) if self._last is None else self._last
        if not before or math.hypot(pose.x - last.x, pose.y - last.y) > JUMP:
            last, before = pose, tuple(cliffs)
        self._last = pose, tuple(cliffs)
        found = []
        for sensor, is_over, was_over in zip(self._sensors, cliffs, before):
            if is_over:
                since = compose(last, sensor)
                here = since if was_over else compose(pose, sensor)
                found.append(Edge(0.5 * (since.x + here.x), 0.5 * (since.y + here.y), (here.x, here.y)))
        return found
