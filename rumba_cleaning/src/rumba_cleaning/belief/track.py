"""Where a robot has driven on a floor that is being mapped: there it fits, even if the map shows too little room."""

from typing import Callable, Dict, Optional, Tuple

import numpy as np

from rumba_cleaning.belief.limits import limited
from rumba_cleaning.belief.swept import JUMP
from rumba_sim.model.common.geometry import Pose, hypot
from rumba_sim.model.kernel import Array
from rumba_sim.model.maps.floor_plan import FloorPlan

STEP = 0.01  # [m] between points that are remembered: less than a cell, so that no node is left out
DEEP = 0.5  # of the distance that it needs, so near to what the map shows no robot was: its pose was wrong


class Track:
    """The way that the middle of a robot has come: on this it can go back."""

    def __init__(self) -> None:
        """Know no way."""
        self._points: Dict[Tuple[int, int], Tuple[float, float]] = {}  # by squares of STEP, map frame [m]
        self._last: Optional[Pose] = None

    def follow(self, pose: Pose) -> None:
        """Take note of a new pose of the robot, map frame."""
        last, self._last = self._last, pose
        away = 0.0 if last is None else hypot(pose.x - last.x, pose.y - last.y)
        if last is None or away > JUMP:
            last, away = pose, 0.0
        count = int(away / STEP) + 1
        for index in range(1, count + 1):
            share = index / count
            self._add(last.x + share * (pose.x - last.x), last.y + share * (pose.y - last.y))

    def _add(self, x: float, y: float) -> None:
        self._points.setdefault((round(x / STEP), round(y / STEP)), (x, y))

    def move(self, moved: Callable[[Array], Array]) -> None:
        """Follow a redrawn map; `moved` tells where on it are points (any, 2) [m] of the one before."""
        points = moved(np.array(list(self._points.values()))).tolist() if self._points else []
        self._points, self._last = {}, None
        for x, y in points:
            self._add(x, y)

    def on(self, plan: FloorPlan, needed: float) -> FloorPlan:
        """A plan that shows on the way as much room as a robot needs.

        Args:
            plan: of the floor.
            needed: distance to what is nearest [m].
        """
        if not self._points:
            return plan
        corners = np.floor((np.array(list(self._points.values())) - plan.origin) / plan.resolution).astype(np.intp)
        nodes = (corners[:, np.newaxis, ::-1] + [(0, 0), (0, 1), (1, 0), (1, 1)]).reshape(-1, 2)
        rows, columns = limited(nodes, 0, np.array(plan.clearance.shape) - 1).T
        found = []
        for clearance in (plan.clearance, plan.safe_clearance):
            raised = clearance.copy()
            raised[rows, columns] = np.where(clearance[rows, columns] > DEEP * needed,
                                             np.maximum(clearance[rows, columns], needed), clearance[rows, columns])
            found.append(raised)
        return plan.with_clearance(*found)
