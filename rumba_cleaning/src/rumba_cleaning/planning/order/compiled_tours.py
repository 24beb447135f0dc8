"""The search for short tours, compiled by numba.

Arguments that many functions share:
    costs: float64 (variants + 1, variants) [s], from the exit of a variant to the entry of another one; the last row
        belongs to the start of the tour.
    last: float64 (variants + 1) [s], from the exit of a variant to the end of the tour.
    of: int (variants), the stretch to which each variant belongs; those of a stretch follow one another, in pairs: a
        path and the same path backward. A stretch that has only one variant is a point.
    begins: int (stretches + 1), the first variant of each stretch, and the number of variants.
    found: int (stretches), a tour: one variant of each stretch, in the order in which they are driven.
"""

from typing import Any, Tuple

import numpy as np

from rumba_sim.model.compiling.jit import compiled

Array = Any  # numpy.ndarray

BETTER = 1e-6  # [s] an improvement: more than rounding errors, or the search would not end
SEGMENTS = (1, 2, 3, 5)  # stretches that are moved together; our choice: longer segments take more time to try


@compiled
def length(costs: Array, last: Array, found: Array) -> float:
    """Time between the stretches of a tour [s]."""
    time, here = 0.0, costs.shape[0] - 1
    for index in range(len(found)):
        time += costs[here, found[index]]
        here = found[index]
    return float(time + last[here])


@compiled
def extra(costs: Array, last: Array, found: Array, count: int, slot: int, first: int, final: int) -> float:
    """What a segment, from variant `first` to `final`, costs in a slot of a tour of `count` stretches [s]."""
    here = found[slot - 1] if slot > 0 else costs.shape[0] - 1
    if slot < count:
        return float(costs[here, first] + costs[final, found[slot]] - costs[here, found[slot]])
    return float(costs[here, first] + last[final] - last[here])


@compiled
def cheapest_slot(costs: Array, last: Array, found: Array, count: int, first: int, final: int) -> Tuple[float, int]:
    """Where a segment, from variant `first` to `final`, costs least, in the first of several slots: time [s], slot."""
    best, slot = np.inf, 0
    for index in range(count + 1):
        added = extra(costs, last, found, count, index, first, final)
        if added < best:
            best, slot = added, index
    return best, slot


@compiled
def cheaper_slot(costs: Array, last: Array, found: Array, count: int, variant: int, best: float, slot: int,
                 split: int) -> Tuple[float, int]:
    """As `cheapest_slot` for a variant, after the slot `split` was filled, by the cheapest slot before that.

    The costs of all other slots are the same as before, and so only two are looked at, unless the cheapest was filled.
    """
    if slot == split:
        return cheapest_slot(costs, last, found, count, variant, variant)
    slot += 1 if slot > split else 0
    for index in (split, split + 1):
        added = extra(costs, last, found, count, index, variant, variant)
        if added < best or (added == best and index < slot):
            best, slot = added, index
    return best, slot


@compiled
def insertion(costs: Array, last: Array, found: Array, count: int, low: int, high: int) -> Tuple[float, int, int]:
    """The variant from `low` to `high`, and the slot, that cost least: time [s], slot, variant."""
    best, slot, variant = np.inf, 0, low
    for candidate in range(low, high):
        added, where = cheapest_slot(costs, last, found, count, candidate, candidate)
        if added < best:
            best, slot, variant = added, where, candidate
    return best, slot, variant


@compiled
def built(costs: Array, last: Array, begins: Array) -> Array:
    """A tour by cheapest insertion."""
    stretches = len(begins) - 1
    found = np.empty(stretches, np.int64)
    best, slots = np.full(costs.shape[1], np.inf), np.zeros(costs.shape[1], np.int64)  # of each variant
    left = np.ones(stretches, np.bool_)
    split = 0
    for count in range(stretches):
        chosen, cheapest = -1, -1
        for stretch in range(stretches):
            for variant in range(begins[stretch], begins[stretch + 1] if left[stretch] else 0):
                best[variant], slots[variant] = cheaper_slot(costs, last, found, count, variant, best[variant],
                                                             slots[variant], split)
                if chosen < 0 or best[variant] < best[cheapest]:
                    chosen, cheapest = stretch, variant
        split = slots[cheapest]
        for index in range(count, split, -1):
            found[index] = found[index - 1]
        found[split] = cheapest
        left[chosen] = False
    return found


@compiled
def rechosen(costs: Array, last: Array, of: Array, begins: Array, found: Array) -> None:
    """Choose the best variant of each stretch of a tour without changing their order (dynamic programming)."""
    count, most = len(found), 0
    for stretch in range(len(begins) - 1):
        most = max(most, begins[stretch + 1] - begins[stretch])
    times, came = np.full((count, most), np.inf), np.zeros((count, most), np.int64)
    for index in range(count):
        low, high = begins[of[found[index]]], begins[of[found[index]] + 1]
        for variant in range(low, high):
            if index == 0:
                times[0, variant - low] = costs[costs.shape[0] - 1, variant]
                continue
            start, stop = begins[of[found[index - 1]]], begins[of[found[index - 1]] + 1]
            for before in range(start, stop):
                time = times[index - 1, before - start] + costs[before, variant]
                if time < times[index, variant - low]:
                    times[index, variant - low], came[index, variant - low] = time, before
    low, high = begins[of[found[count - 1]]], begins[of[found[count - 1]] + 1]
    best = low
    for variant in range(low, high):
        if times[count - 1, variant - low] + last[variant] < times[count - 1, best - low] + last[best]:
            best = variant
    for index in range(count - 1, -1, -1):
        low = begins[of[found[index]]]
        found[index] = best
        best = came[index, best - low]


