"""The floor on a grid that is turned so that its rows and columns run along the walls, whatever their direction."""

import math
from typing import List, Tuple

import numpy as np
from scipy import ndimage

from rumba_cleaning.belief.ground import Ground
from rumba_cleaning.compiled_bearings import bearings
from rumba_cleaning.planning.common.polyline import SPACING
from rumba_sim.model.compiling.compiled import fast
from rumba_sim.model.kernel import Array

# Our choice, checked by test_turned_floor.py, which allows an error of 1.5 degrees.
SPAN = 0.3  # [m] of a wall, over which its direction is measured: long averages over the steps of the grid
BINS = 90  # of the histogram of directions, in a quarter turn: 1 degree each
WEIGHTS = (1, 2, 3, 2, 1)  # of bins that are averaged: walls of a drawn map are not quite straight
STRAIGHT = 2  # [bins] a direction this near to an axis of the map counts as the axis: a turned grid is less exact
Window = Tuple[slice, slice]  # rows and columns


class TurnedFloor:
    """The part of a floor that holds the cells to clean, on a grid whose axes are turned by an angle against the map's.

    Attributes:
        missed: the cells to clean, bool (rows, columns).
        clearance: distance from each node to the nearest obstacle, float64 (rows + 1, columns + 1) [m].
        resolution: side of a cell [m].
    """

    def __init__(self, ground: Ground, missed: Array, within: Window, angle: float, margin: float) -> None:
        """Turn the part of a floor.

        Args:
            ground: where the robot can stand.
            missed: the cells to clean, on the map's grid, bool (rows, columns).
            within: the window of the map that holds them.
            angle: of this grid's axes against the map's, counter-clockwise [rad].
            margin: around the window that belongs to the part [m]; off the map there is nothing to clean, and no
                clearance.
        """
        self.resolution = ground.plan.resolution
        self._origin = ground.plan.origin
        cos, sin = math.cos(angle), math.sin(angle)
        self._axes = np.array([[cos, sin], [-sin, cos]])  # rows: directions of its columns and rows on the map
        beside = math.ceil(margin / self.resolution)
        top, bottom, left, right = (end for side in within for end in (side.start - beside, side.stop + beside))
        corners = _on_axes(np.array([[left, top], [left, bottom], [right, top], [right, bottom]]), self._axes.T)
        self._low = np.floor(corners.min(axis=0))  # column and row, from the map's corner
        shape = (np.ceil(corners.max(axis=0)) - self._low + 1.0).astype(int)[::-1]
        nodes = _on_axes(np.indices(shape)[::-1].reshape(2, -1).T + self._low, self._axes)
        cells = np.floor(nodes + 0.5 * self._axes.sum(axis=0)).astype(int)[:, ::-1]
        is_on_map = ((cells >= 0) & (cells < missed.shape)).all(axis=1)
        cells[~is_on_map] = 0
        self.missed = (is_on_map & missed[cells[:, 0], cells[:, 1]]).reshape(shape)[:-1, :-1]
        self.clearance = np.asarray(fast.interpolated_at(ground.clearance, 0.0, 0.0, 1.0, nodes)).reshape(shape)

    def points(self, cells: Array) -> Array:
        """The points of the map at which (column, row) of this grid, with fractions, lie: float64 (..., 2) [m]."""
        return _on_axes((cells + self._low) * self.resolution, self._axes) + self._origin


def _on_axes(points: Array, axes: Array) -> Array:
    """points @ axes, (..., 2) and (2, 2): BLAS rounds as it likes, and plans must not depend on its build."""
    return points[..., :1] * axes[0] + points[..., 1:] * axes[1]


def main_direction(outlines: List[Array]) -> float:
    """The angle by which most walls are turned against the map's axes: -pi/4 to pi/4 [rad].

    Args:
        outlines: paths beside the walls, float64 (any, 2) [m] each, with waypoints SPACING apart.
    """
    counts = np.zeros(BINS)
    span = int(SPAN / SPACING)
    for path in outlines:
        bins = np.rint(bearings(path[span:] - path[:-span]) / (0.5 * math.pi) * BINS).astype(int) % BINS
        counts += np.bincount(bins, minlength=BINS)
    best = int(np.argmax(ndimage.correlate1d(counts, WEIGHTS, mode='wrap')))
    best = best - BINS if best > BINS // 2 else best
    return 0.0 if abs(best) <= STRAIGHT else best * 0.5 * math.pi / BINS
