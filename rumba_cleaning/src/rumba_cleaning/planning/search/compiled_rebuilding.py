"""The search for a better route over pieces, compiled by numba: which to drive, in what order, and from which end.

Ruin and recreate (G. Schrimpf et al., Record Breaking Optimization Results Using the Ruin and Recreate Principle,
2000): pieces are taken out of a tour, and others put in where they cost least, as long as what they sweep is worth the
time; 2-opt; and simulated annealing to decide whether to go on from there.

An end is 2 * piece where that begins, 2 * piece + 1 where it ends; `end ^ 1` is the other end of a piece.

Arguments that many functions share:
    net: the pieces.
    tour: int (any), the ends at which pieces are entered, in order: first that of START, last that of GOAL.
    state: what the tour is made of.
"""

import math
from typing import Any, NamedTuple, Tuple

import numpy as np

from rumba_cleaning.planning.order.compiled_tours import drawn
from rumba_sim.model.compiling.jit import compiled

Array = Any  # numpy.ndarray

START, GOAL = 0, 1  # pieces at which a tour begins and ends: points
NONE = -1  # no place in a tour, or no piece
BETTER = 1e-6  # [s] an improvement: more than rounding errors, or the search would not end
# All figures are our choice.
MOST = 8  # pieces that are taken out at once: few are soon put in again, many change more
ROW = 0.3  # share of the ruins in which pieces follow one another in the tour; in the others they lie side by side
AROUND = 0.3  # [m] about these, in which others may be put in: small is fast
BESIDE = 0.6  # [m] about these, in which 2-opt tries links
SETUP = 0.5  # [s] that every piece counts longer in what it is worth per second: large prefers long pieces
NOISE = 0.5  # by which that may be larger or smaller, so that others are put in than were taken out
HOT, COLD = 0.3, 0.03  # [s] by which a tour may be worse, about, to go on from it, at the beginning and at the end
ROUNDS = 20  # of 2-opt, at most: most tours stop improving earlier
TRIED = 10  # links by which each end of a piece is put in, at most


class Net(NamedTuple):
    """Pieces, and the links between their ends."""

    near: Array  # int32 (ends, any), those to which a free link leads, the quickest first; negative for no more
    links: Array  # float32 (ends, ends), the times of all links [s], long where there is none
    durations: Array  # float64 (pieces), of the pieces [s]
    middles: Array  # float64 (pieces, 2), of the pieces [m]
    cells: Array  # int32 (any), numbers of the cells that each piece sweeps, one piece behind the other
    stops: Array  # int (pieces + 1), where those of each piece begin, and the end of the last
    price: float  # [s] that a cell is worth


class State(NamedTuple):
    """What a tour is made of."""

    place: Array  # int (pieces), of each piece in the tour; NONE if it is not in it
    passes: Array  # uint8 (cells), how many pieces sweep each cell


@compiled
def rebuilt(net: Net, tour: Array, cell_count: int, steps: int) -> Array:
    """The best tour that is found from another one in a number of steps."""
    random = np.ones(1, np.int64)
    state = State(np.full(len(net.durations), NONE), np.zeros(cell_count, np.uint8))
    for entry in tour:
        sweep(net, state.passes, entry >> 1, 1)
    number(state.place, tour, 0)
    cost = cost_of(net, state, tour)
    best, least = tour, cost
    for step in range(steps):
        other = State(state.place.copy(), state.passes.copy())
        left, middle, radius = ruined(net, other, tour, random)
        trial = recreated(net, other, left, middle, radius, random)
        untangle(net, other.place, trial, middle, radius + BESIDE)
        then = cost_of(net, other, trial)
        heat = HOT * (COLD / HOT) ** (step / steps)
        if then < cost - heat * math.log((1 + drawn(random, 1000)) / 1000.0):
            tour, state, cost = trial, other, then
            if cost < least - BETTER:
                best, least = tour, cost
    return best


@compiled
def cost_of(net: Net, state: State, tour: Array) -> float:
    """The time that a tour takes, less what the cells that it sweeps are worth [s]."""
    time = 0.0
    for index in range(1, len(tour)):
        time += link(net, tour[index - 1] ^ 1, tour[index]) + net.durations[tour[index] >> 1]
    return time - net.price * np.count_nonzero(state.passes)


@compiled
def link(net: Net, one: int, other: int) -> Any:
    """The time from one end to another [s], not in float32, in which sums with long times err by more than BETTER."""
    return np.float64(net.links[one, other])


@compiled
def sweep(net: Net, passes: Array, piece: int, change: int) -> None:
    """Add to the passes over the cells of a piece."""
    for index in range(net.stops[piece], net.stops[piece + 1]):
        passes[net.cells[index]] += change


@compiled
def number(place: Array, tour: Array, first: int) -> None:
    """Note the places of pieces in a tour, from one of them on."""
    for index in range(first, len(tour)):
        place[tour[index] >> 1] = index


