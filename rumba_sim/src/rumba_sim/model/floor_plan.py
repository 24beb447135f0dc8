"""The floor: a grid of free and blocked cells, and how much room there is anywhere on it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple, Optional, Tuple

import numpy as np
from scipy import ndimage

from rumba_sim.model.errors import MapError
from rumba_sim.model.geometry import Pose

if TYPE_CHECKING:  # NumPy 1.17 of Ubuntu 20.04 has no numpy.typing
    from numpy.typing import NDArray

OCCUPIED, FREE, UNKNOWN = 100, 0, -1  # the values of nav_msgs/OccupancyGrid
MAX_CELLS = 25_000_000  # the distance fields of more would want gigabytes
HALF_DIAGONAL = 0.7072  # [cells] of a cell: no place in it is farther from the nearest corner
ROUNDING = 1e-9  # [m] lest two equal lengths, computed in two ways, differ


class Bounds(NamedTuple):
    """Edges of a floor plan in the map frame [m]."""

    left: float
    bottom: float
    right: float
    top: float


class FloorPlan:
    """What is where on the floor; all that is not free (wall, unknown, beyond the grid) is an obstacle.

    Cells and nodes: cell (row, column) is a square whose lower left corner is node (row, column), the place
    `origin + resolution * (column, row)`. Row 0 lies at the lowest y, column 0 at the lowest x.

    Attributes:
        name: what messages call it, mostly the path of its file.
        occupancy: int8 (rows, columns), OCCUPIED, FREE or UNKNOWN.
        resolution: side of a cell [m].
        origin: x and y of the lower left corner of cell (0, 0) in the map frame [m].
        cliff: bool (rows, columns), where the floor drops; None where it never does.
        carpet: bool (rows, columns); None where there is none.
        dock: pose of a robot that stands at the contacts of the dock and faces it; None without a dock.
        start: pose where a robot begins; None where the map leaves it open.
        clearance: float64 (rows + 1, columns + 1), exact distance from each node to the nearest obstacle [m],
            0 on the edge of one and inside it. C-contiguous.
        skips: uint8 (rows, columns), so many whole cells from any place in this one there is no obstacle; at most 255.
        safe_clearance: as `clearance`, but a cliff counts as an obstacle too: where a robot may plan to go.
    """

    def __init__(self, name: str, occupancy: NDArray[np.int8], resolution: float, origin: Tuple[float, float], *,
                 cliff: Optional[NDArray[np.bool_]] = None, carpet: Optional[NDArray[np.bool_]] = None,
                 dock: Optional[Pose] = None, start: Optional[Pose] = None) -> None:
        """Take the grid and its layers, and compute the distances.

        Raises:
            MapError: nothing is free, the grid is too large, or a layer does not have its shape.
        """
        check_size(name, occupancy.shape)
        self.name = name
        self.occupancy = np.array(occupancy, dtype=np.int8, order='C')
        self.resolution = float(resolution)
        self.origin = (float(origin[0]), float(origin[1]))
        self.cliff = self._layer(cliff, 'cliff')
        self.carpet = self._layer(carpet, 'carpet')
        self.dock = dock
        self.start = start
        free = self.free
        if not free.any():
            raise MapError(f'{name}: no free floor: every cell is wall or unknown')
        self.clearance = _distances(free) * self.resolution
        self.skips = _skips(self.clearance / self.resolution)
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
        """Row and column of the cell that holds a place [m], which may lie beyond the grid, but must be finite."""
        return (math.floor((y - self.origin[1]) / self.resolution),
                math.floor((x - self.origin[0]) / self.resolution))

    def centre(self, row: int, column: int) -> Tuple[float, float]:
        """x and y of the middle of a cell [m]."""
        return (self.origin[0] + (column + 0.5) * self.resolution, self.origin[1] + (row + 0.5) * self.resolution)

    def contains(self, x: float, y: float) -> bool:
        """Whether a place [m] is on the grid."""
        return (0.0 <= (x - self.origin[0]) / self.resolution < self.columns
                and 0.0 <= (y - self.origin[1]) / self.resolution < self.rows)

    def clearance_at(self, x: float, y: float) -> float:
        """Distance from a place [m] to the nearest obstacle [m]; 0 beyond the grid.

        Interpolated (bilinear) between the nodes, and so right within half a cell.
        """
        return self._interpolated(self.clearance, x, y)

    def safe_clearance_at(self, x: float, y: float) -> float:
        """As `clearance_at`, but to the nearest obstacle or cliff [m]."""
        return self._interpolated(self.safe_clearance, x, y)

    def _interpolated(self, field: NDArray[np.float64], x: float, y: float) -> float:
        u = (x - self.origin[0]) / self.resolution
        v = (y - self.origin[1]) / self.resolution
        columns, rows = self.columns, self.rows
        if not (0.0 < u < columns and 0.0 < v < rows):  # also where u or v is NaN
            return 0.0
        column, row = int(u), int(v)
        u -= column
        v -= row
        item = field.item  # plain floats: quicker here than NumPy's
        lower = row * (columns + 1) + column
        upper = lower + columns + 1
        return float((item(lower) * (1.0 - u) + item(lower + 1) * u) * (1.0 - v)
                     + (item(upper) * (1.0 - u) + item(upper + 1) * u) * v)

    def check_place(self, pose: Pose, radius: float, what: str) -> None:
        """Refuse a pose where a round robot does not fit.

        Args:
            pose: of the robot, in the map frame.
            radius: of the robot [m].
            what: the name of the place, for the message.

        Raises:
            MapError: the pose is beyond the grid, or nearer than `radius` to an obstacle or a cliff.
        """
        place = f'{self.name}: {what} at ({pose.x:.2f}, {pose.y:.2f}) m'
        if not self.contains(pose.x, pose.y):
            left, bottom, right, top = self.bounds
            raise MapError(f'{place} lies outside the map (x {left:.2f} to {right:.2f} m, '
                           f'y {bottom:.2f} to {top:.2f} m)')
        clearance = self.safe_clearance_at(pose.x, pose.y)
        if clearance < radius - ROUNDING:
            nearest = 'wall' if self.clearance_at(pose.x, pose.y) < radius - ROUNDING else 'cliff'
            raise MapError(f'{place} is {clearance:.3f} m from the nearest {nearest}: '
                           f'a robot of radius {radius:.3f} m does not fit')

    def reachable(self, x: float, y: float, radius: float, brush_width: float) -> NDArray[np.bool_]:
        """Which cells a round robot, the brush across its middle, can sweep from a start.

        The robot may stand in a cell where there is room for it at the cell's centre, and moves from such a cell
        to its four neighbours. The brush then sweeps the free cells whose centre lies within half its width.

        Args:
            x, y: the start [m]; its cell counts as one to stand in.
            radius: of the robot [m].
            brush_width: [m]

        Returns:
            bool (rows, columns)

        Raises:
            MapError: the robot does not fit at the start.
        """
        self.check_place(Pose(x, y, 0.0), radius, 'start')
        clearance = self.safe_clearance
        at_centres = (clearance[:-1, :-1] + clearance[:-1, 1:] + clearance[1:, :-1] + clearance[1:, 1:]) / 4.0
        fits = at_centres >= radius - ROUNDING
        start = self.cell(x, y)
        fits[start] = True
        labels, _ = ndimage.label(fits)
        stands = labels == labels[start]
        swept = ndimage.distance_transform_edt(~stands) * self.resolution <= brush_width / 2.0 + ROUNDING
        if self.cliff is not None:
            swept &= ~self.cliff
        return np.asarray(swept & self.free)

    def most_open_pose(self) -> Pose:
        """The place with the most room around it, facing along x."""
        row, column = np.unravel_index(int(np.argmax(self.safe_clearance)), self.safe_clearance.shape)
        return Pose(self.origin[0] + float(column) * self.resolution,
                    self.origin[1] + float(row) * self.resolution, 0.0)


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
    """Distance of each node to the nearest cell that is not free or lies beyond the grid [cells].

    Exact, since the point of a square that is nearest to a node of its lattice is itself a node: it is enough to
    mark the nodes that touch an obstacle and to measure from node to node.
    """
    padded = np.pad(free, 1, mode='constant', constant_values=False)
    inside = padded[:-1, :-1] & padded[:-1, 1:] & padded[1:, :-1] & padded[1:, 1:]
    return np.ascontiguousarray(ndimage.distance_transform_edt(inside), dtype=np.float64)


def _skips(distances: NDArray[np.float64]) -> NDArray[np.uint8]:
    """How far [cells] a beam may leap from anywhere in a cell, by the distance of its corners to an obstacle [cells].

    A byte for each cell: a laser asks for it so often that it should fit into the processor's cache.
    """
    nearest = np.minimum(np.minimum(distances[:-1, :-1], distances[:-1, 1:]),
                         np.minimum(distances[1:, :-1], distances[1:, 1:]))
    return np.clip(nearest - HALF_DIAGONAL, 0.0, 255.0).astype(np.uint8)
