"""Lowers the clearance of nodes around obstacles, and sees whether nodes are connected; compiled by numba."""

import math
from typing import Any, Tuple

from rumba_sim.model.compiling.jit import compiled

Array = Any  # numpy.ndarray


@compiled
def keep_clear(clearance: Array, origin: Tuple[float, float], resolution: float, marks: Array, within: float) -> None:
    """Lower the clearance of the nodes near round obstacles.

    Args:
        clearance: float64 (rows, columns), distance of each node to what is nearest [m]; changed.
        origin: x, y of the first node [m].
        resolution: from node to node [m].
        marks: float64 (any, 3), x, y and radius of each obstacle [m].
        within: distance from an obstacle [m] up to which nodes change, at least.
    """
    rows, columns = clearance.shape
    left, bottom = origin
    for index in range(len(marks)):
        x, y, radius = marks[index, 0], marks[index, 1], marks[index, 2]
        size = int((radius + within) / resolution) + 2
        middle_row, middle_column = int((y - bottom) / resolution + 0.5), int((x - left) / resolution + 0.5)
        for row in range(max(middle_row - size, 0), min(middle_row + size + 1, rows)):
            for column in range(max(middle_column - size, 0), min(middle_column + size + 1, columns)):
                away = math.hypot(column * resolution + left - x, row * resolution + bottom - y) - radius
                clearance[row, column] = min(clearance[row, column], max(away, 0.0))


@compiled
def are_of_one_part(parts: Array, top: int, bottom: int, left: int, right: int) -> bool:
    """Whether all nodes of a window at which a robot can stand, if any, belong to one part of the floor.

    Args:
        parts: int (rows, columns), the part to which each node belongs; 0 where a robot cannot stand.
        top, bottom: the first row of the window, and the one after its last; there may be fewer rows.
        left, right: the same of its columns.
    """
    found = 0
    for row in range(top, min(bottom, parts.shape[0])):
        for column in range(left, min(right, parts.shape[1])):
            part = parts[row, column]
            if part != 0 and found != 0 and found != part:
                return False
            found = max(found, part)
    return True
