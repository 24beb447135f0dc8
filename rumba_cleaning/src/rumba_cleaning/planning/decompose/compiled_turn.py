"""Turns a part of a floor onto another grid, compiled by numba."""

import math
from typing import Any, Tuple

import numpy as np

from rumba_sim.model.compiling.compiled import fast
from rumba_sim.model.compiling.jit import compiled

Array = Any  # numpy.ndarray
interpolated = fast.interpolated


@compiled
def turned(missed: Array, clearance: Array, axes: Array, low: Array, height: int, width: int) -> Tuple[Array, Array]:
    """A part of a floor on a grid whose axes are turned against the map's.

    Args:
        missed: the cells to clean, on the map's grid, bool (rows, columns).
        clearance: float64 (rows + 1, columns + 1) [m].
        axes: of the other grid, float64 (2, 2); rows: directions of its columns and rows on the map.
        low: column and row, on the other grid from the map's corner, at which the part begins, float64 (2).
        height, width: of the part [cells].

    Returns:
        what is to be cleaned, by the nearest cell, bool (height, width); the clearance, interpolated, float64
        (height + 1, width + 1) [m]. Off the map there is nothing to clean, and no clearance.
    """
    cells = np.zeros((height, width), np.bool_)
    nodes = np.zeros((height + 1, width + 1))
    for row in range(height + 1):
        for column in range(width + 1):
            u, v = low[0] + column, low[1] + row
            x, y = u * axes[0, 0] + v * axes[1, 0], u * axes[0, 1] + v * axes[1, 1]
            nodes[row, column] = interpolated(clearance, x, y)[0]
            if row < height and column < width:
                x, y = x + 0.5 * (axes[0, 0] + axes[1, 0]), y + 0.5 * (axes[0, 1] + axes[1, 1])
                on_row, on_column = int(math.floor(y)), int(math.floor(x))
                if 0 <= on_row < missed.shape[0] and 0 <= on_column < missed.shape[1]:
                    cells[row, column] = missed[on_row, on_column]
    return cells, nodes
