"""The floor on a grid that is turned so that its rows and columns run along the walls, whatever their direction."""

import math
from typing import List, Optional, Tuple

import numpy as np
from scipy import ndimage

from rumba_cleaning.belief.ground import Ground
from rumba_cleaning.compiled_bearings import bearings
from rumba_cleaning.planning.common import gaussian
from rumba_cleaning.planning.common.polyline import SPACING
from rumba_sim.model.compiling.compiled import fast
from rumba_sim.model.kernel import Array

# Our choice, checked by test_turned_floor.py, which allows an error of 1.5 degrees.
SPAN = 0.3  # [m] of a wall, over which its direction is measured: long averages over the steps of the grid
BINS = 90  # of the histogram of directions, in a quarter turn: 1 degree each
SMOOTH = 1.5  # [bins] standard deviation of the filter over the histogram: walls of a drawn map are not quite straight
STRAIGHT = 2  # [bins] a direction this near to an axis of the map counts as the axis: a turned grid is less exact
QUARTER = 0.5 * math.pi  # [rad]
Window = Tuple[slice, slice]  # rows and columns


class TurnedFloor:
    """The part of a floor that holds the cells to clean, on a grid whose axes are turned by an angle against the map's.

    Attributes:
        missed: the cells to clean, bool (rows, columns).
        clearance: distance from each node to the nearest obstacle, float64 (rows + 1, columns + 1) [m].
        resolution: side of a cell [m].
    """

    def __init__(self, ground: Ground, missed: Array, angle: float, margin: float,
                 within: Optional[Window] = None) -> None:
        """Turn the part of a floor.

        Args:
            ground: where the robot can stand.
            missed: the cells to clean, on the map's grid, bool (rows, columns).
            angle: of this grid's axes against the map's, counter-clockwise [rad].
            margin: around the cells to clean that belongs to the part, unless the map ends [m].
            within: the smallest window that holds all cells to clean, if known: a large map is not looked through.
        """
        self.resolution = ground.plan.resolution
        self._origin = ground.plan.origin
        self._axes = np.eye(2)
        low, clearance, beside = np.zeros(2), ground.clearance, math.ceil(margin / self.resolution)
        if angle != 0.0:
            cos, sin = math.cos(angle), math.sin(angle)
            self._axes = np.array([[cos, sin], [-sin, cos]])  # rows: directions of its columns and rows on the map
            low, missed, clearance = _turned(missed, clearance, self._axes, _window(missed, within, 2 * beside))
            within = None
        rows, columns = (slice(max(side.start, 0), side.stop) for side in _window(missed, within, beside))
        self.missed = missed[rows, columns]
        self.clearance = clearance[rows.start:rows.stop + 1, columns.start:columns.stop + 1]  # one more than cells
        self._low = low + (columns.start, rows.start)

    def points(self, cells: Array) -> Array:
        """The points of the map at which (column, row) of this grid, with fractions, lie: float64 (..., 2) [m]."""
        return _on_axes((cells + self._low) * self.resolution, self._axes) + self._origin


def _on_axes(points: Array, axes: Array) -> Array:
    """points @ axes, (..., 2) and (2, 2): BLAS rounds as it likes, and plans must not depend on its build."""
    return points[..., :1] * axes[0] + points[..., 1:] * axes[1]


def _turned(missed: Array, clearance: Array, axes: Array, window: Window) -> Tuple[Array, Array, Array]:
    """A part of a map on another grid, without a look at the rest of the map.

    Args:
        missed, clearance: see `TurnedFloor`, on the map's grid.
        axes: of the other grid, float64 (2, 2).
        window: of the map's grid that belongs to the part at least; it may reach beyond the map.

    Returns:
        column and row, on a turned grid from the map's corner, at which the part begins; both arrays of the part: what
        is missed by the nearest cell, and the clearance interpolated. Off the map both are 0.
    """
    rows, columns = window
    corners = _on_axes(np.array([[column, row] for row in (rows.start, rows.stop)
                                 for column in (columns.start, columns.stop)]), axes.T)
    low = np.floor(corners.min(axis=0))
    shape = (np.ceil(corners.max(axis=0)) - low + 1.0).astype(int)[::-1]
    nodes = _on_axes(np.indices(shape)[::-1].reshape(2, -1).T + low, axes)
    cells = np.floor(nodes + 0.5 * axes.sum(axis=0)).astype(int)[:, ::-1]
    is_on_map = ((cells >= 0) & (cells < missed.shape)).all(axis=1)
    cells[~is_on_map] = 0
    on_cells = (is_on_map & missed[cells[:, 0], cells[:, 1]]).reshape(shape)[:-1, :-1]
    return low, on_cells, fast.interpolated_at(clearance, 0.0, 0.0, 1.0, nodes).reshape(shape)


def _window(missed: Array, within: Optional[Window], margin: int) -> Window:
    """The smallest window with all of bool (rows, columns) that is not False, which is `within` if that is known, and a
    margin [cells] around it, which may reach beyond the map; an empty one if all is False."""
    rows, columns = within or (_span(missed.any(axis=1)), _span(missed.any(axis=0)))
    if rows.stop == 0:
        return rows, columns
    return slice(rows.start - margin, rows.stop + margin), slice(columns.start - margin, columns.stop + margin)


def _span(line: Array) -> slice:
    """The part of bool (any) that is not False."""
    found = np.flatnonzero(line)
    return slice(int(found[0]), int(found[-1]) + 1) if len(found) else slice(0, 0)


def main_direction(outlines: List[Array]) -> float:
    """The angle by which most walls are turned against the map's axes: -pi/4 to pi/4 [rad].

    Args:
        outlines: paths beside the walls, float64 (any, 2) [m] each, with waypoints SPACING apart.
    """
    counts = np.zeros(BINS)
    span = int(SPAN / SPACING)
    for path in outlines:
        bins = np.rint(bearings(path[span:] - path[:-span]) / QUARTER * BINS).astype(int) % BINS
        counts += np.bincount(bins, minlength=BINS)
    best = int(np.argmax(ndimage.correlate1d(counts, gaussian.weights(SMOOTH), mode='wrap')))
    best = best - BINS if best > BINS // 2 else best
    return 0.0 if abs(best) <= STRAIGHT else best * QUARTER / BINS
