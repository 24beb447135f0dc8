"""The floor plan: a grid of free and blocked cells, and the distance from any point to the nearest obstacle."""

from __future__ import annotations

import copy
import math
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, Sequence, Tuple

import numpy as np
from scipy import ndimage

from rumba_sim.model.common.errors import MapError
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.compiling.compiled import fast
from rumba_sim.model.kernel.sensors.beams import IN_WALL

if TYPE_CHECKING:  # NumPy 1.17 of Ubuntu 20.04 has no numpy.typing
    from numpy.typing import NDArray

OCCUPIED, FREE, UNKNOWN = 100, 0, -1  # the values of nav_msgs/OccupancyGrid
MAX_CELLS = 25_000_000  # the distance fields of a larger map would need gigabytes
MAX_SKIP = IN_WALL - 1  # [cells]
FINE = 0.025  # [m] side of the cells of a refined plan, at most: 36 of them cover a robot
SAMPLE_PITCH = 0.01  # [m] side of the squares with one sample point each, at most: 17 of them lie across a brush
MAX_SAMPLES = 25_000_000  # a byte each; on larger floors the squares are larger
ROUNDING = 1e-9  # [m] by which two equal lengths, computed in two ways, may differ


class Bounds(NamedTuple):
    """Edges of a floor plan in the map frame [m]."""

    left: float
    bottom: float
    right: float
    top: float


