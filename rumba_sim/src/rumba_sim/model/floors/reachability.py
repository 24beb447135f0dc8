"""Where a robot can stand, and which part of a floor its brush can reach."""

import math
import weakref
from typing import Dict, NamedTuple, Tuple

import numpy as np
from scipy import ndimage

from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.compiling.compiled import fast
from rumba_sim.model.floors.constants import clearance_needed
from rumba_sim.model.floors.straits import Floor, exact, joined
from rumba_sim.model.kernel import Array
from rumba_sim.model.kernel.sweeping.samples import SWEEPABLE
from rumba_sim.model.maps.floor_plan import ROUNDING, FloorPlan
from rumba_sim.model.settings.robot_config import RobotConfig

SLACK = 0.003  # [m] on each side of a robot in a passage, at least: no robot drives through a narrower one; our choice
RIM = 2  # [half cells] beyond where it has this slack, a robot can stand too: so near it comes to walls


class Reach(NamedTuple):
    """What a robot can reach from where it is; the arrays are not to be changed."""

    stands: Array  # bool (2 * rows + 1, 2 * columns + 1), see `stands`
    samples: Array  # uint8 (n * rows, n * columns), the bits SWEEPABLE and REACHABLE of `kernel.samples`
    reachable: int  # number of reachable samples


_Answers = Dict[bool, Tuple[Tuple[float, float], Reach]]  # to the last questions, by whether they were exact
_last: 'weakref.WeakKeyDictionary[FloorPlan, _Answers]' = weakref.WeakKeyDictionary()
_open: 'weakref.WeakKeyDictionary[FloorPlan, Dict[float, Pose]]' = weakref.WeakKeyDictionary()
_known_parts: 'weakref.WeakKeyDictionary[FloorPlan, Tuple[float, Array, Array]]' = weakref.WeakKeyDictionary()


def reach(plan: FloorPlan, config: RobotConfig, x: float, y: float, is_exact: bool = True) -> Reach:
    """What robots can reach from a start (x, y) [m], map frame.

    The last answers about a plan are remembered, since each robot on a floor asks the same.

    Args:
        plan: the floor plan.
        config: of the robots.
        x, y: the start.
        is_exact: whether straits are passages: if the plan can be relied on to SLACK. Robots do not plan through them.

    Raises:
        MapError: a robot does not fit at the start.
    """
    plan.check_pose(Pose(x, y, 0.0), config.drive.radius, f'{plan.name}: start')
    needed, half = clearance_needed(config.drive.radius, plan.resolution), 0.5 * config.brush.width
    question = needed, half
    answers = _last.setdefault(plan, {})
    if is_exact in answers:
        asked, known = answers[is_exact]
        if asked == question and known.stands[_nearest(plan, known.stands, x, y)]:
            return known
    clearance = _clearance(plan, is_exact)
    where = _standing(plan, clearance, needed, x, y, is_exact)
    spare = np.where(where, np.maximum(clearance - needed, 0.0), -1.0)
    samples = _sweepable(plan)
    number = int(fast.mark_reachable(plan.safe_clearance, plan.resolution, spare, needed, half, samples))
    found = Reach(where, samples, number)
    answers[is_exact] = question, found
    return found


def stands(plan: FloorPlan, needed: float, x: float, y: float, is_exact: bool = True) -> Array:
    """Where a robot can stand that starts at (x, y) [m] and drives with some slack.

    Args:
        plan: the floor plan.
        needed: the clearance that the robot needs [m]; it fits at the start.
        x, y: the start, map frame [m].
        is_exact: as for `reach`.

    Returns:
        bool (2 * rows + 1, 2 * columns + 1), at points half a cell apart: element (i, j) is the point
        `origin + 0.5 * resolution * (j, i)`.
    """
    return _standing(plan, _clearance(plan, is_exact), needed, x, y, is_exact)


def _standing(plan: FloorPlan, clearance: Array, needed: float, x: float, y: float, is_exact: bool) -> Array:
    """As `stands`, by the clearance at its points, float64 (2 * rows + 1, 2 * columns + 1) [m]."""
    fits, is_wide = clearance >= needed - ROUNDING, clearance >= needed + SLACK - ROUNDING
    start = _nearest(plan, fits, x, y)
    fits[start] = is_wide[start] = True
    labels = _parts(plan, needed, is_wide) if is_exact else ndimage.label(is_wide)[0]
    start = _nearest(plan, is_wide, x, y)
    return np.asarray(ndimage.binary_dilation(labels == labels[start], iterations=RIM, mask=fits))


