"""The search for blocks of lanes, compiled by numba.

Arrays of two dimensions are walked by index: numba before 0.55 cannot iterate over them.

Arguments that many functions share:
    remaining: bool (rows, columns), the cells that are still to clean, rows along the lanes.
    clearance: float64 (rows + 1, columns + 1) [m], at the nodes.
    rule: how lanes are laid out.
"""

import math
from typing import Any, List, NamedTuple, Tuple

import numpy as np

from rumba_sim.model.compiling.jit import compiled

Array = Any  # numpy.ndarray
NO_ROW = -1


class Rule(NamedTuple):
    """How lanes are laid out; lengths are in cells."""

    needed: float  # clearance of a robot [m]
    half: float  # width that a lane cleans to each side
    least: int  # length of a lane, but for a shorter run
    join: int  # number of clean cells within a run, at most
    gap: int  # number of columns that need no lane within a lane, at most
    missed: float  # share of the width that is to clean, for a lane to be needed
    alike: float  # ratio of the lengths of two neighbouring lanes, at most


@compiled
def blocks(remaining: Array, clearance: Array, rule: Rule) -> Tuple[Array, Array, Array]:
    """All blocks, from the lowest row upward; what they clean remains no longer.

    Returns:
        the lanes, float64 (any, 3): the first column, the one after the last, and the row, with fractions; where each
        block begins among them, and the number of lanes, int (blocks + 1); the cells that each cleans, int (blocks).
    """
    rule = Rule(*rule)
    lanes, begins, counts = [(0.0, 0.0, 0.0) for _ in range(0)], [0], [0 for _ in range(0)]
    bottom, columns = 0, remaining.shape[1]  # nothing remains below
    while True:
        bottom, first, after = lowest(remaining, bottom, len(remaining), 0, columns, rule.join, rule.least)
        if bottom == NO_ROW:
            break
        count = grow(remaining, clearance, rule, bottom, (first, after), lanes)
        if len(lanes) > begins[-1]:
            begins.append(len(lanes))
            counts.append(count)
    found = np.empty((len(lanes), 3))
    for index in range(len(lanes)):
        found[index, 0], found[index, 1], found[index, 2] = lanes[index]
    return found, np.array(begins), np.array(counts)


@compiled
def grow(remaining: Array, clearance: Array, rule: Rule, row: int, run: Tuple[int, int],
         lanes: List[Tuple[float, float, float]]) -> int:
    """Add the lanes of one block to others, from its lowest row and the longest run there upward.

    Returns:
        the number of cells that they clean, which remain no longer.
    """
    count, size, across = 0, 0, 0.0
    while True:
        beside = size > 0 and row <= across + rule.half + 0.6  # no whole row lies between the two lanes
        highest = across + 2.0 * rule.half if beside else row + rule.half
        low, high, middle = lane(remaining, clearance, rule, run, highest)
        if high <= low:
            remaining[row, run[0]:run[1]] = False
            return count
        if size > 0 and not 1.0 / rule.alike < (high - low) / size < rule.alike:
            return count
        size, across = high - low, middle
        bottom, top = band(across, rule.half)
        count += np.count_nonzero(remaining[bottom:top, low:high])
        remaining[bottom:top, low:high] = False
        remaining[row, max(run[0], low):min(run[1], high)] = False
        lanes.append((float(low), float(high), across))
        reach = min(int(across + 3.0 * rule.half), len(remaining))
        row, first, after = lowest(remaining, top - 1, reach, low, high, rule.join, rule.least)
        if row == NO_ROW:
            return count
        run = (first, after)


@compiled
def runs(flags: Array, gap: int) -> Array:
    """Runs of True in bool (any); two runs with at most `gap` elements between them are joined.

    Returns:
        int (runs, 2): the first element of each, and the one after its last.
    """
    found = np.empty((len(flags) // 2 + 1, 2), np.int64)
    count, first = 0, -1
    for index in range(len(flags) + 1):
        if index < len(flags) and flags[index]:
            if first < 0:
                first = index
        elif first >= 0:
            if count > 0 and first - found[count - 1, 1] <= gap:
                found[count - 1, 1] = index
            else:
                found[count, 0], found[count, 1] = first, index
                count += 1
            first = -1
    return found[:count]


@compiled
def lowest(remaining: Array, bottom: int, top: int, left: int, right: int, join: int,
           least: int) -> Tuple[int, int, int]:
    """The lowest row from bottom to top with a long run that reaches into the columns from left to right.

    Rows that hold nothing but short runs remain no longer, if the columns are all that there are.

    Args:
        remaining: see above.
        bottom, top: rows.
        left, right: columns.
        join: see `gap` of `runs`.
        least: length of a long run [cells].

    Returns:
        the row, or NO_ROW; its longest run there: the first column, and the one after the last.
    """
    for row in range(bottom, top):
        if not remaining[row, left:right].any():
            continue
        first, after = 0, 0
        found = runs(remaining[row], join)
        for index in range(len(found)):
            begin, end = found[index, 0], found[index, 1]
            if begin < right and end > left and end - begin > after - first:
                first, after = begin, end
        if after - first >= least:
            return row, first, after
        if left == 0 and right == remaining.shape[1]:
            remaining[row] = False
    return NO_ROW, 0, 0


@compiled
def band(across: float, half: float) -> Tuple[int, int]:
    """The rows whose centres a brush of half a width [cells] passes over: the first, and the one after the last."""
    return max(int(math.floor(across - half + 0.5)), 0), max(int(math.floor(across + half + 0.5)), 0)


@compiled
def lane(remaining: Array, clearance: Array, rule: Rule, run: Tuple[int, int],
         highest: float) -> Tuple[int, int, float]:
    """The highest lane that cleans a part of a run.

    Args:
        remaining, clearance, rule: see above.
        run: columns that it has to clean: the first, and the one after the last.
        highest: row, with fractions, of the highest lane that cleans the row of the run.

    Returns:
        its first column and the one after its last, which are the same if there is no lane; its row, with fractions.
    """
    step = (highest - 0.5) - highest  # down by half cells, a brush width
    for count in range(math.ceil((2.0 * rule.half + 0.51) / 0.5)):
        across = highest + count * step
        row = min(max(int(across), 0), len(clearance) - 2)
        share = across - row
        fits = runs(clearance[row] * (1.0 - share) + clearance[row + 1] * share >= rule.needed, 0)
        for index in range(len(fits)):
            begin, end = fits[index, 0], fits[index, 1]
            low, high = max(begin, run[0]), min(end - 1, run[1])
            if high - low < min(rule.least, run[1] - run[0]):
                continue
            bottom, top = band(across, rule.half)
            rows = remaining[bottom:top, begin:end - 1]
            first, after = needed_part(rows, low - begin, high - begin, rule)
            if after > first:
                return first + begin, after + begin, across
    return 0, 0, 0.0


@compiled
def needed_part(rows: Array, low: int, high: int, rule: Rule) -> Tuple[int, int]:
    """The first columns that need a lane and reach between two columns, of the rows that the lane would clean.

    Args:
        rows: bool (any, columns), what is still to clean.
        low, high: columns.
        rule: see above.

    Returns:
        the first column, and the one after the last; both 0 if there are none.
    """
    if len(rows) > 0:
        parts = runs(rows.sum(axis=0) / len(rows) > rule.missed, rule.gap)
        for index in range(len(parts)):
            begin, end = parts[index, 0], parts[index, 1]
            if begin < high and end > low:
                return begin, end
    return 0, 0
