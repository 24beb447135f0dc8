"""Marks and looks up the floor that is known, compiled by numba."""

import math
from typing import Any, Tuple

from rumba_sim.model.compiling.jit import compiled

Array = Any  # numpy.ndarray
Triple = Tuple[float, float, float]
DRIVEN, SEEN = 1, 2  # marks of floor: a wheel was on it, or a sensor saw it


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
def stamp(floor: Array, left: float, bottom: float, size: float, start: Triple, change: Triple, count: int,
          points: Array, mark: int) -> None:
    """Mark the cells that hold points in the frame of a robot, at some of its poses on a way.

    Args:
        floor: uint8 (rows, columns), changed; a mark never becomes less.
        left, bottom, size: see `cell_at`.
        start: x, y [m], theta [rad] at which the way begins.
        change: of them, from there to its end.
        count: poses that count: the last one, and others at equal distances after the first.
        points: float64 (any, 2) [m].
        mark: DRIVEN or SEEN.
    """
    for index in range(1, count + 1):
        share = index / count
        x, y, theta = start[0] + share * change[0], start[1] + share * change[1], start[2] + share * change[2]
        cos, sin = math.cos(theta), math.sin(theta)
        for number in range(len(points)):
            ahead, aside = points[number, 0], points[number, 1]
            row, column = cell_at(floor.shape, left, bottom, size, x + ahead * cos - aside * sin,
                                  y + ahead * sin + aside * cos)
            floor[row, column] = max(floor[row, column], mark)


@compiled
def are_marked(floor: Array, left: float, bottom: float, size: float, points: Array, cells: int,
               least: int) -> bool:
    """Whether each cell that holds one of the points (any, 2) [m] is marked, or one beside it by `least` or more.

    Beside it are those that are no more than so many cells away.
    """
    for index in range(len(points)):
        row, column = cell_at(floor.shape, left, bottom, size, points[index, 0], points[index, 1])
        if floor[row, column] == 0 and not (floor[max(row - cells, 0):row + cells + 1,
                                                  max(column - cells, 0):column + cells + 1] >= least).any():
            return False
    return True
