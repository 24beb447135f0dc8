"""An occupancy grid that grows with what scans tell, and the distances to its walls, by which scans are matched."""

import math
from typing import Tuple

import numpy as np

from rumba_localisation.mapping import compiled_grid
from rumba_sim.model.geometry import Pose
from rumba_sim.model.kernel import Array

RESOLUTION = 0.02  # [m] side of a cell: twice the noise of a cheap laser
REACH = 25  # [cells] up to which distances to walls are known
NOTHING = (1 << 30, 1 << 30, 0, 0)  # an empty box of cells
CHUNK = 100  # [cells] by which the grid grows, at least


class Grid:
    """What is known of a floor: Moravec and Elfes, High Resolution Maps from Wide Angle Sonar, 1985.

    Attributes:
        origin: x and y of the lower left corner [m]; a multiple of the resolution.
        odds: float32 (rows, columns), logarithm of the odds that a cell is occupied; 0 if nothing is known.
        field: float32 (rows + 1, columns + 1), signed distance from each node to the nearest wall [m].
    """

    def __init__(self) -> None:
        """Know nothing."""
        self.origin: Tuple[float, float] = (0.0, 0.0)
        self.odds: Array = np.zeros((0, 0), np.float32)
        self._hits: Array = np.zeros((0, 0, 5), np.float32)
        self.field: Array = self._far((1, 1))
        self._changed = NOTHING  # cells, since the field was measured

    @staticmethod
    def _far(shape: Tuple[int, int]) -> Array:
        return np.full(shape, REACH * RESOLUTION, np.float32)

    def cells(self, points: Array) -> Array:
        """Points (any, 2) [m] as numbers of cells from the corner of the grid, which have fractions."""
        return (points - np.array(self.origin)) / RESOLUTION

    def add(self, pose: Pose, points: Array, beyond: Array) -> None:
        """Take a scan into account.

        Args:
            pose: of the laser [m, rad].
            points: float64 (any, 2), where beams with an echo end, in the frame of the laser [m].
            beyond: the same for beams without one: up to there they met nothing.
        """
        echoes, others = placed(pose, points), placed(pose, beyond)
        here = np.array([[pose.x, pose.y]])
        self.cover(np.concatenate([here, echoes, others]))
        (x, y), = self.cells(here).tolist()
        free = compiled_grid.add_beams(self.odds, self._hits, x, y, self.cells(others), False)
        met = compiled_grid.add_beams(self.odds, self._hits, x, y, self.cells(echoes), True)
        box = (min(free[0], met[0]), min(free[1], met[1]), max(free[2], met[2]), max(free[3], met[3]))
        self._changed = (min(self._changed[0], box[0]), min(self._changed[1], box[1]),
                         max(self._changed[2], box[2]), max(self._changed[3], box[3]))

    def measure(self) -> None:
        """Bring the field up to date."""
        if self._changed[2] > self._changed[0]:
            compiled_grid.measure(self.odds, self._hits, self.field, self._changed, REACH, RESOLUTION)
        self._changed = NOTHING

    def share_unknown(self, pose: Pose, points: Array) -> float:
        """Share of the beams of a scan, as `add` gets it, that end on cells of which nothing is known [0..1]."""
        return compiled_grid.unknown(self.odds, self.cells(placed(pose, points))) / max(len(points), 1)

    def distance_at(self, x: float, y: float) -> float:
        """Distance from a point [m] to the nearest wall [m], to the nearest node; large if none is near."""
        rows, columns = self.field.shape
        column, row = (round(cells) for cells in self.cells(np.array([x, y])).tolist())
        return abs(float(self.field[row, column])) if 0 <= row < rows and 0 <= column < columns else math.inf

    def cover(self, points: Array) -> None:
        """Grow until points (any, 2) [m] lie on the grid."""
        if not self.odds.size:
            self.origin = (round(points[0, 0] / RESOLUTION) * RESOLUTION, round(points[0, 1] / RESOLUTION) * RESOLUTION)
        low, high = np.floor(self.cells(points.min(axis=0))), np.floor(self.cells(points.max(axis=0)))
        rows, columns = self.odds.shape
        before = [_needed(-int(low[1])), _needed(-int(low[0]))]
        after = [_needed(int(high[1]) - rows + 1), _needed(int(high[0]) - columns + 1)]
        if not any(before + after):
            return
        margins = list(zip(before, after))
        self.odds = np.pad(self.odds, margins)
        self._hits = np.pad(self._hits, [*margins, (0, 0)])
        self._hits[..., 0] += before[1]
        self._hits[..., 1] += before[0]
        self.field = np.pad(self.field, margins, constant_values=REACH * RESOLUTION)
        if self._changed != NOTHING:
            top, left_most, end, right = self._changed
            self._changed = top + before[0], left_most + before[1], end + before[0], right + before[1]
        left, bottom = self.origin
        self.origin = (left - before[1] * RESOLUTION, bottom - before[0] * RESOLUTION)


def _needed(cells: int) -> int:
    """By how many cells to grow if so many are missing."""
    return CHUNK * math.ceil(cells / CHUNK) if cells > 0 else 0


def placed(pose: Pose, points: Array) -> Array:
    """Points (any, 2) of the frame of a pose, in that of the pose [m]."""
    cos, sin = math.cos(pose.theta), math.sin(pose.theta)
    return points @ np.array([[cos, sin], [-sin, cos]]) + (pose.x, pose.y)
