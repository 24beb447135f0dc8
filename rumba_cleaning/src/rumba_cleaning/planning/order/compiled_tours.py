"""The search for short tours, compiled by numba.

Arguments that many functions share:
    costs: float64 (variants + 1, variants + 1) [s], from the exit of a variant to the entry of another one; the last
        row belongs to the start of the tour, and the last column to its end.
    of: int (variants + 1), the stretch to which each variant belongs; those of a stretch follow one another, in pairs:
        a path and the same path backward. A stretch that has only one variant is a point, as start and end together.
    begins: int (stretches + 2), the first variant of each stretch, and the number of variants, start and end included.
    tour: int (any), the start, one variant of each stretch in the order in which they are driven, and the end.
"""

from typing import Any, Tuple

import numpy as np

from rumba_sim.model.compiling.jit import compiled

Array = Any  # numpy.ndarray

BETTER = 1e-6  # [s] an improvement: more than rounding errors
ROUNDS = 20  # of improvement, at most: most tours stop improving earlier; our choice
SEGMENTS = (1, 2, 3, 5)  # stretches that are moved together; our choice: longer segments take more time to try


@compiled
def length(costs: Array, tour: Array) -> float:
    """Time between the stretches of a tour [s]."""
    time = 0.0
    for place in range(1, len(tour)):
        time += costs[tour[place - 1], tour[place]]
    return time


@compiled
def extra(costs: Array, tour: Array, place: int, first: int, final: int) -> float:
    """What a segment, from variant `first` to `final`, costs before a place of a tour [s]."""
    here, there = tour[place - 1], tour[place]
    return float(costs[here, first] + costs[final, there] - costs[here, there])


@compiled
def cheapest(costs: Array, tour: Array, first: int, final: int) -> Tuple[float, int]:
    """Before which place of a tour a segment, from variant `first` to `final`, costs least: time [s], place."""
    best, found = np.inf, 1
    for place in range(1, len(tour)):
        added = extra(costs, tour, place, first, final)
        if added < best:
            best, found = added, place
    return best, found


@compiled
def insertion(costs: Array, tour: Array, low: int, high: int) -> Tuple[float, int, int]:
    """The variant from `low` to `high`, and the place before which it costs least: time [s], place, variant."""
    best, place, variant = np.inf, 1, low
    for candidate in range(low, high):
        added, where = cheapest(costs, tour, candidate, candidate)
        if added < best:
            best, place, variant = added, where, candidate
    return best, place, variant


@compiled
def built(costs: Array, begins: Array) -> Array:
    """A tour to which one stretch after the other was added where it costs least."""
    tour = np.full(2, len(costs) - 1)
    for stretch in range(len(begins) - 2):
        _, place, variant = insertion(costs, tour, begins[stretch], begins[stretch + 1])
        tour = np.concatenate((tour[:place], np.array([variant]), tour[place:]))
    return tour


@compiled
def rechosen(costs: Array, of: Array, begins: Array, tour: Array) -> None:
    """Choose the best variant of each stretch of a tour without changing their order (dynamic programming)."""
    times, came = np.zeros(len(costs)), np.zeros(len(costs), np.int64)  # up to each variant, and the one before it
    for place in range(1, len(tour)):
        low, high = begins[of[tour[place - 1]]], begins[of[tour[place - 1]] + 1]
        for variant in range(begins[of[tour[place]]], begins[of[tour[place]] + 1]):
            options = times[low:high] + costs[low:high, variant]
            came[variant] = low + np.argmin(options)
            times[variant] = options.min()
    for place in range(len(tour) - 1, 1, -1):
        tour[place - 1] = came[tour[place]]


@compiled
def turned_round(of: Array, begins: Array, part: Array) -> Array:
    """A part of a tour, driven from its end to its beginning."""
    found = part[::-1].copy()
    for index in range(len(found)):
        low = begins[of[found[index]]]
        if begins[of[found[index]] + 1] - low > 1:
            found[index] = low + ((found[index] - low) ^ 1)
    return found


@compiled
def moved(costs: Array, of: Array, begins: Array, tour: Array, size: int) -> bool:
    """Move each segment of `size` stretches, also turned round, to where it costs less (or-opt); whether any was."""
    any_moved = False
    for first in range(1, len(tour) - size):
        part, rest = tour[first:first + size].copy(), np.concatenate((tour[:first], tour[first + size:]))
        saved = extra(costs, rest, first, part[0], part[-1])
        if size == 1:
            added, place, part[0] = insertion(costs, rest, begins[of[part[0]]], begins[of[part[0]] + 1])
        else:
            added, place = cheapest(costs, rest, part[0], part[-1])
            turned = turned_round(of, begins, part)
            as_turned, where = cheapest(costs, rest, turned[0], turned[-1])
            if as_turned < added:
                added, place, part = as_turned, where, turned
        if added < saved - BETTER:
            tour[:] = np.concatenate((rest[:place], part, rest[place:]))
            any_moved = True
    return any_moved


@compiled
def untangled(costs: Array, of: Array, begins: Array, tour: Array) -> bool:
    """Turn segments round where that saves time (2-opt); whether any was."""
    any_turned = False
    backward = turned_round(of, begins, np.arange(len(costs)))[::-1]  # each variant in the other direction
    for first in range(1, len(tour) - 2):
        for final in range(first + 1, len(tour) - 1):
            before, one, other, after = tour[first - 1], tour[first], tour[final], tour[final + 1]
            change = (costs[before, backward[other]] + costs[backward[one], after] - costs[before, one]
                      - costs[other, after])
            if change < -BETTER:
                tour[first:final + 1] = turned_round(of, begins, tour[first:final + 1])
                any_turned = True
    return any_turned


@compiled
def improve(costs: Array, of: Array, begins: Array, tour: Array) -> None:
    """Improve a tour in rounds, as long as that helps."""
    for _ in range(ROUNDS):
        changed = untangled(costs, of, begins, tour)
        for size in SEGMENTS:
            changed |= moved(costs, of, begins, tour, size)
        rechosen(costs, of, begins, tour)
        if not changed:
            return


@compiled
def shake(costs: Array, of: Array, begins: Array, tour: Array, kicks: Array) -> None:
    """Improve a tour, then swap segments of it and improve it again, and so on; the best tour is kept.

    (O. Martin, S. Otto and E. Felten, Large-Step Markov Chains for the Traveling Salesman Problem, 1991.)

    Args:
        costs, of, begins, tour: see above; the tour is changed.
        kicks: int (any, 3), places of a tour in ascending order, by which segments begin and end that are swapped.
    """
    improve(costs, of, begins, tour)
    best = length(costs, tour)
    for index in range(len(kicks)):
        one, two, three = kicks[index]
        other = np.concatenate((tour[:one], tour[two:three], tour[one:two], tour[three:]))
        improve(costs, of, begins, other)
        time = length(costs, other)
        if time < best - BETTER:
            best = time
            tour[:] = other
