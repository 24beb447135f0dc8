"""One map laid over another that has a different frame, such as the map of a robot over the true one."""

import math
from typing import Protocol, Tuple

import numpy as np

from rumba_sim.model.common.geometry import Pose, inverse
from rumba_sim.model.kernel import Array
from rumba_sim.model.maps.floor_plan import OCCUPIED, UNKNOWN


class Cells(Protocol):
    """A map of square cells along the axes of its frame."""

    @property
    def cells(self) -> Array:
        """Values int8 (rows, columns), as in nav_msgs/OccupancyGrid; row 0 lies at the lowest y."""

    @property
    def resolution(self) -> float:
        """Side of a cell [m]."""

    @property
    def left(self) -> float:
        """The least x of the cells [m]."""

    @property
    def bottom(self) -> float:
        """The least y of the cells [m]."""


def laid_over(upper: Cells, frame: Pose, lower: Cells) -> Array:
    """What a map shows at the centres of the cells of another: int8 in the shape of that; UNKNOWN beside the map.

    A wall is also shown in the cell that has its centre: thin walls would have gaps between coarser cells.

    Args:
        upper: the map.
        frame: pose of its frame in that of the other map.
        lower: the other map.
    """
    shown = np.full(lower.cells.shape, UNKNOWN, np.int8)
    rows, columns = lower.cells.shape
    x = lower.left + (np.arange(columns) + 0.5) * lower.resolution
    back = inverse(frame)
    for row in range(rows):  # so that it takes no memory for coordinates of all cells
        y = lower.bottom + (row + 0.5) * lower.resolution
        there, is_there = _cells_at(upper, *points_in_parent(back, x, np.full(columns, y)))
        shown[row, is_there] = upper.cells[there]
    walls = np.nonzero(upper.cells >= OCCUPIED)
    wall_x, wall_y = (start + (index + 0.5) * upper.resolution
                      for start, index in ((upper.left, walls[1]), (upper.bottom, walls[0])))
    shown[_cells_at(lower, *points_in_parent(frame, wall_x, wall_y))[0]] = OCCUPIED
    return shown


def points_in_parent(frame: Pose, x: Array, y: Array) -> Tuple[Array, Array]:
    """The coordinates (n) of points [m] in the parent of a frame, from those in the frame."""
    cos, sin = math.cos(frame.theta), math.sin(frame.theta)
    return frame.x + cos * x - sin * y, frame.y + sin * x + cos * y


def _cells_at(grid: Cells, x: Array, y: Array) -> Tuple[Tuple[Array, Array], Array]:
    """Rows and columns of the cells that have points [m], and which of the points (n) have one."""
    column, row = (np.floor((at - start) / grid.resolution).astype(int)
                   for at, start in ((x, grid.left), (y, grid.bottom)))
    rows, columns = grid.cells.shape
    is_there = (row >= 0) & (row < rows) & (column >= 0) & (column < columns)
    return (row[is_there], column[is_there]), is_there
