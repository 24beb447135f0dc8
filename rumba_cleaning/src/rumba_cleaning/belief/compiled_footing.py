"""Marks and looks up the floor that is known, compiled by numba."""

import math
from typing import Any, Tuple

import numpy as np

from rumba_sim.model.jit import compiled

Array = Any  # numpy.ndarray


@compiled
def cell_at(shape: Tuple[int, int], left: float, bottom: float, size: float, x: float, y: float) -> Tuple[int, int]:
    """Row and column of the cell that holds a point, or of one at the edge.

    Args:
        shape: numbers of rows and columns.
        left, bottom: the lower left corner of the first cell [m].
        size: side of a cell [m].
        x, y: the point [m].
    """
    row, column = int((y - bottom) / size), int((x - left) / size)
    return min(max(row, 0), shape[0] - 1), min(max(column, 0), shape[1] - 1)


@compiled
def stamp(floor: Array, left: float, bottom: float, size: float, poses: Array, points: Array) -> None:
    """Mark the cells that hold points in the frame of a robot at each of its poses.

    Args:
        floor: bool (rows, columns), changed.
        left, bottom, size: see `cell_at`.
        poses: float64 (any, 3): x, y [m], theta [rad].
        points: float64 (any, 2) [m].
    """
    for index in range(len(poses)):
        x, y, cos, sin = poses[index, 0], poses[index, 1], math.cos(poses[index, 2]), math.sin(poses[index, 2])
        for number in range(len(points)):
            ahead, aside = points[number, 0], points[number, 1]
            floor[cell_at(floor.shape, left, bottom, size, x + ahead * cos - aside * sin,
                          y + ahead * sin + aside * cos)] = True


@compiled
def are_marked(floor: Array, left: float, bottom: float, size: float, points: Array, cells: int) -> Array:
    """Whether the cell that holds each point (any, 2) [m], or one so many cells beside it, is marked: bool (any)."""
    found = np.zeros(len(points), np.bool_)
    for index in range(len(points)):
        row, column = cell_at(floor.shape, left, bottom, size, points[index, 0], points[index, 1])
        found[index] = floor[max(row - cells, 0):row + cells + 1, max(column - cells, 0):column + cells + 1].any()
    return found
