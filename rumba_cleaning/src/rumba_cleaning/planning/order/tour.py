"""The order in which to drive stretches, and each by which of its variants, so that little time passes in between."""

from typing import List, NamedTuple, Optional, Sequence

import numpy as np
from skimage import measure

from rumba_cleaning.belief.ground import Ground
from rumba_cleaning.planning.common import compiled_ways
from rumba_cleaning.planning.common.compiled_ways import Needed
from rumba_cleaning.planning.common.polyline import simplified
from rumba_cleaning.planning.common.rows import distinct
from rumba_cleaning.planning.common.stretches import Stretch, headings
from rumba_cleaning.planning.order import compiled_tours
from rumba_cleaning.route import corner_times
from rumba_sim.model.compiling.jit import plain
from rumba_sim.model.kernel import Array

# All figures are our choice; each comment says what speaks for a larger and for a smaller value.
KICKS = 300  # random changes of a tour, after each of which it is improved again, at most; ...
# ... and at most so many divided by stretches * variants, times an effort: more make shorter tours, and take more time.
STEPS = 160_000
BESIDE = 0.03  # [m] beyond the touching distance on a way: a robot that cuts a corner is stuck at an edge or a leg
NEAR = 0.15  # [m] to the ends of a line, which lie beside walls if those of a path do: nearer than this, it may be too
UNSEEN = 3.0  # [m] that are added to twice the distance of points between which no line of sight leads: a guess
AROUND = 0.3  # [m] about all stretches, in which obstacles are looked at that a way may lead around
OUTSIDE = 0.05  # [m] beyond BESIDE that ways lead around corners, which few points cut by no more than BESIDE
CORNERS = 300  # of ways, at most, each in a square of its own: small is fast, large makes shorter ways
FAR = 1e4  # [s] stands for infinity: finite, so that sums can be compared
SAME = 4  # decimals of [m]: points that are equal so far are one point


class Leg(NamedTuple):
    """A stretch of a tour, and the way to it."""

    stretch: int
    variant: int
    way: Optional[Array]  # float64 (any, 2) [m] from the end of the leg before to the first waypoint; None: not known


