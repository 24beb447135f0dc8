"""The floor on a grid that is turned so that its rows and columns run along the walls, whatever their direction."""

import math
from typing import List

import numpy as np
from scipy import ndimage

from rumba_cleaning.belief.ground import Ground
from rumba_cleaning.planning.rings import SPACING
from rumba_sim.model.kernel import Array

# Our choice, checked by test_turned_floor.py, which allows an error of 1.5 degrees.
SPAN = 0.3  # [m] of a wall, over which its direction is measured: long averages over the steps of the grid
BINS = 90  # of the histogram of directions, in a quarter turn: 1 degree each
SMOOTH = 1.5  # [bins] standard deviation of the filter over the histogram: walls of a drawn map are not quite straight
STRAIGHT = 2  # [bins] a direction this near to an axis of the map counts as the axis: a turned grid is less exact
QUARTER = 0.5 * math.pi  # [rad]


class TurnedFloor:
    """A grid whose axes are turned by an angle against the map's.

    Attributes:
        missed: the cells to clean, bool (rows, columns).
        clearance: distance from each node to the nearest obstacle, float64 (rows + 1, columns + 1) [m].
        resolution: side of a cell [m].
    """

    def __init__(self, ground: Ground, missed: Array, angle: float) -> None:
        """Turn a floor.

        Args:
            ground: where the robot can stand.
            missed: the cells to clean, on the map's grid, bool (rows, columns).
            angle: of this grid's axes against the map's, counter-clockwise [rad].
        """
        plan = ground.plan
        self.resolution = plan.resolution
        if angle == 0.0:
            self.missed, self.clearance = missed, ground.clearance
            self._axes, self._corner = np.eye(2), np.array(plan.origin)
            return
        cos, sin = math.cos(angle), math.sin(angle)
        self._axes = np.array([[cos, sin], [-sin, cos]])  # rows: directions of its columns and rows on the map
        rows, columns = missed.shape
        corners = np.array([[0, 0], [columns, 0], [0, rows], [columns, rows]]) @ self._axes.T  # in cells, turned
        low = np.floor(corners.min(axis=0))
        width, height = (np.ceil(corners.max(axis=0)) - low).astype(int)
        self._corner = low @ self._axes * plan.resolution + plan.origin
        matrix = self._axes[::-1, ::-1].T  # from row and column here to row and column on the map
        offset = (low @ self._axes)[::-1]
        middle = np.array([0.5, 0.5])
        self.missed = ndimage.affine_transform(missed.astype(np.uint8), matrix, offset + matrix @ middle - middle,
                                               (height, width), order=0) > 0
        self.clearance = ndimage.affine_transform(ground.clearance, matrix, offset, (height + 1, width + 1), order=1)

    def points(self, cells: Array) -> Array:
        """The points of the map at which (column, row) of this grid, with fractions, lie: float64 (any, 2) [m]."""
        return np.asarray(cells * self.resolution @ self._axes + self._corner)


def main_direction(outlines: List[Array]) -> float:
    """The angle by which most walls are turned against the map's axes: -pi/4 to pi/4 [rad].

    Args:
        outlines: paths beside the walls, float64 (any, 2) [m] each, with waypoints SPACING apart.
    """
    counts = np.zeros(BINS)
    span = int(SPAN / SPACING)
    for path in outlines:
        dx, dy = (path[span:] - path[:-span]).T
        bins = np.rint(np.arctan2(dy, dx) / QUARTER * BINS).astype(int) % BINS
        counts += np.bincount(bins, minlength=BINS)
    best = int(np.argmax(ndimage.gaussian_filter1d(counts, SMOOTH, mode='wrap')))
    best = best - BINS if best > BINS // 2 else best
    return 0.0 if abs(best) <= STRAIGHT else best * QUARTER / BINS