class Parts:
    """The parts of a floor between which no robot can drive, from the largest to the smallest.

    Attributes:
        labels: int (2 * rows + 1, 2 * columns + 1), at the points of `stands`: the number of the part to which a point
            belongs, from 1 on; 0 where a robot has not enough room to drive.
        areas: float64 (parts), of the positions of a robot in each [m^2].
    """

    def __init__(self, plan: FloorPlan, needed: float) -> None:
        """Find the parts.

        Args:
            plan: the floor plan.
            needed: the clearance that the robot needs [m].
        """
        self._plan = plan
        labels = _parts(plan, needed, _clearance(plan, True) >= needed + SLACK - ROUNDING)
        sizes = np.bincount(labels.ravel())[1:]
        by_size = np.argsort(-sizes, kind='stable')[:np.count_nonzero(sizes)]
        ranks = np.zeros(len(sizes) + 1, labels.dtype)
        ranks[by_size + 1] = np.arange(1, len(by_size) + 1)
        self.labels: Array = ranks[labels]
        self.areas: Array = sizes[by_size] * (0.5 * plan.resolution) ** 2

    def at(self, x: float, y: float) -> int:
        """The number of the part in which a robot at a point [m] is; 0 if it is in none."""
        return int(self.labels[_nearest(self._plan, self.labels > 0, x, y)])

    def open_pose(self, number: int) -> Pose:
        """The node with the most space around it in a part, facing along x; of all nodes, if none is in that part."""
        return self._plan.most_open_pose(self.labels[::2, ::2] == number)


def most_open_pose(plan: FloorPlan, needed: float) -> Pose:
    """The node with the most space around it in the largest part of a floor, facing along x.

    The answers about a plan are remembered, since each world on a floor asks the same.
    """
    answers = _open.setdefault(plan, {})
    if needed not in answers:
        answers[needed] = Parts(plan, needed).open_pose(1)
    return answers[needed]


def _parts(plan: FloorPlan, needed: float, is_wide: Array) -> Array:
    """The part of each point of `stands` at which it is wide enough, as a number from 1 on; 0 elsewhere.

    The last answer about a plan is remembered: a look at all straits among specks takes seconds.
    """
    asked, wide, known = _known_parts.get(plan, (math.nan, is_wide, is_wide))
    if asked == needed and np.array_equal(wide, is_wide):
        return known
    labels, number = ndimage.label(is_wide)
    if number > 1:
        labels = joined(labels, number, _floor(plan, needed + SLACK))
    _known_parts[plan] = needed, is_wide, labels
    return labels


def _floor(plan: FloorPlan, needed: float) -> Floor:
    """The floor on which robots can be that need some clearance [m]."""
    cells = plan.free if plan.cliff is None else plan.free & ~plan.cliff
    return Floor(cells, plan.safe_clearance / plan.resolution, (needed - ROUNDING) / plan.resolution)


def _clearance(plan: FloorPlan, is_exact: bool) -> Array:
    """The clearance at the points, as `stands` answers them: float64 (2 * rows + 1, 2 * columns + 1) [m].

    It is interpolated between the nodes, or exact where that shows too little.
    """
    nodes = plan.safe_clearance
    found = np.empty((2 * plan.rows + 1, 2 * plan.columns + 1))
    found[::2, ::2] = nodes
    found[::2, 1::2] = 0.5 * (nodes[:, :-1] + nodes[:, 1:])
    found[1::2, ::2] = 0.5 * (nodes[:-1] + nodes[1:])
    found[1::2, 1::2] = 0.25 * (nodes[:-1, :-1] + nodes[:-1, 1:] + nodes[1:, :-1] + nodes[1:, 1:])
    if is_exact:
        np.maximum(found, plan.resolution * exact(_floor(plan, 0.0)), out=found)
    return found


def _nearest(plan: FloorPlan, fits: Array, x: float, y: float) -> Tuple[int, int]:
    """The element of `fits`, as `stands` answers it, at which a robot at (x, y) [m] is; one that is true if possible.

    A robot that fits at a point need not fit at the nearest of the points of `fits`.
    """
    u, v = 2.0 * (x - plan.origin[0]) / plan.resolution, 2.0 * (y - plan.origin[1]) / plan.resolution
    row, column = int(round(v)), int(round(u))  # NumPy before 1.19 rounds its numbers to numbers with fractions
    around = [(i, j) for i in range(max(row - 2, 0), min(row + 3, fits.shape[0]))
              for j in range(max(column - 2, 0), min(column + 3, fits.shape[1]))]
    return min(around, key=lambda at: (not fits[at], (at[0] - v) ** 2 + (at[1] - u) ** 2))


def _sweepable(plan: FloorPlan) -> Array:
    """The samples of a plan, with the bit SWEEPABLE where there is floor."""
    floor = plan.free if plan.cliff is None else plan.free & ~plan.cliff
    squares = plan.sample_squares
    return (floor * np.uint8(SWEEPABLE)).repeat(squares, 0).repeat(squares, 1)
