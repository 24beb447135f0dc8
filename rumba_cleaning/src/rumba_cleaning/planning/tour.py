"""The order, and the direction, in which to drive a number of paths so that the distance between them is short."""

import math
from typing import List, NamedTuple, Optional, Sequence, Tuple

import numpy as np
from scipy import sparse
from scipy.sparse import csgraph

from rumba_cleaning.belief.ground import Ground
from rumba_sim.model.kernel import Array

NODES = 6_000  # of the coarse graph, about; bench/planning.py: offices of 1000 x 700 cells are planned within 10 s
FAR = 1e6  # [m] stands for a distance if no path exists: finite, so that sums of it can be compared
AROUND = 1.5  # [m] around all points is searched first; our choice: more finds longer paths, on a coarser graph
ROUNDS = 20  # of improvement, at most; our choice: most tours stop improving earlier
SEGMENTS = (1, 2, 3, 4, 6)  # stretches that are moved together; our choice: longer segments take more time to try
BETTER = 1e-6  # [m] an improvement: more than rounding errors, or the search would not end
NEIGHBOURS = ((0, 1, 1.0), (1, 0, 1.0), (1, 1, 2.0 ** 0.5), (1, -1, 2.0 ** 0.5))  # rows, columns, length


class Stretch(NamedTuple):
    """A part of the floor to clean, by one of several paths, such as a path from either end."""

    variants: List[Array]  # float64 (any, 2) [m] each


def distances(ground: Ground, starts: Array, ends: Array) -> Array:
    """Length of the shortest path from each start to each end, about.

    Args:
        ground: where the robot can stand.
        starts: points (n, 2) [m].
        ends: points (m, 2) [m].

    Returns:
        float64 (n, m) [m]; FAR if there is no path.
    """
    straight = np.hypot(*(starts[:, np.newaxis] - ends[np.newaxis]).transpose(2, 0, 1))
    nodes = [ground.standing(ground.nodes(points)) for points in (starts, ends)]
    both = np.concatenate(nodes)
    around = int(AROUND / ground.plan.resolution)
    on_grid = _on_grid(ground.fits, nodes, np.maximum(both.min(axis=0) - around, 0), both.max(axis=0) + around + 1)
    if not np.isfinite(on_grid).all():
        on_grid = _on_grid(ground.fits, nodes, np.array([0, 0]), np.array(ground.fits.shape))
    return np.minimum(np.maximum(on_grid * ground.plan.resolution, straight), FAR)


