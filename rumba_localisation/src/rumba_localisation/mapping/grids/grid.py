"""An occupancy grid that grows with what scans tell, and the distances to its walls, by which scans are matched."""

import math
from typing import NamedTuple, Optional, Tuple

import numpy as np

from rumba_localisation import compiled_matching
from rumba_localisation.mapping.grids import compiled_beams, compiled_grid
from rumba_localisation.noise import Noise
from rumba_localisation.scan import Scan, thinned
from rumba_sim.model.common.geometry import Pose, wrap_angle
from rumba_sim.model.kernel import Array

REACH = 25  # [cells] up to which distances to walls are known
SURE = -2.0  # logarithm of the odds of a cell that is surely free: four beams passed; a wall is as sure with 2.0
AWAY = 2.0  # narrowest sigmas of a match, from a wall, from which on a beam has not met that
BEFORE = 0.1  # [m] of a beam before its end that may be in a wall
CHECKED = 180  # beams, at most, of which it is looked where they pass
HIDES = 4  # [cells] before a wall of which the noise scatters hits, at most: twice its narrowest sigma
NOTHING = (1 << 30, 1 << 30, 0, 0)  # an empty box of cells
CHUNK = 100  # [cells] by which the grid grows, at least


class Fit(NamedTuple):
    """Where a scan fits."""

    pose: Pose  # [m, rad] map frame
    covariance: Array  # float64 (3, 3)
    fit: float  # share of its beams that end at a wall there, weighted [0..1]


