"""Where a robot can stand, by the floor plan and the obstacles that it has met."""

import copy
from typing import List, Optional, Sequence, Tuple

import numpy as np
from scipy import ndimage

from rumba_cleaning.belief.compiled_ground import are_of_one_part, keep_clear
from rumba_cleaning.belief.limits import limited
from rumba_cleaning.belief.met import Mark, Met, Seen
from rumba_cleaning.belief.search import is_clear
from rumba_sim.model.floors.constants import clearance_needed
from rumba_sim.model.floors.reachability import SLACK
from rumba_sim.model.kernel import Array
from rumba_sim.model.maps.floor_plan import FloorPlan
from rumba_sim.model.settings.robot_config import RobotConfig

# All figures below are our choice; each comment says what speaks for a larger and for a smaller value.
ESCAPE = 0.15  # [m] from where a robot is, it may go to another part of the floor, through a passage ...
NARROW = 0.03  # [m] ... that is too narrow by twice this, at most: three errors of a pose
BARRING = 0.1  # [m] beyond that from both sides, an obstacle bars the way from one to the other: small misses some
INFLATION = 0.1  # [m] beyond the touching distance, within which a path costs more: large keeps to the open floor
ALL_AROUND = np.ones((3, 3))  # nodes next to one


class Ground:
    """The floor as one robot knows it.

    What it meets may move: `forget_doubtful` forgets marks, and what is met again after that where something was met
    before is there to stay. What it sees is shown by `show`.

    Points are (x, y) [m] in the map frame; an array of points is float64 (any, 2). Nodes are the corners of the cells,
    (row, column) into `FloorPlan.safe_clearance`; an array of nodes is int (any, 2).

    Attributes:
        plan: the floor plan.
        reach: distance from the robot's centre to a wall that it touches [m].
        clearance: float64 (rows + 1, columns + 1), as `FloorPlan.safe_clearance` [m], and to obstacles it has met.
        fits: bool (rows + 1, columns + 1), the nodes at which the robot can stand.
    """

    def __init__(self, plan: FloorPlan, robot: RobotConfig) -> None:
        """Know what the plan shows."""
        self.plan = plan
        self.reach = clearance_needed(robot.drive.radius, plan.resolution)
        self.forget()

    def copy(self) -> 'Ground':
        """A ground with the same obstacles, which stays as it is if this one changes."""
        other = copy.copy(self)
        other.clearance = self.clearance.copy()
        other._met = self._met.copy()
        return other

    def learn(self, plan: FloorPlan) -> None:
        """Go on with a newer plan of the same floor, and the obstacles that were met."""
        self.plan = plan
        self._measure()

    def forget(self) -> None:
        """Forget all obstacles that the robot has met or seen."""
        self._met = Met()
        self._measure()

    def show(self, seen: Seen) -> None:
        """Replace what the robot sees."""
        if self._met.show(seen):
            self._measure()

    def keep_off(self, margin: float) -> None:
        """Have the robot stand only where it is farther from all that it would touch, by a margin [m]."""
        if margin > 0.0:
            self.reach += margin
            self._update()

    def squeeze(self, on: bool) -> None:
        """Take obstacles to be as small as they can be, so that gaps as narrow as the robot are open, or as usual.

        The body may then hang over cliffs, as far as the wheels stay well off.
        """
        if self._met.squeeze(on) and (self.has_marks or self.plan.cliff is not None):
            self._measure()

    def opened(self, x: float, y: float) -> float:
        """Area on which the robot could stand anyway, and to which squeezing opens a way from a point [m^2]."""
        squeezed = self.copy()
        squeezed.squeeze(True)
        before, after = self.parts(), squeezed.parts()
        away = self.fits & (before != before[self.standing_at(x, y)]) & (after == after[squeezed.standing_at(x, y)])
        return float(away.sum()) * self.plan.resolution ** 2

    def shows(self, points: Array) -> bool:
        """Whether it shows obstacles at points (any, 2) [m], all of them."""
        nodes = self.nodes(points)
        return bool((self.clearance[nodes[:, 0], nodes[:, 1]] <= self._met.most_clearance).all())

    def settle(self) -> None:
        """Take all obstacles to stay: nobody tries again whether they have gone."""
        self._met.settle()
        self._measure()

    def forget_doubtful(self) -> Array:
        """Forget the obstacles that may have gone since they were met: those that were met once.

        Returns:
            The points of those that were seen: float64 (any, 2) [m].
        """
        forgotten = self._met.forget_doubtful()
        self._measure()
        return forgotten

    def forget_barring(self, x: float, y: float) -> Array:
        """Forget them, and those that stay and keep a robot at a point [m] from part of the floor.

        These may be smaller than they are taken to be, or have gone after all.

        Returns:
            As `forget_doubtful`.
        """
        farther = np.maximum(*(ndimage.distance_transform_edt(~side) for side in self._sides(x, y)))
        farther *= self.plan.resolution
        forgotten = self._met.forget_barring(
            lambda mark: bool(farther[self.node(mark.x, mark.y)] < mark.radius + self.reach + BARRING))
        self._measure()
        return forgotten

    def leave_out(self, x: float, y: float, radius: float) -> None:
        """Take what the robot has met to be as small as it must be, since there is nothing within a circle [m]."""
        if self._met.leave_out(x, y, radius):
            self._measure()

    @property
    def has_marks(self) -> bool:
        """Whether the robot has met or seen any obstacles."""
        return self.has_doubtful or self.has_lasting

    @property
    def has_doubtful(self) -> bool:
        """Whether it has met or seen any that may go again."""
        return self._met.has_doubtful

    @property
    def has_lasting(self) -> bool:
        """Whether it has met or seen any that stay."""
        return self._met.has_lasting

    def lasting_clearance(self) -> Array:
        """As `clearance`, without the obstacles that may go again."""
        clearance = np.minimum(self.plan.clearance, self.plan.safe_clearance + self._met.less)
        self._keep_clear(clearance, self._met.lasting)
        return clearance

    def cut_off(self, x: float, y: float) -> float:
        """Area on which the robot could stand, and to which the obstacles that stay leave no way from a point [m^2]."""
        _, away = self._sides(x, y)
        return float(away.sum()) * self.plan.resolution ** 2

    def _sides(self, x: float, y: float) -> Tuple[Array, Array]:
        """The nodes to which the obstacles that stay leave a way from a point, and those that they cut off.

        Returns:
            Two arrays, bool (rows + 1, columns + 1).
        """
        node = self.standing_at(x, y)
        by_plan, _ = ndimage.label(self.plan.safe_clearance >= self.reach + SLACK, ALL_AROUND)
        fits = self.lasting_clearance() >= self.reach + SLACK
        beside_all, _ = ndimage.label(fits, ALL_AROUND)
        here = fits & (beside_all == beside_all[node])
        return here, fits & (by_plan == by_plan[node]) & ~here

    def mark(self, x: float, y: float, radius: float, stays: bool = False) -> None:
        """Remember a round obstacle; one that is met again is taken to be larger than before.

        Args:
            x, y: its centre in the map frame [m].
            radius: [m]
            stays: whether it is known to stay, even if it is met for the first time.
        """
        self._keep_clear(self.clearance, self._met.add(Mark(x, y, radius), stays))
        self._update()

    def _measure(self) -> None:
        """Compute the clearance: that of the plan, less around all obstacles."""
        self.clearance = self.lasting_clearance()
        self._keep_clear(self.clearance, self._met.doubtful)
        self._update()

    def _keep_clear(self, clearance: Array, marks: List[Mark]) -> None:
        """Lower a clearance, which is changed, around obstacles."""
        if marks:
            keep_clear(clearance, self.plan.origin, self.plan.resolution, np.array(marks, np.float64),
                       self.reach + INFLATION)

    def _update(self) -> None:
        """Derive from `clearance` what depends on it."""
        self.fits = self.clearance >= self.reach + SLACK
        self._unmarked = self.fits | (self.clearance >= self.plan.safe_clearance)
        self._nearest: Optional[Array] = None
        self._connected: Optional[Array] = None

    # --- points and nodes -----------------------------------------------------------------------------------------

    def node(self, x: float, y: float) -> Tuple[int, int]:
        """The node nearest to a point [m]."""
        left, bottom = self.plan.origin
        # NumPy before 1.19 rounds its numbers to numbers with fractions.
        row, column = int(round((y - bottom) / self.plan.resolution)), int(round((x - left) / self.plan.resolution))
        rows, columns = self.clearance.shape
        return min(max(row, 0), rows - 1), min(max(column, 0), columns - 1)

    def nodes(self, points: Array) -> Array:
        """The node nearest to each point (any, 2) [m]: int (any, 2); beyond the grid, a node of its edge."""
        nodes = np.rint((np.asarray(points) - self.plan.origin) / self.plan.resolution).astype(np.intp)[:, ::-1]
        return limited(nodes, 0, np.array(self.clearance.shape) - 1)

    def points(self, nodes: Array) -> Array:
        """The points at which nodes (any, 2) lie, which may have fractions: float64 (any, 2) [m]."""
        return np.asarray(nodes, np.float64)[:, ::-1] * self.plan.resolution + self.plan.origin

    def are_free(self, points: Array) -> Array:
        """Whether the robot can stand at each point (any, 2) [m], to the nearest node: bool (any)."""
        nodes = self.nodes(points)
        return np.asarray(self.fits[nodes[:, 0], nodes[:, 1]])

    def standing(self, nodes: Array) -> Array:
        """For each node (any, 2), the nearest node at which the robot can stand: int (any, 2)."""
        return np.asarray(self._standing()[:, nodes[:, 0], nodes[:, 1]].T)

    def _standing(self) -> Array:
        """Row and column of what `standing` answers for each node: int (2, rows + 1, columns + 1)."""
        if self._nearest is None:
            self._nearest = ndimage.distance_transform_edt(~self.fits, return_distances=False, return_indices=True)
        return self._nearest

    def standing_at(self, x: float, y: float) -> Tuple[int, int]:
        """The node nearest to a point [m] at which the robot can stand.

        In a passage in which it does not fit by less than NARROW, it lies in the largest part of the floor within
        ESCAPE: the robot is not quite where it believes to be, or obstacles are not.
        """
        middle_row, middle_column = self.node(x, y)
        row, column = self._standing()[:, middle_row, middle_column].tolist()
        size = int(ESCAPE / self.plan.resolution) + 1
        top, left = max(middle_row - size, 0), max(middle_column - size, 0)
        bottom, right = middle_row + size + 1, middle_column + size + 1
        if are_of_one_part(self.parts(), top, bottom, left, right):  # nearly everywhere
            return row, column
        window = slice(top, bottom), slice(left, right)
        joined, _ = ndimage.label(self.clearance[window] >= self.reach - NARROW, ALL_AROUND)
        here = joined[middle_row - top, middle_column - left]
        parts = np.where((joined == here) & (here > 0), self.parts()[window], 0)
        if are_of_one_part(parts, 0, bottom, 0, right):
            return row, column
        sizes = np.bincount(self.parts().ravel())
        sizes[0] = 0
        near = np.argwhere(sizes[parts] == sizes[parts].max()) + (top, left)
        row, column = near[np.argmin(((self.points(near) - (x, y)) ** 2).sum(axis=1))].tolist()
        return row, column

    def around(self, x: float, y: float, distance: float) -> Array:
        """Cells within a distance [m], or one cell more, of a node to which a robot at a point [m] can go.

        Returns:
            bool (rows, columns)
        """
        parts = self.parts()
        away = ndimage.distance_transform_edt(parts != parts[self.standing_at(x, y)])[:-1, :-1] * self.plan.resolution
        return np.asarray(away <= distance + self.plan.resolution)

    def places(self, points: Sequence[Tuple[float, float]]) -> List[Tuple[float, float]]:
        """The nodes nearest to points at which the robot can stand [m], that in the largest part of the floor first."""
        parts = self.parts()
        sizes = np.bincount(parts.ravel())
        nodes = sorted((self.standing_at(x, y) for x, y in points), key=lambda node: -int(sizes[parts[node]]))
        return [(x, y) for x, y in self.points(np.array(nodes)).tolist()]

    def parts(self) -> Array:
        """To which part of the floor each node belongs: int (rows + 1, columns + 1), 0 where a robot cannot stand."""
        if self._connected is None:
            self._connected, _ = ndimage.label(self.fits, ALL_AROUND)
        return self._connected

    # --- lines ----------------------------------------------------------------------------------------------------

    def is_straight(self, start: Array, end: Array, margin: float = 0.0) -> bool:
        """Whether the robot can drive straight from one point (2) to another.

        Args:
            start, end: [m], map frame.
            margin: clearance that it needs on the whole line, beyond the touching distance [m]; SLACK at least.
        """
        return self._are_at_least(self.clearance, start, end, self.reach + max(margin, SLACK))

    def is_marked(self, start: Array, end: Array) -> bool:
        """Whether an obstacle that the robot has met lies on the straight line from one point (2) to another [m]."""
        return not self._are_at_least(self._unmarked, start, end, 1)

    def _are_at_least(self, values: Array, start: Array, end: Array, least: float) -> bool:
        """Whether the values of all nodes along a straight line are at least so large."""
        (x, y), (to_x, to_y) = start.tolist(), end.tolist()
        return bool(is_clear(values, self.plan.origin, self.plan.resolution, (x, y), (to_x, to_y), least))
