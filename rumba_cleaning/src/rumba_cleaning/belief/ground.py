"""Where a robot can stand and how it gets from place to place: the floor plan, and the obstacles that it met."""

import math
from typing import List, Optional, Tuple

import numpy as np
from scipy import ndimage
from skimage import graph

from rumba_sim.model.constants import constants
from rumba_sim.model.floor_plan import FloorPlan
from rumba_sim.model.kernel import Array
from rumba_sim.model.robot_config import RobotConfig

ANY_RATE = 50  # [Hz] how near a robot can come to a wall does not depend on it
MARGIN = 0.003  # [m] that ways keep off what a robot would touch
GROWTH, LARGEST = 0.02, 0.25  # [m] of the radius of an obstacle that is met again
EASE = 0.04  # [m] of room to spare beside a straight way
AT_ONCE = 0.4  # [m] so near a place is driven to without regard to that
DETOUR = 2.0  # [m] around both ends a way is looked for first
SHY = 0.1  # [m] within so much of the nearest way possible, ways cost more ...
SHYNESS = 2.0  # ... up to so many times their length more


class Ground:
    """Places are [m] in the map frame, `Array` float64 (any, 2); nodes are (row, column) of `FloorPlan.room`.

    Attributes:
        plan: the floor plan.
        reach: how near the middle of the robot can come to a wall [m].
        room: as `FloorPlan.room`, obstacles that were met included.
        fits: bool (rows + 1, columns + 1), at which nodes the robot can stand.
    """

    def __init__(self, plan: FloorPlan, robot: RobotConfig) -> None:
        """Know what the plan shows."""
        self.plan = plan
        self.reach = float(constants(robot, plan, ANY_RATE)[0]['reach'])
        self.forget()

    def forget(self) -> None:
        """Forget all obstacles that were met."""
        self.room = self.plan.safe_clearance.copy()
        self._marks: List[Tuple[float, float, float]] = []  # x, y, radius [m]
        self._changed()

    @property
    def has_marks(self) -> bool:
        """Whether obstacles were met."""
        return bool(self._marks)

    def mark(self, x: float, y: float, radius: float) -> None:
        """Remember that there is a round obstacle; one that is met again is larger than it was thought to be."""
        again = [other for mark_x, mark_y, other in self._marks if math.hypot(mark_x - x, mark_y - y) < radius + other]
        radius = min(max([radius, *(other + GROWTH for other in again)]), LARGEST)
        self._marks.append((x, y, radius))
        rows, columns = self.room.shape
        res = self.plan.resolution
        row, column = self.node(x, y)
        size = int((radius + self.reach + SHY) / res) + 2
        top, left = max(row - size, 0), max(column - size, 0)
        near_y, near_x = np.ogrid[top:min(row + size + 1, rows), left:min(column + size + 1, columns)]
        distance = np.hypot(near_x * res + self.plan.origin[0] - x, near_y * res + self.plan.origin[1] - y) - radius
        window = self.room[top:row + size + 1, left:column + size + 1]
        np.minimum(window, np.maximum(distance, 0.0), out=window)
        self._changed()

    def _changed(self) -> None:
        self.fits = self.room >= self.reach + MARGIN
        self._marked = ~self.fits & (self.room < self.plan.safe_clearance)
        self._nearest: Optional[Array] = None

    # --- places and nodes -----------------------------------------------------------------------------------------

    def node(self, x: float, y: float) -> Tuple[int, int]:
        """The node nearest to a place."""
        row, column = self.nodes(np.array([[x, y]]))[0]
        return int(row), int(column)

    def nodes(self, places: Array) -> Array:
        """The nodes nearest to places: int (any, 2)."""
        nodes = np.rint((np.asarray(places) - self.plan.origin) / self.plan.resolution).astype(np.intp)[:, ::-1]
        return np.clip(nodes, 0, np.array(self.room.shape) - 1)

    def places(self, nodes: Array) -> Array:
        """Where nodes (any, 2), which need not be whole, lie."""
        return np.asarray(nodes, np.float64)[:, ::-1] * self.plan.resolution + self.plan.origin

    def are_free(self, places: Array) -> Array:
        """At which of the places the robot can stand: bool (any)."""
        nodes = self.nodes(places)
        return np.asarray(self.fits[nodes[:, 0], nodes[:, 1]])

    def standing(self, nodes: Array) -> Array:
        """For each node (any, 2) the nearest one at which the robot can stand: int (any, 2)."""
        if self._nearest is None:
            self._nearest = ndimage.distance_transform_edt(~self.fits, return_distances=False, return_indices=True)
        return np.asarray(self._nearest[:, nodes[:, 0], nodes[:, 1]].T)

    def standing_at(self, x: float, y: float) -> Tuple[int, int]:
        """The node nearest to a place at which the robot can stand."""
        row, column = self.standing(self.nodes(np.array([[x, y]])))[0]
        return int(row), int(column)

    def within(self, distance: float) -> Array:
        """Cells whose middle lies so near, or a cell more, to where the robot can stand: bool (rows, columns)."""
        away = ndimage.distance_transform_edt(~self.fits)[:-1, :-1] * self.plan.resolution
        return np.asarray(away <= distance + self.plan.resolution)

    # --- ways -----------------------------------------------------------------------------------------------------

    def is_straight(self, start: Array, end: Array, room: float = 0.0) -> bool:
        """Whether the robot can drive straight from one place (2) to another, with so much room to spare [m]."""
        nodes = self._line(start, end)
        return bool((self.room[nodes[:, 0], nodes[:, 1]] >= self.reach + max(room, MARGIN)).all())

    def _line(self, start: Array, end: Array) -> Array:
        """The nodes from one place (2) to another: int (2 or more, 2)."""
        count = int(np.hypot(*(end - start)) / (0.5 * self.plan.resolution)) + 2
        share = np.linspace(0.0, 1.0, count)[:, np.newaxis]
        return self.nodes(start * (1.0 - share) + end * share)

    def is_marked(self, start: Array, end: Array) -> bool:
        """Whether an obstacle that was met lies between one place (2) and another."""
        nodes = self._line(start, end)
        return bool(self._marked[nodes[:, 0], nodes[:, 1]].any())

    def way(self, start: Array, end: Array) -> Optional[Array]:
        """A short way from one place (2) to another, float64 (2 or more, 2), or None where there is none.

        It begins and ends at the places themselves, even where these are a little nearer to a wall than ways go.
        """
        near = bool(np.hypot(*(end - start)) < AT_ONCE)
        if self.is_straight(start, end, 0.0 if near else EASE):
            return np.array([start, end])
        here, there = self.standing(self.nodes(np.array([start, end])))
        found = self._search(here, there, int(DETOUR / self.plan.resolution))
        if found is None:
            found = self._search(here, there, max(self.room.shape))
        if found is None:
            return None
        inner = self._straightened(self.places(found))
        return np.concatenate([[start], inner[1:-1] if len(inner) > 2 else inner, [end]])

    def lengths_to(self, x: float, y: float) -> Array:
        """Length of the way from each node to a place: float64 (rows + 1, columns + 1) [m]; inf where there is none."""
        search = graph.MCP_Geometric(np.where(self.fits, 1.0, -1.0))
        costs, _ = search.find_costs([self.standing_at(x, y)])
        return np.asarray(costs * self.plan.resolution)

    def _search(self, here: Array, there: Array, margin: int) -> Optional[Array]:
        """The cheapest way between nodes that keeps within so many nodes around both: int (any, 2)."""
        top, left = np.maximum(np.minimum(here, there) - margin, 0)
        bottom, right = np.maximum(here, there) + margin + 1
        room = self.room[top:bottom, left:right]
        shyness = SHYNESS * np.clip(1.0 - (room - self.reach) / SHY, 0.0, 1.0)
        search = graph.MCP_Geometric(np.where(self.fits[top:bottom, left:right], 1.0 + shyness, -1.0))
        end = tuple(there - (top, left))
        costs, _ = search.find_costs([here - (top, left)], [end])
        return np.array(search.traceback(end)) + (top, left) if np.isfinite(costs[end]) else None

    def _straightened(self, places: Array) -> Array:
        """The way without the places that can be left out."""
        kept, here, last = [0], 0, len(places) - 1
        while here < last:
            low, high = here + 1, last + 1
            hop = 2
            while here + hop <= last and self.is_straight(places[here], places[here + hop], EASE):
                low, hop = here + hop, 2 * hop
            high = min(here + hop, last + 1)
            while high - low > 1:
                middle = (low + high) // 2
                if self.is_straight(places[here], places[middle], EASE):
                    low = middle
                else:
                    high = middle
            here = low
            kept.append(here)
        return places[kept]