class Grid:
    """What is known of a floor: Moravec and Elfes, High Resolution Maps from Wide Angle Sonar, 1985.

    Attributes:
        resolution: side of a cell [m].
        origin: x and y of the lower left corner [m]; a multiple of the resolution.
        odds: float32 (rows, columns), logarithm of the odds that a cell is occupied; 0 if nothing is known.
        field: float32 (rows + 1, columns + 1), signed distance from each node to the nearest wall [m].
    """

    def __init__(self, resolution: float = 0.02) -> None:
        """Know nothing, in cells of a side [m]."""
        self.resolution = resolution
        self.origin: Tuple[float, float] = (0.0, 0.0)
        self.odds: Array = np.zeros((0, 0), np.float32)
        self._hits: Array = np.zeros((0, 0, 5), np.float32)
        self.field: Array = self._far((1, 1))
        self._changed = NOTHING  # cells, since the field was measured

    def _far(self, shape: Tuple[int, int]) -> Array:
        return np.full(shape, REACH * self.resolution, np.float32)

    def cells(self, points: Array) -> Array:
        """Points (any, 2) [m] as numbers of cells from the corner of the grid, which have fractions."""
        return (points - np.array(self.origin)) / self.resolution

    def add(self, pose: Pose, scan: Scan, noise: Noise) -> None:
        """Take a scan into account that was taken at a pose of the robot [m, rad], with the noise of its laser."""
        echoes, others, here = ends_of(pose, scan)
        self.cover(np.concatenate([here, echoes, others]))
        (x, y), = self.cells(here).tolist()
        if self.odds[int(y), int(x)] == 0.0:
            self.odds[int(y), int(x)] = compiled_grid.MISS  # no beam may tell it, but there the robot is
        weights = (noise.kernel / noise.kernels(scan.points, scan.laser)) ** 2
        free = compiled_grid.add_beams(self.odds, self._hits, x, y, self.cells(others), np.ones(len(others)), False)
        met = compiled_grid.add_beams(self.odds, self._hits, x, y, self.cells(echoes), weights, True)
        box = (min(free[0], met[0]), min(free[1], met[1]), max(free[2], met[2]), max(free[3], met[3]))
        self._changed = (min(self._changed[0], box[0]), min(self._changed[1], box[1]),
                         max(self._changed[2], box[2]), max(self._changed[3], box[3]))

    def hidden(self) -> Array:
        """Which occupied cells stand behind others, from where they were met: bool (rows, columns)."""
        found = np.empty(self.odds.shape, np.bool_)
        compiled_grid.hidden(self.odds, self._hits, HIDES, found)
        return found

    def measure(self) -> None:
        """Bring the field up to date."""
        if self._changed[2] > self._changed[0]:
            compiled_grid.measure(self.odds, self._hits, self.field, self._changed, REACH, self.resolution)
        self._changed = NOTHING

    def share_unknown(self, pose: Pose, points: Array) -> float:
        """Share of the beams of a scan, as `add` gets it, that end on cells of which nothing is known [0..1]."""
        return compiled_beams.unknown(self.odds, self.cells(placed(pose, points))) / max(len(points), 1)

    def share_wrong(self, pose: Pose, scan: Scan, noise: Noise, cloud: Optional[Array] = None) -> float:
        """Share of the beams of a scan that end where there is surely nothing, or would have to pass through walls.

        Args:
            pose: of the robot [m, rad].
            scan: with echoes.
            noise: of the laser.
            cloud: float64 (any, 2), ends of beams that count instead of those of the scan, if they end where there is
                nothing; in the frame of the robot [m].
        """
        points = thinned(scan.points, CHECKED)
        kernels = noise.kernels(points, scan.laser)
        (x, y), = self.cells(placed(pose, np.array([scan.laser]))).tolist()
        blocked = compiled_beams.blocked(self.odds, x, y, self.cells(placed(pose, points)), -SURE,
                                         np.maximum(AWAY * kernels, BEFORE) / self.resolution)
        if cloud is not None:
            points, kernels = cloud, noise.kernels(cloud, scan.laser)
        nowhere = compiled_beams.contradicted(self.odds, self.field, self.cells(placed(pose, points)), SURE,
                                              AWAY * kernels)
        return blocked / max(min(len(scan.points), CHECKED), 1) + nowhere / max(len(points), 1)

    def matched(self, start: Pose, prior: Array, points: Array, kernels: Array, steps: Array,
                share: float) -> Fit:
        """Where a scan fits near a pose.

        Args:
            start: from where it is moved [m, rad].
            prior: float64 (3, 3), covariance of that.
            points: float64 (beams, 2), where beams end, in the frame of the robot [m].
            kernels, steps: as for `compiled_matching.match`.
            share: of the beams that err independently.
        """
        found, covariance = np.empty(3), np.empty((3, 3))
        fit = compiled_matching.match(np.array(start), prior, points, kernels, self.field, *self.origin,
                                      self.resolution, steps, share, found, covariance)
        x, y, theta = found.tolist()
        return Fit(Pose(x, y, wrap_angle(theta)), covariance, fit)

    def distance_at(self, x: float, y: float) -> float:
        """Distance from a point [m] to the nearest wall [m], to the nearest node; large if none is near."""
        rows, columns = self.field.shape
        column, row = (round(cells) for cells in self.cells(np.array([x, y])).tolist())
        return abs(float(self.field[row, column])) if 0 <= row < rows and 0 <= column < columns else math.inf

    def size_with(self, pose: Pose, scan: Scan) -> int:
        """How many cells it would have with a scan that was taken at a pose."""
        cells = self.cells(np.concatenate(ends_of(pose, scan)))
        rows, columns = self.odds.shape
        low, high = np.minimum(cells.min(axis=0), 0.0), np.maximum(cells.max(axis=0), (columns, rows))
        return int(np.prod(high - low + CHUNK))

    def cover(self, points: Array) -> None:
        """Grow until points (any, 2) [m] lie on the grid."""
        if not self.odds.size:
            x, y = (np.rint(points[0] / self.resolution) * self.resolution).tolist()
            self.origin = x, y
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
        self.field = np.pad(self.field, margins, constant_values=REACH * self.resolution)
        if self._changed != NOTHING:
            top, left_most, end, right = self._changed
            self._changed = top + before[0], left_most + before[1], end + before[0], right + before[1]
        left, bottom = self.origin
        self.origin = (left - before[1] * self.resolution, bottom - before[0] * self.resolution)


def ends_of(pose: Pose, scan: Scan) -> Tuple[Array, Array, Array]:
    """Where the beams of a scan end that have an echo, where the others do, and where all begin: (any, 2) [m]."""
    return placed(pose, scan.points), placed(pose, scan.beyond), placed(pose, np.array([scan.laser]))


def _needed(cells: int) -> int:
    """By how many cells to grow if so many are missing."""
    return CHUNK * math.ceil(cells / CHUNK) if cells > 0 else 0


def placed(pose: Pose, points: Array) -> Array:
    """Points (any, 2) of the frame of a pose, in that of the pose [m]."""
    cos, sin = math.cos(pose.theta), math.sin(pose.theta)
    return points @ np.array([[cos, sin], [-sin, cos]]) + (pose.x, pose.y)