def _on_grid(fits: Array, nodes: List[Array], low: Array, high: Array) -> Array:
    """Lengths within a window of the nodes, on a coarser graph of the nodes at which the robot can stand.

    A node of the coarse graph is free if any of the nodes that it stands for is: a passage is not closed by coarseness.

    Args:
        fits: bool (rows + 1, columns + 1).
        nodes: two arrays, the starts int (n, 2) and the ends int (m, 2).
        low, high: corners of the window, (row, column).

    Returns:
        float64 (n, m) [nodes]
    """
    fits = fits[low[0]:high[0], low[1]:high[1]]
    step = max(math.ceil(math.sqrt(fits.size / NODES)), 1)
    rows, columns = (-(-size // step) for size in fits.shape)
    padded = np.zeros((rows * step, columns * step), np.bool_)
    padded[:fits.shape[0], :fits.shape[1]] = fits
    free = padded.reshape(rows, step, columns, step).any(axis=(1, 3))
    starts, ends = (((part - low) // step) @ np.array([columns, 1]) for part in nodes)
    sources, which = np.unique(starts, return_inverse=True)
    return np.asarray(csgraph.dijkstra(_graph(free), indices=sources)[which][:, ends] * step)


def _graph(free: Array) -> sparse.csr_matrix:
    """A graph with a node for each element of bool (rows, columns), and edges between free neighbours."""
    rows, columns = free.shape
    numbers = np.arange(free.size).reshape(free.shape)
    starts, ends, lengths = [], [], []
    for down, right, length in NEIGHBOURS:
        one = (slice(0, rows - down), slice(max(0, -right), columns - max(right, 0)))
        other = (slice(down, rows), slice(max(right, 0), columns + min(right, 0)))
        both = free[one] & free[other]
        starts.append(numbers[one][both])
        ends.append(numbers[other][both])
        lengths.append(np.full(len(starts[-1]), length))
    there, back = np.concatenate(starts + ends), np.concatenate(ends + starts)
    return sparse.csr_matrix((np.concatenate(lengths + lengths), (there, back)), (free.size, free.size))


def tour(ground: Ground, start: Array, stretches: Sequence[Stretch],
         end: Optional[Array] = None) -> List[Tuple[int, int]]:
    """The order in which to drive stretches, each by which of its variants.

    Cheapest insertion, then or-opt: segments of the tour are moved to where they cost less, as long as that helps
    (I. Or, Traveling Salesman-Type Combinatorial Problems, 1976).

    Args:
        ground: where the robot can stand.
        start: point (2) from which the tour begins [m].
        stretches: what is to be driven.
        end: point (2) to which the robot goes afterwards [m]; None: it stays where the tour ends.

    Returns:
        Indices (stretch, variant).
    """
    search = _Search(ground, start, stretches, end)
    return [search.variants[index] for index in search.best()]


class _Search:
    """Finds a tour: a list with one variant of each stretch, as indices into `variants`."""

    def __init__(self, ground: Ground, start: Array, stretches: Sequence[Stretch], end: Optional[Array]) -> None:
        self.variants = [(index, variant) for index, stretch in enumerate(stretches)
                         for variant in range(len(stretch.variants))]
        entries = np.array([stretches[index].variants[variant][0] for index, variant in self.variants])
        exits = np.array([stretches[index].variants[variant][-1] for index, variant in self.variants])
        self._of_stretch = [np.flatnonzero([index == stretch for index, _ in self.variants])
                            for stretch in range(len(stretches))]
        self._start = len(exits)  # index of the start of the tour, as if it were a variant
        self._costs = distances(ground, np.vstack([exits, start]), entries)  # [m] from exit to entry
        self._last = np.zeros(len(exits) + 1)  # [m] from exit to the end of the tour
        if end is not None:
            self._last[:-1] = distances(ground, exits, end[np.newaxis])[:, 0]

    def best(self) -> List[int]:
        """A short tour."""
        found: List[int] = []
        left = list(range(len(self._of_stretch)))
        while left:
            _, slot, variant = min(self._insertion(found, self._of_stretch[stretch]) for stretch in left)
            found.insert(slot, variant)
            left.remove(self.variants[variant][0])
        for _ in range(ROUNDS):
            before = self._length(found)
            for count in SEGMENTS:
                found = self._moved(found, count)
            if self._length(found) > before - BETTER:
                break
        return found

    def _length(self, found: List[int]) -> float:
        """Distance that is driven between the stretches of a tour [m]."""
        return float(self._costs[[self._start, *found[:-1]], found].sum() + self._last[found[-1]])

    def _moved(self, found: List[int], count: int) -> List[int]:
        """A tour after each of its segments of `count` stretches was moved to the slot where it costs least.

        A single stretch may also get another of its variants.
        """
        for first in range(len(found) - count + 1):
            part, rest = found[first:first + count], found[:first] + found[first + count:]
            if count == 1:
                _, slot, part[0] = self._insertion(rest, self._of_stretch[self.variants[part[0]][0]])
            else:
                slot = int(np.argmin(self._added(rest, np.array([part[0]]), np.array([part[-1]]))[:, 0]))
            moved = rest[:slot] + part + rest[slot:]
            if self._length(moved) < self._length(found) - BETTER:
                found = moved
        return found

    def _insertion(self, found: List[int], variants: Array) -> Tuple[float, int, int]:
        """The cheapest way to add one of these variants to a tour: its cost [m], the slot and the variant."""
        added = self._added(found, variants, variants)
        slot, which = np.unravel_index(int(np.argmin(added)), added.shape)
        return float(added[slot, which]), int(slot), int(variants[which])

    def _added(self, found: List[int], firsts: Array, lasts: Array) -> Array:
        """Cost of segments, each from its first to its last variant, in each slot of a tour.

        Returns:
            float64 (len(found) + 1, segments) [m]
        """
        before = np.array([self._start, *found])
        added = self._costs[before][:, firsts]
        if found:
            added[:-1] += self._costs[lasts][:, found].T - self._costs[before[:-1], found][:, np.newaxis]
            added[-1] -= self._last[found[-1]]
        added[-1] += self._last[lasts]
        return added