class FloorPlan:
    """A map of the floor; everything that is not free (wall, unknown, outside the grid) is an obstacle.

    Cells and nodes: cell (row, column) is a square; its lower left corner is node (row, column), the point
    `origin + resolution * (column, row)`. Row 0 lies at the lowest y, column 0 at the lowest x.

    Attributes:
        name: what messages call it, usually the path of its file.
        occupancy: int8 (rows, columns), OCCUPIED, FREE or UNKNOWN.
        resolution: side of a cell [m].
        origin: x and y of the lower left corner of cell (0, 0) in the map frame [m].
        cliff: bool (rows, columns), cells over which there is no floor; None without cliffs.
        carpet: bool (rows, columns), cells with a carpet; None without carpets.
        dock: pose of a robot that stands at the contacts of the dock and faces it; None without a dock. If there are
            several, the first one.
        further_docks: the same of the others.
        start: pose in which a robot begins; None if the map does not say.
        remarks: what is odd about the file of the map and no error, a line each, for people.
        clearance: float64 (rows + 1, columns + 1), exact distance from each node to the nearest obstacle [m],
            0 inside an obstacle and on its border. C-contiguous.
        skips: uint8 (rows, columns), how many cells a beam may skip from any point of a cell, in any direction,
            without entering an obstacle, at most MAX_SKIP; IN_WALL in an obstacle.
        safe_clearance: as `clearance`, but cliffs count as obstacles too: where a robot may plan to go.
    """

    def __init__(self, name: str, occupancy: NDArray[np.int8], resolution: float, origin: Tuple[float, float], *,
                 cliff: Optional[NDArray[np.bool_]] = None, carpet: Optional[NDArray[np.bool_]] = None,
                 dock: Optional[Pose] = None, further_docks: Sequence[Pose] = (),
                 start: Optional[Pose] = None, remarks: Sequence[str] = ()) -> None:
        """Copy the grid and its layers, and compute the distances.

        Raises:
            MapError: no cell is free, the grid is too large, or a layer has another shape than the grid.
        """
        check_size(name, occupancy.shape)
        self.name = name
        self.occupancy = np.array(occupancy, dtype=np.int8, order='C')
        self.resolution = float(resolution)
        self.origin = (float(origin[0]), float(origin[1]))
        self.cliff = self._layer(cliff, 'cliff')
        self.carpet = self._layer(carpet, 'carpet')
        self.dock = dock
        self.further_docks = tuple(further_docks)
        self.start = start
        self.remarks = tuple(remarks)
        free = self.free
        if not free.any():
            raise MapError(f'{name}: no free floor: every cell is wall or unknown')
        distances = _distances(free)
        self.clearance = distances * self.resolution
        self.skips = np.where(free, _skips(distances), np.uint8(IN_WALL))
        self._refined: Optional[FloorPlan] = None
        self.safe_clearance = self.clearance
        if self.cliff is not None:
            self.safe_clearance = _distances(free & ~self.cliff) * self.resolution

    def _layer(self, layer: Optional[NDArray[np.bool_]], what: str) -> Optional[NDArray[np.bool_]]:
        if layer is None:
            return None
        if layer.shape != self.occupancy.shape:
            raise MapError(f'{self.name}: {what} layer has (rows, columns) {layer.shape}, '
                           f'the map has {self.occupancy.shape}')
        return np.array(layer, dtype=np.bool_, order='C')

    @property
    def docks(self) -> Tuple[Pose, ...]:
        """All docks."""
        return self.further_docks if self.dock is None else (self.dock, *self.further_docks)

    @property
    def free(self) -> NDArray[np.bool_]:
        """Which cells are free: bool (rows, columns)."""
        return np.asarray(self.occupancy == FREE)

    @property
    def rows(self) -> int:
        """Cells along y."""
        return int(self.occupancy.shape[0])

    @property
    def columns(self) -> int:
        """Cells along x."""
        return int(self.occupancy.shape[1])

    @property
    def bounds(self) -> Bounds:
        """The edges of the grid."""
        left, bottom = self.origin
        return Bounds(left, bottom, left + self.columns * self.resolution, bottom + self.rows * self.resolution)

    def cell(self, x: float, y: float) -> Tuple[int, int]:
        """Row and column of the cell that contains a finite point [m], which may lie outside the grid."""
        return (math.floor((y - self.origin[1]) / self.resolution),
                math.floor((x - self.origin[0]) / self.resolution))

    def centre(self, row: int, column: int) -> Tuple[float, float]:
        """x and y of the centre of a cell [m]."""
        return (self.origin[0] + (column + 0.5) * self.resolution, self.origin[1] + (row + 0.5) * self.resolution)

    def contains(self, x: float, y: float) -> bool:
        """Whether a point [m] lies on the grid."""
        return (0.0 <= (x - self.origin[0]) / self.resolution < self.columns
                and 0.0 <= (y - self.origin[1]) / self.resolution < self.rows)

    def clearance_at(self, x: float, y: float) -> float:
        """Distance from a point [m] to the nearest obstacle [m]; 0 outside the grid.

        The distance is interpolated between the nodes (bilinear); its error is at most half a cell.
        """
        return self._interpolated(self.clearance, x, y)

    def safe_clearance_at(self, x: float, y: float) -> float:
        """As `clearance_at`, but to the nearest obstacle or cliff [m]."""
        return self._interpolated(self.safe_clearance, x, y)

    def _interpolated(self, field: NDArray[np.float64], x: float, y: float) -> float:
        left, bottom = self.origin
        value: float = fast.interpolated(field, (x - left) / self.resolution, (y - bottom) / self.resolution)[0]
        return value

    def check_pose(self, pose: Pose, radius: float, what: str) -> None:
        """Refuse a pose in which a round robot does not fit.

        Args:
            pose: of the robot, in the map frame.
            radius: of the robot [m].
            what: what the message calls the pose.

        Raises:
            MapError: the pose is outside the grid, or nearer than `radius` to an obstacle or a cliff.
        """
        place = f'{what} at ({pose.x:.2f}, {pose.y:.2f}) m'
        if not self.contains(pose.x, pose.y):
            left, bottom, right, top = self.bounds
            raise MapError(f'{place} lies outside the map (x {left:.2f} to {right:.2f} m, '
                           f'y {bottom:.2f} to {top:.2f} m)')
        clearance = self.safe_clearance_at(pose.x, pose.y)
        if clearance < radius - ROUNDING:
            nearest = 'wall' if self.clearance_at(pose.x, pose.y) < radius - ROUNDING else 'cliff'
            raise MapError(f'{place} is {clearance:.3f} m from the nearest {nearest}: '
                           f'a robot of radius {radius:.3f} m does not fit')

    def refined(self) -> FloorPlan:
        """The same floor with cells of at most FINE, or this plan if its cells are small enough.

        Distances between the nodes are interpolated, so that smaller cells make narrow passages wider and corners
        sharper, up to what is drawn. On a huge map the cells become no smaller than MAX_CELLS allows.
        """
        parts = self._parts(FINE, MAX_CELLS)
        if parts == 1:
            return self
        if self._refined is None:
            cliff, carpet = (None if layer is None else _enlarged(layer, parts) for layer in (self.cliff, self.carpet))
            self._refined = FloorPlan(self.name, _enlarged(self.occupancy, parts), self.resolution / parts, self.origin,
                                      cliff=cliff, carpet=carpet, dock=self.dock,
                                      further_docks=self.further_docks, start=self.start, remarks=self.remarks)
        return self._refined

    def with_clearance(self, clearance: NDArray[np.float64], safe_clearance: NDArray[np.float64]) -> FloorPlan:
        """The same floor with other distances, of the same shape."""
        plan = copy.copy(self)
        plan.clearance, plan.safe_clearance = clearance, safe_clearance
        return plan

    @property
    def sample_squares(self) -> int:
        """Number n of squares along the side of a cell: the sweep is counted at one point in each of n x n squares."""
        return self._parts(SAMPLE_PITCH, MAX_SAMPLES)

    @property
    def sample_pitch(self) -> float:
        """Side of the squares with one sample point each [m]."""
        return self.resolution / self.sample_squares

    def _parts(self, size: float, most: int) -> int:
        """Into how many parts to divide the side of a cell, for parts of a size [m] and `most` parts in all."""
        return max(min(math.ceil(self.resolution / size - ROUNDING), math.isqrt(most // self.occupancy.size)), 1)

    def most_open_pose(self, among: Optional[NDArray[np.bool_]] = None) -> Pose:
        """The node with the largest safe clearance, facing along x.

        Args:
            among: bool (rows + 1, columns + 1), the nodes from which to choose; None, or none of them: from all.
        """
        space = self.safe_clearance if among is None or not among.any() else np.where(among, self.safe_clearance, -1.0)
        row, column = np.unravel_index(int(np.argmax(space)), space.shape)
        return Pose(self.origin[0] + float(column) * self.resolution,
                    self.origin[1] + float(row) * self.resolution, 0.0)


def _enlarged(grid: Any, parts: int) -> Any:
    """A grid in which each cell is divided into `parts` x `parts` equal cells."""
    return grid.repeat(parts, 0).repeat(parts, 1)


def check_size(name: str, shape: Tuple[int, ...]) -> None:
    """Refuse a grid (rows, columns) of more than MAX_CELLS.

    Raises:
        MapError: it is larger.
    """
    rows, columns = shape
    if rows * columns > MAX_CELLS:
        raise MapError(f'{name}: {columns} x {rows} cells are more than {MAX_CELLS // 1_000_000} million: '
                       'cut the image to the part to be cleaned, or save the map at a coarser resolution')


def _distances(free: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Distance [cells] of each node to the nearest cell that is not free or lies outside the grid.

    The distances are exact: the point of a square that is nearest to a node of its lattice is itself a node. So it is
    enough to mark the nodes that touch an obstacle, and to measure from node to node.
    """
    padded = np.pad(free, 1, mode='constant', constant_values=False)
    inside = padded[:-1, :-1] & padded[:-1, 1:] & padded[1:, :-1] & padded[1:, 1:]
    return np.ascontiguousarray(ndimage.distance_transform_edt(inside), dtype=np.float64)


def _skips(distances: NDArray[np.float64]) -> NDArray[np.uint8]:
    """Whole cells that are free around every point of a cell, from the distances of the nodes [cells].

    Within one cell, each coordinate of the vector to a square of the same lattice is monotonic or zero. So the
    distance to the nearest obstacle is smallest at a corner of the cell. The distances are square roots of integers,
    which are exact if they are whole numbers. A byte for each cell, so that what a laser reads all the time fits into
    the cache of the processor.
    """
    nearest = np.minimum(np.minimum(distances[:-1, :-1], distances[:-1, 1:]),
                         np.minimum(distances[1:, :-1], distances[1:, 1:]))
    return np.minimum(nearest, MAX_SKIP).astype(np.uint8)
