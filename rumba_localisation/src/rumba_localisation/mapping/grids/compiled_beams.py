"""What speaks against a pose: compares the beams of a scan with what a grid shows; compiled by numba.

Arguments that functions share:
    odds, field: as in `compiled_grid`.
    ends: float64 (beams, 2), where beams end [cells from the corner of the grid].
"""

import math
from typing import Any

from rumba_sim.model.compiling.jit import compiled

Array = Any  # numpy.ndarray


@compiled
def unknown(odds: Array, ends: Array) -> int:
    """How many beams end on cells of which nothing is known."""
    rows, columns = odds.shape
    count = 0
    for beam in range(len(ends)):
        column, row = int(math.floor(ends[beam, 0])), int(math.floor(ends[beam, 1]))
        count += not (0 <= row < rows and 0 <= column < columns and odds[row, column] != 0.0)
    return count


@compiled
def contradicted(odds: Array, field: Array, ends: Array, free: float, away: Array) -> int:
    """How many beams end where there is surely nothing: neither there nor in the cells beside, which beams may graze.

    Args, apart from those above:
        free: odds of cells that are surely free, at most.
        away: float64 (beams), from walls, at least [m].
    """
    rows, columns = odds.shape
    count = 0
    for beam in range(len(ends)):
        column, row = int(math.floor(ends[beam, 0])), int(math.floor(ends[beam, 1]))
        if 0 < row < rows - 1 and 0 < column < columns - 1 and field[row, column] > away[beam]:
            is_free = True
            for near_row in range(row - 1, row + 2):
                for near_column in range(column - 1, column + 2):
                    is_free = is_free and odds[near_row, near_column] <= free
            count += is_free
    return count


@compiled
def blocked(odds: Array, x: float, y: float, ends: Array, wall: float, before: Array) -> int:
    """How many beams would have to pass through a wall.

    Args, apart from those above:
        x, y: of the laser [cells from the corner of the grid].
        wall: odds of cells that are surely walls, at least.
        before: float64 (beams), the end of a beam, up to which it may be in a wall [cells].
    """
    rows, columns = odds.shape
    count = 0
    for beam in range(len(ends)):
        by_x, by_y = ends[beam, 0] - x, ends[beam, 1] - y
        length = math.hypot(by_x, by_y)
        for step in range(1, int(length - before[beam])):
            column, row = int(math.floor(x + by_x * step / length)), int(math.floor(y + by_y * step / length))
            if 0 <= row < rows and 0 <= column < columns and odds[row, column] >= wall:
                count += 1
                break
    return count
