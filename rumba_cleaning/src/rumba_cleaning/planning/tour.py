"""In which order, and from which end, to drive a number of ways, so that the way between them is short."""

import math
from typing import List, NamedTuple, Optional, Sequence, Tuple

import numpy as np
from scipy import sparse
from scipy.sparse import csgraph

from rumba_cleaning.belief.ground import Ground
from rumba_sim.model.kernel import Array

NODES = 6_000  # of the graph on which distances are counted, at most about
FAR = 1e6  # [m] what cannot be reached
AROUND = 1.5  # [m] around the places, ways are looked for first
ROUNDS = 20
TOGETHER = (1, 2, 3, 4, 6)  # so many ways that follow each other are tried elsewhere
BETTER = 1e-6  # [m]
NEIGHBOURS = ((0, 1, 1.0), (1, 0, 1.0), (1, 1, 2.0 ** 0.5), (1, -1, 2.0 ** 0.5))  # rows, columns, length


class Stretch(NamedTuple):
    """A way that is to be driven in one of several manners, such as from either end."""

    manners: List[Array]  # float64 (any, 2) [m] each


def distances(ground: Ground, starts: Array, ends: Array) -> Array:
    """Length of the shortest way from each of the places (n, 2) to each of (m, 2): float64 (n, m) [m], about.

    FAR where there is no way.
    """
    straight = np.hypot(*(starts[:, np.newaxis] - ends[np.newaxis]).transpose(2, 0, 1))
    nodes = [ground.standing(ground.nodes(places)) for places in (starts, ends)]
    both = np.concatenate(nodes)
    around = int(AROUND / ground.plan.resolution)
    on_grid = _on_grid(ground.fits, nodes, np.maximum(both.min(axis=0) - around, 0), both.max(axis=0) + around + 1)
    if not np.isfinite(on_grid).all():
        on_grid = _on_grid(ground.fits, nodes, np.array([0, 0]), np.array(ground.fits.shape))
    return np.minimum(np.maximum(on_grid * ground.plan.resolution, straight), FAR)


def _on_grid(fits: Array, nodes: List[Array], low: Array, high: Array) -> Array:
    """Lengths within a window of the nodes, on a coarser graph of where the robot can stand [nodes]."""
    fits = fits[low[0]:high[0], low[1]:high[1]]
    step = max(math.ceil(math.sqrt(fits.size / NODES)), 1)
    rows, columns = (-(-size // step) for size in fits.shape)
    padded = np.zeros((rows * step, columns * step), np.bool_)
    padded[:fits.shape[0], :fits.shape[1]] = fits
    free = padded.reshape(rows, step, columns, step).any(axis=(1, 3))
    starts, ends = (((places - low) // step) @ np.array([columns, 1]) for places in nodes)
    sources, which = np.unique(starts, return_inverse=True)
    return np.asarray(csgraph.dijkstra(_graph(free), indices=sources)[which][:, ends] * step)


def _graph(free: Array) -> sparse.csr_matrix:
    """A node for each element of bool (rows, columns), edges between free neighbours."""
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
    """The order in which to drive stretches, each as (its index, its manner).

    Cheapest insertion, then moving one or a few together to where they cost less, as long as that helps.

    Args:
        ground: where the robot can stand.
        start: place (2) from which it begins.
        stretches: what is to be driven.
        end: place (2) near which it had best end; None: anywhere.
    """
    planner = _Planner(ground, start, stretches, end)
    return [planner.manners[index] for index in planner.best()]


class _Planner:
    """Every manner of every stretch has an index; a tour is a list of these, one for each stretch."""

    def __init__(self, ground: Ground, start: Array, stretches: Sequence[Stretch], end: Optional[Array]) -> None:
        self.manners = [(index, manner) for index, stretch in enumerate(stretches)
                        for manner in range(len(stretch.manners))]
        entries = np.array([stretches[index].manners[manner][0] for index, manner in self.manners])
        exits = np.array([stretches[index].manners[manner][-1] for index, manner in self.manners])
        self._of_stretch = [np.flatnonzero([index == stretch for index, _ in self.manners])
                            for stretch in range(len(stretches))]
        self._start = len(exits)  # what comes before the first stretch, as an index
        self._costs = distances(ground, np.vstack([exits, start]), entries)  # from exit to entry
        self._last = np.zeros(len(exits) + 1)  # from exit to the end of the tour
        if end is not None:
            self._last[:-1] = distances(ground, exits, end[np.newaxis])[:, 0]

    def best(self) -> List[int]:
        """A good tour."""
        found: List[int] = []
        left = list(range(len(self._of_stretch)))
        while left:
            _, place, manner = min(self._insertion(found, self._of_stretch[stretch]) for stretch in left)
            found.insert(place, manner)
            left.remove(self.manners[manner][0])
        for _ in range(ROUNDS):
            before = self._length(found)
            for count in TOGETHER:
                found = self._moved(found, count)
            if self._length(found) > before - BETTER:
                break
        return found

    def _length(self, found: List[int]) -> float:
        return float(self._costs[[self._start, *found[:-1]], found].sum() + self._last[found[-1]])

    def _moved(self, found: List[int], count: int) -> List[int]:
        """The tour with so many that follow each other put where they cost least, tried for each."""
        for first in range(len(found) - count + 1):
            part, rest = found[first:first + count], found[:first] + found[first + count:]
            if count == 1:
                _, place, part[0] = self._insertion(rest, self._of_stretch[self.manners[part[0]][0]])
            else:
                place = int(np.argmin(self._added(rest, np.array([part[0]]), np.array([part[-1]]))[:, 0]))
            moved = rest[:place] + part + rest[place:]
            if self._length(moved) < self._length(found) - BETTER:
                found = moved
        return found

    def _insertion(self, found: List[int], manners: Array) -> Tuple[float, int, int]:
        """Least cost of adding one of these manners, where, and which."""
        added = self._added(found, manners, manners)
        place, which = np.unravel_index(int(np.argmin(added)), added.shape)
        return float(added[place, which]), int(place), int(manners[which])

    def _added(self, found: List[int], firsts: Array, lasts: Array) -> Array:
        """Cost of putting parts, from each first to each last, at each place: float64 (len(found) + 1, parts)."""
        before = np.array([self._start, *found])
        added = self._costs[before][:, firsts]
        if found:
            added[:-1] += self._costs[lasts][:, found].T - self._costs[before[:-1], found][:, np.newaxis]
            added[-1] -= self._last[found[-1]]
        added[-1] += self._last[lasts]
        return added