class Tour:
    """A tour over stretches from a point to a point; it is improved step by step, always the same way."""

    def __init__(self, ground: Ground, start: Array, stretches: Sequence[Stretch], end: Optional[Array], speed: float,
                 effort: int = 1) -> None:
        """Find a tour.

        Cheapest insertion, then or-opt (I. Or, Traveling Salesman-Type Combinatorial Problems, 1976), 2-opt, the best
        variants for the order that was found, and random changes from which it is improved again.

        Args:
            ground: where the robot can stand.
            start: point (2) from which the tour begins [m].
            stretches: what is to be driven.
            end: point (2) to which the robot goes afterwards [m]; None: it stays where the tour ends.
            speed: between the stretches [m/s].
            effort: how many times as much to search as usual.
        """
        self._variants = [(index, variant) for index, stretch in enumerate(stretches)
                          for variant in range(len(stretch.variants))]
        sizes = [*(len(stretch.variants) for stretch in stretches), 1]
        self._begins = np.concatenate([[0], np.cumsum(sizes)])
        self._of = np.repeat(np.arange(len(sizes)), sizes)
        ends = np.array([stretches[index].variants[variant].ends() for index, variant in self._variants])
        self._measure(ground, start, ends, end, speed)
        self._tour = compiled_tours.built(self._costs, self._begins)
        _improve(self._costs, self._of, self._begins, self._tour, effort)

    def _measure(self, ground: Ground, start: Array, ends: Array, end: Optional[Array], speed: float) -> None:
        """Find the ways from all ends (variants, 4, 2) [m] to all others, and the times that they take."""
        count = len(ends)
        points = np.concatenate([ends[:, 0], [start if end is None else end], ends[:, 3], [start]])
        points = np.round(np.concatenate([points, _corners(ground, points)]), SAME)
        self._points, numbers = np.unique(points, axis=0, return_inverse=True)
        ends_of, corners = np.split(numbers.reshape(-1), [2 * count + 2])
        self._entries, self._exits = np.split(ends_of, 2)
        # The variants of a stretch end near each other: those of the first one are enough to stop at.
        firsts = self._begins[:-1]
        stops = np.unique(np.concatenate([self._entries[firsts], self._exits[firsts], corners]))
        nodes = np.clip((self._points - ground.plan.origin) / ground.plan.resolution, 0.0,
                        np.array(ground.clearance.shape[::-1]) - 1.0)
        needed = Needed(ground.reach + BESIDE, ground.reach, NEAR / ground.plan.resolution, ground.plan.resolution)
        metres, self._before = compiled_ways.lengths(ground.clearance, plain(needed), nodes, stops)
        self._is_known = np.isfinite(metres)
        metres *= ground.plan.resolution
        one, other = np.nonzero(~self._is_known)
        metres[one, other] = 2.0 * np.hypot(*(self._points[one] - self._points[other]).T) + UNSEEN
        into, out = (np.append(headings(ends[:, at], ends[:, at + 1]), np.nan) for at in (0, 2))
        pairs = self._exits[:, np.newaxis], self._entries
        along = headings(self._points[pairs[0]], self._points[pairs[1]])
        corners = np.where(np.isnan(along), corner_times(into - out[:, np.newaxis]),
                           corner_times(along - out[:, np.newaxis]) + corner_times(into - along))
        self._costs = metres[pairs] / speed + corners
        if end is None:
            self._costs[:, -1] = 0.0

    @property
    def end(self) -> Array:
        """The point (2) at which its last stretch ends [m]."""
        return np.asarray(self._points[self._exits[self._tour[-2]]])

    def legs(self) -> List[Leg]:
        """The stretches in order."""
        legs, here = [], self._exits[-1]
        for number in self._tour[1:-1]:
            stretch, variant = self._variants[number]
            legs.append(Leg(stretch, variant, self._way(here, self._entries[number])))
            here = self._exits[number]
        return legs

    def _way(self, start: int, end: int) -> Optional[Array]:
        """The points from one to another, over lines of sight."""
        if not self._is_known[start, end]:
            return None
        way = [end]
        while way[-1] != start:
            way.append(self._before[start, way[-1]])
        return np.asarray(self._points[way[::-1]])


def _corners(ground: Ground, points: Array) -> Array:
    """Points on a way around what stands between points (any, 2) [m]: float64 (any, 2) [m]."""
    nodes = (points - ground.plan.origin)[:, ::-1] / ground.plan.resolution
    margin = AROUND / ground.plan.resolution
    low = np.maximum(nodes.min(axis=0) - margin, 0).astype(np.intp)
    high = (nodes.max(axis=0) + margin).astype(np.intp) + 1
    lines = measure.find_contours(ground.clearance[low[0]:high[0], low[1]:high[1]], ground.reach + BESIDE + OUTSIDE)
    corners = np.concatenate([np.zeros((0, 2)), *(simplified(ground.points(line + low), BESIDE) for line in lines)])
    thin = AROUND
    while True:
        _, first = distinct(np.floor(corners / thin))
        if len(first) <= CORNERS:
            return np.asarray(corners[np.sort(first)])
        thin *= 2.0


def order(costs: Array) -> List[int]:
    """The order in which to visit places once each, so that it takes little time.

    Args:
        costs: float64 (places + 1, places + 1) [s], from each place to each other; the last row belongs to the start,
            and the last column to the end.
    """
    alone = np.arange(len(costs) + 1)
    costs = np.minimum(costs, FAR)
    tour = compiled_tours.built(costs, alone)
    _improve(costs, alone[:-1], alone, tour, 1)
    return [int(place) for place in tour[1:-1]]


def _improve(costs: Array, of: Array, begins: Array, tour: Array, effort: int) -> None:
    """Improve a tour, by as many random changes as an effort is worth: see `compiled_tours`, and `Tour`."""
    count = len(tour) - 2
    if count:
        kicks = min(int(effort * STEPS / (count * len(costs))), KICKS if count > 2 else 0)
        places = np.sort(np.random.RandomState(1).randint(1, count + 2, (kicks, 3)), axis=1)
        compiled_tours.shake(costs, of, begins, tour, places)
