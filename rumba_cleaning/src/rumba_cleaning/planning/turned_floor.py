"""A floor turned so that its walls, whatever their direction on the map, run along rows and columns."""

import math

import numpy as np
from scipy import ndimage
from skimage import measure

from rumba_cleaning.belief.ground import Ground
from rumba_cleaning.planning.walls import MARGIN, STEP, resampled
from rumba_sim.model.kernel import Array

REACH = 0.3  # [m] of wall whose direction is taken
BINS = 90  # directions that are told apart in a quarter turn
SMOOTH = 1.5  # [bins]
STRAIGHT = 2  # [bins] so nearly along the map's axes is along them
QUARTER = 0.5 * math.pi


class TurnedFloor:
    """A grid whose axes are turned by an angle against the map's.

    Attributes:
        missed: what there is to clean, bool (rows, columns).
        room: distance from each node to the nearest obstacle, float64 (rows + 1, columns + 1) [m].
        resolution: side of a cell [m].
    """

    def __init__(self, ground: Ground, missed: Array, angle: float) -> None:
        """Turn a floor by an angle [rad], counter-clockwise."""
        plan = ground.plan
        self.resolution = plan.resolution
        if angle == 0.0:
            self.missed, self.room = missed, ground.room
            self._axes, self._corner = np.eye(2), np.array(plan.origin)
            return
        cos, sin = math.cos(angle), math.sin(angle)
        self._axes = np.array([[cos, sin], [-sin, cos]])  # rows: directions of its columns and rows on the map
        rows, columns = missed.shape
        corners = np.array([[0, 0], [columns, 0], [0, rows], [columns, rows]]) @ self._axes.T  # in cells, turned
        low = np.floor(corners.min(axis=0))
        width, height = (np.ceil(corners.max(axis=0)) - low).astype(int)
        self._corner = low @ self._axes * plan.resolution + plan.origin
        matrix = self._axes[::-1, ::-1].T  # from row and column here to row and column there
        offset = (low @ self._axes)[::-1]
        middle = np.array([0.5, 0.5])
        self.missed = ndimage.affine_transform(missed.astype(np.uint8), matrix, offset + matrix @ middle - middle,
                                               (height, width), order=0) > 0
        self.room = ndimage.affine_transform(ground.room, matrix, offset, (height + 1, width + 1), order=1)

    def places(self, cells: Array) -> Array:
        """Where on the map (column, row) of this grid, any fractions of them (any, 2), lie: (any, 2) [m]."""
        return np.asarray(cells * self.resolution @ self._axes + self._corner)


def main_direction(ground: Ground) -> float:
    """By which angle most walls are turned against the map's axes: -pi/4 to pi/4 [rad]."""
    counts = np.zeros(BINS)
    span = int(REACH / STEP)
    for contour in measure.find_contours(ground.room, ground.reach + MARGIN):
        places = resampled(ground.places(contour), STEP)
        dx, dy = (places[span:] - places[:-span]).T
        bins = np.rint(np.arctan2(dy, dx) / QUARTER * BINS).astype(int) % BINS
        counts += np.bincount(bins, minlength=BINS)
    best = int(np.argmax(ndimage.gaussian_filter1d(counts, SMOOTH, mode='wrap')))
    best = best - BINS if best > BINS // 2 else best
    return 0.0 if abs(best) <= STRAIGHT else best * QUARTER / BINS
