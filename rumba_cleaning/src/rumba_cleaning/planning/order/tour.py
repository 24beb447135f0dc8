"""The order in which to drive stretches, and each by which of its variants, so that little time passes in between."""

from typing import List, NamedTuple, Optional, Sequence

import numpy as np
from skimage import measure

from rumba_cleaning.belief.ground import Ground
from rumba_cleaning.planning.common import compiled_ways
from rumba_cleaning.planning.common.lines import needed
from rumba_cleaning.planning.common.polyline import simplified
from rumba_cleaning.planning.common.rows import distinct
from rumba_cleaning.planning.common.stretches import Stretch, headings
from rumba_cleaning.planning.order import compiled_tours
from rumba_cleaning.route import BENT, STOP, TURN_RATE
from rumba_sim.model.compiling.jit import plain
from rumba_sim.model.kernel import Array

# All figures are our choice; each comment says what speaks for a larger and for a smaller value.
ROUNDS = 20  # of improvement, at most: most tours stop improving earlier
KICKS = 300  # random changes of a tour, after each of which it is improved again, at most; ...
# ... and at most so many divided by stretches * variants, times an effort: more make shorter tours, and take more time.
STEPS = 160_000
BESIDE = 0.03  # [m] beyond the touching distance on a way: a robot that cuts a corner is stuck at an edge or a leg
UNSEEN = 3.0  # [m] that are added to twice the distance of points between which no line of sight leads: a guess
AROUND = 0.3  # [m] about all stretches, in which obstacles are looked at that a way may lead around
OUTSIDE = 0.05  # [m] beyond BESIDE that ways lead around corners: large sees past them, small is short
CORNER = 0.04  # [m] by which a way around a corner may cut it, so that it needs few points: less than OUTSIDE
THIN = 0.3  # [m] side of the squares in each of which one such corner is enough, ...
CORNERS = 300  # ... unless there are more; then the squares are larger: small is fast, large makes shorter ways
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
        self._effort = effort
        self._variants = [(index, variant) for index, stretch in enumerate(stretches)
                          for variant in range(len(stretch.variants))]
        sizes = [len(stretch.variants) for stretch in stretches]
        self._begins = np.concatenate([[0], np.cumsum(sizes)])
        self._of = np.repeat(np.arange(len(stretches)), sizes)
        ends = np.array([stretches[index].variants[variant].ends() for index, variant in self._variants])
        self._measure(ground, start, ends, end, speed)
        self._found = compiled_tours.built(self._costs, self._last, self._begins)
        self._improve()

    def _measure(self, ground: Ground, start: Array, ends: Array, end: Optional[Array], speed: float) -> None:
        """Find the ways from all ends (variants, 4, 2) [m] to all others, and the times that they take."""
        count = len(ends)
        last = start if end is None else end
        points = np.concatenate([ends[:, 0], ends[:, 3], [start, last]])
        points = np.round(np.concatenate([points, _corners(ground, points)]), SAME)
        self._points, numbers = np.unique(points, axis=0, return_inverse=True)
        numbers = numbers.reshape(-1)
        firsts = self._begins[:-1]  # the variants of a stretch end near each other: those of the first one are enough
        stops = np.unique(np.concatenate([numbers[firsts], numbers[count + firsts], numbers[2 * count:]]))
        numbers = numbers[:2 * count + 2]
        self._entries, self._exits = numbers[:count], numbers[count:-1]  # the last exit is the start of the tour
        nodes = np.clip((self._points - ground.plan.origin) / ground.plan.resolution, 0.0,
                        np.array(ground.clearance.shape[::-1]) - 1.0)
        metres, self._before = compiled_ways.lengths(ground.clearance, plain(needed(ground, BESIDE)), nodes, stops)
        self._is_known = np.isfinite(metres)
        metres *= ground.plan.resolution
        one, other = np.nonzero(~self._is_known)
        metres[one, other] = 2.0 * np.hypot(*(self._points[one] - self._points[other]).T) + UNSEEN
        into = headings(ends[:, 0], ends[:, 1])
        out = np.append(headings(ends[:, 2], ends[:, 3]), np.nan)
        rates = speed, BENT, TURN_RATE, STOP
        self._costs = compiled_ways.drive_times(metres, self._points, self._exits, self._entries, out, into, *rates)
        self._last = np.zeros(count + 1)
        if end is not None:
            anywhere = np.array([np.nan])
            self._last = compiled_ways.drive_times(metres, self._points, self._exits, numbers[-1:], out, anywhere,
                                                   *rates)[:, 0]

    def _improve(self) -> None:
        if len(self._found):
            kicks = min(int(self._effort * STEPS / (len(self._found) * len(self._variants))), KICKS)
            compiled_tours.shaken(self._costs, self._last, self._of, self._begins, self._found, ROUNDS, kicks)

    @property
    def time(self) -> float:
        """Time between the stretches [s], about."""
        return float(compiled_tours.length(self._costs, self._last, self._found))

    def saved(self) -> Array:
        """What leaving out each stretch of the tour would save [s], and its index: float64 (any, 2)."""
        times = compiled_tours.savings(self._costs, self._last, self._found)
        return np.stack([times, self._of[self._found]], axis=1)

    def leave_out(self, stretches: Sequence[int]) -> None:
        """Shorten the tour by stretches, given by their indices."""
        self._found = self._found[~np.isin(self._of[self._found], stretches)]
        self._improve()

    def legs(self) -> List[Leg]:
        """The stretches in order."""
        legs, here = [], self._exits[-1]
        for number in self._found:
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
    corners = np.concatenate([np.zeros((0, 2)), *(simplified(ground.points(line + low), CORNER) for line in lines)])
    thin = THIN
    while True:
        _, first = distinct(np.floor(corners / thin))
        if len(first) <= CORNERS:
            return np.asarray(corners[np.sort(first)])
        thin *= 2.0


def order(costs: Array, last: Optional[Array] = None) -> List[int]:
    """The order in which to visit places once each, so that it takes little time.

    Args:
        costs: float64 (places + 1, places) [s], from each place to each other; the last row belongs to the start.
        last: float64 (places + 1) [s], from each place to where it ends; None: anywhere.
    """
    count = costs.shape[1]
    alone = np.arange(count + 1)
    costs, last = np.minimum(costs, FAR), np.zeros(count + 1) if last is None else np.minimum(last, FAR)
    found = compiled_tours.built(costs, last, alone)
    compiled_tours.improved(costs, last, alone[:-1], alone, found, ROUNDS)
    return [int(place) for place in found]