@compiled
def ruined(net: Net, state: State, tour: Array, random: Array) -> Tuple[Array, Tuple[float, float], float]:
    """A tour without some pieces; the middle of the first of them [m]; how far away those of the others are [m].

    The state is changed to that of the tour.
    """
    count = len(tour) - 2
    if count < 1:
        return tour, (0.0, 0.0), 0.0
    size, first = min(1 + drawn(random, MOST), count), 1 + drawn(random, count)
    x, y = net.middles[tour[first] >> 1, 0], net.middles[tour[first] >> 1, 1]
    away = np.empty(count)
    for index in range(count):
        middle = net.middles[tour[1 + index] >> 1]
        away[index] = math.hypot(middle[0] - x, middle[1] - y)
    if drawn(random, 1000) < 1000.0 * ROW:
        begin = min(max(first - size // 2, 1), count + 1 - size)
        gone = np.arange(begin - 1, begin - 1 + size)
    else:
        gone = np.argsort(away, kind='mergesort')[:size]
    stays = np.ones(len(tour), np.bool_)
    for index in gone:
        piece = tour[1 + index] >> 1
        stays[1 + index] = False
        state.place[piece] = NONE
        sweep(net, state.passes, piece, -1)
    left = tour[stays]
    number(state.place, left, 0)
    return left, (x, y), away[gone].max()


@compiled
def recreated(net: Net, state: State, tour: Array, middle: Tuple[float, float], radius: float,
              random: Array) -> Array:
    """A tour with more pieces around a point [m], the one that is worth most per second first, as long as one is.

    The state is changed to that of the tour.
    """
    others = candidates(net, state.place, middle, radius + AROUND)
    luck = np.empty(len(others))
    for index in range(len(luck)):
        luck[index] = 1.0 - NOISE + 2.0 * NOISE * drawn(random, 1000) / 1000.0
    while True:
        best, chosen, place, entry = 0.0, NONE, 0, 0
        for index in range(len(others)):
            if luck[index] == 0.0:
                continue
            piece = others[index]
            worth = net.price * unswept(net, state.passes, piece) - net.durations[piece]
            if worth <= 0.0:
                luck[index] = 0.0  # and will not become worth it, the more is swept
                continue
            if luck[index] * worth <= best * (net.durations[piece] + SETUP):
                continue  # whatever the links cost
            added, at, into = slot(net, state.place, tour, piece)
            value = luck[index] * (worth - added) / (net.durations[piece] + max(added, 0.0) + SETUP)
            if worth > added and value > best:
                best, chosen, place, entry = value, index, at, into
        if chosen == NONE:
            return tour
        luck[chosen] = 0.0
        sweep(net, state.passes, others[chosen], 1)
        tour = np.concatenate((tour[:place], np.array([entry]), tour[place:]))
        number(state.place, tour, place)


@compiled
def candidates(net: Net, place: Array, middle: Tuple[float, float], radius: float) -> Array:
    """The pieces around a point [m] that are not in a tour: int (any)."""
    found = np.empty(len(place), np.int64)
    count = 0
    for piece in range(GOAL + 1, len(place)):
        if place[piece] == NONE and math.hypot(net.middles[piece, 0] - middle[0],
                                               net.middles[piece, 1] - middle[1]) <= radius:
            found[count] = piece
            count += 1
    return found[:count]


@compiled
def unswept(net: Net, passes: Array, piece: int) -> int:
    """How many cells nothing sweeps but a piece."""
    count = 0
    for index in range(net.stops[piece], net.stops[piece + 1]):
        count += int(passes[net.cells[index]] == 0)
    return count


@compiled
def slot(net: Net, place: Array, tour: Array, piece: int) -> Tuple[float, int, int]:
    """Where a piece costs least in a tour: time for the links [s], place, and the end at which it is entered."""
    best, at, into = np.inf, NONE, NONE
    for end in (2 * piece, 2 * piece + 1):
        tried = 0
        for near in net.near[end]:
            if near < 0 or tried == TRIED:
                break
            index = place[near >> 1]
            if index == NONE:
                continue
            tried += 1
            is_before = tour[index] == near
            index, entry = (index, end ^ 1) if is_before else (index + 1, end)
            if not 0 < index < len(tour):
                continue
            before, after = tour[index - 1] ^ 1, tour[index]
            added = link(net, before, entry) + link(net, entry ^ 1, after) - link(net, before, after)
            if added < best:
                best, at, into = added, index, entry
    return best, at, into


@compiled
def untangle(net: Net, place: Array, tour: Array, middle: Tuple[float, float], radius: float) -> None:
    """Turn parts of a tour round where that saves time (2-opt), as long as a link around a point [m] is replaced."""
    for _ in range(ROUNDS):
        is_better = False
        for index in range(1, len(tour)):
            here = net.middles[tour[index] >> 1]
            if math.hypot(here[0] - middle[0], here[1] - middle[1]) <= radius and turned(net, place, tour, index):
                is_better = True
        if not is_better:
            return


@compiled
def turned(net: Net, place: Array, tour: Array, index: int) -> bool:
    """Turn a part of a tour round that begins or ends at a place, if that saves time; whether it did."""
    ends = tour[index - 1] ^ 1, tour[index]
    before = link(net, *ends)
    for side in range(2):
        for near in net.near[ends[side]]:
            if near < 0 or link(net, ends[side], near) >= before - BETTER:
                break
            other = place[near >> 1]
            if other == NONE or (tour[other] == near) != bool(side):
                continue
            other += 1 - side  # the links before both places are replaced
            low, high = min(index, other), max(index, other)
            if low < 1 or low == high or high >= len(tour):
                continue
            change = (link(net, tour[low - 1] ^ 1, tour[high - 1] ^ 1) + link(net, tour[low], tour[high])
                      - link(net, tour[low - 1] ^ 1, tour[low]) - link(net, tour[high - 1] ^ 1, tour[high]))
            if change < -BETTER:
                tour[low:high] = tour[low:high][::-1].copy() ^ 1
                number(place, tour, low)
                return True
    return False