@compiled
def back(of: Array, begins: Array, variant: int) -> int:
    """The same path as a variant in the other direction; a point has none."""
    low = begins[of[variant]]
    return int(variant if begins[of[variant] + 1] - low == 1 else low + ((variant - low) ^ 1))


@compiled
def turn_round(of: Array, begins: Array, part: Array) -> None:
    """Drive a part of a tour from its end to its beginning."""
    part[:] = part[::-1].copy()
    for index in range(len(part)):
        part[index] = back(of, begins, part[index])


@compiled
def moved(costs: Array, last: Array, of: Array, begins: Array, found: Array, size: int) -> bool:
    """Move each segment of `size` stretches, also turned round, to where it costs less (or-opt); whether any was."""
    count = len(found)
    rest, part = np.empty(count, np.int64), np.empty(size, np.int64)
    any_moved = False
    for first in range(count - size + 1):
        here = found[first - 1] if first else costs.shape[0] - 1
        final = found[first + size - 1]
        saved = costs[here, found[first]]
        if first + size < count:
            saved += costs[final, found[first + size]] - costs[here, found[first + size]]
        else:
            saved += last[final] - last[here]
        rest[:first] = found[:first]
        rest[first:count - size] = found[first + size:]
        part[:] = found[first:first + size]
        if size == 1:
            added, slot, part[0] = insertion(costs, last, rest, count - 1, begins[of[part[0]]],
                                             begins[of[part[0]] + 1])
        else:
            added, slot = cheapest_slot(costs, last, rest, count - size, part[0], part[size - 1])
            turned, where = cheapest_slot(costs, last, rest, count - size, back(of, begins, part[size - 1]),
                                          back(of, begins, part[0]))
            if turned < added:
                added, slot = turned, where
                turn_round(of, begins, part)
        if added < saved - BETTER:
            found[:slot] = rest[:slot]
            found[slot:slot + size] = part
            found[slot + size:] = rest[slot:count - size]
            any_moved = True
    return any_moved


@compiled
def untangled(costs: Array, last: Array, of: Array, begins: Array, found: Array) -> bool:
    """Turn segments round where that saves time (2-opt); whether any was."""
    count = len(found)
    any_turned = False
    for first in range(count):
        here = found[first - 1] if first else costs.shape[0] - 1
        for final in range(first + 1, count):
            one, other = found[first], found[final]
            if final + 1 < count:
                change = costs[back(of, begins, one), found[final + 1]] - costs[other, found[final + 1]]
            else:
                change = last[back(of, begins, one)] - last[other]
            change += costs[here, back(of, begins, other)] - costs[here, one]
            if change < -BETTER:
                turn_round(of, begins, found[first:final + 1])
                any_turned = True
    return any_turned


@compiled
def improved(costs: Array, last: Array, of: Array, begins: Array, found: Array, rounds: int) -> None:
    """Improve a tour in rounds, as long as that helps."""
    for _ in range(rounds):
        changed = untangled(costs, last, of, begins, found)
        for size in SEGMENTS:
            if size < len(found) and moved(costs, last, of, begins, found, size):
                changed = True
        rechosen(costs, last, of, begins, found)
        if not changed:
            return


@compiled
def savings(costs: Array, last: Array, found: Array) -> Array:
    """What leaving out each stretch of a tour would save: float64 (stretches) [s]."""
    times = np.empty(len(found))
    here = costs.shape[0] - 1
    for index in range(len(found)):
        times[index] = costs[here, found[index]]
        if index + 1 < len(found):
            times[index] += costs[found[index], found[index + 1]] - costs[here, found[index + 1]]
        else:
            times[index] += last[found[index]] - last[here]
        here = found[index]
    return times


@compiled
def drawn(random: Array, below: int) -> int:
    """A random number from 0 on, below another; `random`, int64 (1), is changed: the same numbers follow the same."""
    random[0] = (random[0] * 1103515245 + 12345) % 2147483648
    return int((random[0] >> 8) % below)


@compiled
def shaken(costs: Array, last: Array, of: Array, begins: Array, found: Array, rounds: int, kicks: int) -> None:
    """Improve a tour, then swap segments of it at random and improve again, `kicks` times; the best tour is kept.

    (O. Martin, S. Otto and E. Felten, Large-Step Markov Chains for the Traveling Salesman Problem, 1991.) The random
    numbers are always the same.
    """
    improved(costs, last, of, begins, found, rounds)
    best, count, random = length(costs, last, found), len(found), np.ones(1, np.int64)
    if count < 3:
        return
    for _ in range(kicks):
        cuts = np.empty(3, np.int64)
        for index in range(3):
            cuts[index] = drawn(random, count + 1)
        cuts.sort()
        other = np.concatenate((found[:cuts[0]], found[cuts[1]:cuts[2]], found[cuts[0]:cuts[1]], found[cuts[2]:]))
        improved(costs, last, of, begins, other, rounds)
        time = length(costs, last, other)
        if time < best - BETTER:
            best = time
            found[:] = other
