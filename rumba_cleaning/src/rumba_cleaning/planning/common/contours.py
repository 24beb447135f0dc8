"""Contours of values on a grid, by marching squares (W. E. Lorensen and H. E. Cline, Marching Cubes, 1987), compiled.

The same lines as those of skimage.measure.find_contours, which joins them in Python: that took a quarter of the time
for the plan of a large floor.
"""

from typing import Any, List, Tuple

import numpy as np

from rumba_sim.model.compiling.jit import compiled

Array = Any  # numpy.ndarray

UP, RIGHT, DOWN, LEFT = range(4)  # edges of a square: the first is in its first row, the last in its first column
# By the corners above the level, 1, 2, 4 and 8 in reading order: the edges at which one line begins and ends, and those
# of another one, if there is one. What is above lies on the same side of all lines; at a saddle it does not hang
# together.
NONE = -1
LINES = np.array([
    (NONE, NONE, NONE, NONE), (UP, LEFT, NONE, NONE), (RIGHT, UP, NONE, NONE), (RIGHT, LEFT, NONE, NONE),
    (LEFT, DOWN, NONE, NONE), (UP, DOWN, NONE, NONE), (RIGHT, UP, LEFT, DOWN), (RIGHT, DOWN, NONE, NONE),
    (DOWN, RIGHT, NONE, NONE), (UP, LEFT, DOWN, RIGHT), (DOWN, UP, NONE, NONE), (DOWN, LEFT, NONE, NONE),
    (LEFT, RIGHT, NONE, NONE), (UP, RIGHT, NONE, NONE), (LEFT, UP, NONE, NONE), (NONE, NONE, NONE, NONE)])


def contours(values: Array, level: float) -> List[Array]:
    """The lines on which values, float64 (rows, columns), have a level: float64 (any, 2), row and column, each.

    Closed ones end where they begin.
    """
    if min(values.shape) < 2:
        return []
    points, stops = joined(np.ascontiguousarray(values, np.float64), float(level))
    lines = [_without_repeats(line) for line in np.split(points, stops)[:-1]]
    return [line for line in lines if len(line) > 1]


def _without_repeats(line: Array) -> Array:
    """A line without points that equal those before them: there the level is just that of a node."""
    return line[np.append(True, (line[1:] != line[:-1]).any(axis=1))]


@compiled
def joined(values: Array, level: float) -> Tuple[Array, Array]:
    """The points of all contours, float64 (any, 2), and behind which each contour ends, int (contours)."""
    begins, ends = segments(values, level)
    following, before = linked(begins, ends)
    count = len(begins)
    is_done = np.zeros(count, np.bool_)
    points, stops, size = np.empty((2 * count, 2)), [0 for _ in range(0)], 0
    for index in range(count):
        if is_done[index]:
            continue
        first = beginning_of(before, following, index)
        points[size] = crossing(values, level, begins[first])
        size += 1
        segment = first
        while segment != NONE and not is_done[segment]:
            is_done[segment] = True
            points[size] = crossing(values, level, ends[segment])
            size += 1
            segment = following[segment]
        stops.append(size)
    return points[:size].copy(), np.array(stops, np.int64)


@compiled
def linked(begins: Array, ends: Array) -> Tuple[Array, Array]:
    """The segment that begins where each one ends, and the one that ends where it begins: int (any) each, or NONE."""
    count = len(begins)
    order: Array = np.argsort(begins)
    places: Array = np.searchsorted(begins[order], ends)
    following, before = np.full(count, NONE), np.full(count, NONE)
    for index in range(count):
        if places[index] < count and begins[order[places[index]]] == ends[index]:
            following[index] = order[places[index]]
            before[following[index]] = index
    return following, before


@compiled
def segments(values: Array, level: float) -> Tuple[Array, Array]:
    """The edges of the grid at which pieces of contours begin and end, square by square: int (any) each.

    The edge from node (r, c) along its row has the number r * columns + c; that along its column, the same and the
    number of all nodes.
    """
    rows, columns = values.shape
    begins, ends = [0 for _ in range(0)], [0 for _ in range(0)]
    for row in range(rows - 1):
        left = (values[row, 0] > level) + 4 * (values[row + 1, 0] > level)
        for column in range(columns - 1):
            right = (values[row, column + 1] > level) + 4 * (values[row + 1, column + 1] > level)
            above, left = left + 2 * right, right
            if above == 0 or above == 15:
                continue
            for pair in (0, 2):
                if LINES[above, pair] != NONE:
                    begins.append(edge(rows, columns, row, column, LINES[above, pair]))
                    ends.append(edge(rows, columns, row, column, LINES[above, pair + 1]))
    return np.array(begins, np.int64), np.array(ends, np.int64)


@compiled
def edge(rows: int, columns: int, row: int, column: int, side: int) -> int:
    """The number of the edge on a side of a square."""
    if side in (UP, DOWN):
        return (row + (side == DOWN)) * columns + column
    return rows * columns + row * columns + column + (side == RIGHT)


@compiled
def crossing(values: Array, level: float, number: int) -> Tuple[float, float]:
    """Where the level lies on an edge: row and column, with fractions."""
    rows, columns = values.shape
    is_down = number >= rows * columns
    node = number - rows * columns if is_down else number
    row, column = node // columns, node % columns
    one, other = values[row, column], values[row + is_down, column + (not is_down)]
    share = (level - one) / (other - one)
    return (row + share, float(column)) if is_down else (float(row), column + share)


@compiled
def beginning_of(before: Array, following: Array, index: int) -> int:
    """The segment with which the contour of another one begins: of a closed one, that after the last in the list."""
    last, segment = index, index
    while before[segment] != NONE and before[segment] != index:
        segment = before[segment]
        last = max(last, segment)
    return int(segment if before[segment] == NONE else following[last])
