"""Lowers the clearance of nodes around obstacles, compiled by numba."""

import math
from typing import Any, Tuple

from rumba_sim.model.jit import compiled

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
