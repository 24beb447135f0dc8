"""The floor plan that a grid shows."""

import math
from typing import List, Optional, Tuple

import numpy as np
from scipy import ndimage
from scipy.spatial import cKDTree

from rumba_localisation.mapping.findings import Findings, Point
from rumba_localisation.mapping.grids.grid import Grid
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.kernel import Array
from rumba_sim.model.maps.floor_plan import FREE, OCCUPIED, UNKNOWN, FloorPlan

MOST = 4_000_000  # cells of a plan, if those of its grid are divided
GAPS = 0.08  # [m] half the width of what lies unseen between two beams, and is free if all around it is
BEFORE = 0.002  # [m] before a wall, and more, a cell does not belong to it
SLACK = 0.03  # [m] of its body, at the rim of which the robot may have touched a wall
RADIUS = 0.03  # [m] of what the bumper found at a point
HALF = 0.75  # of a cell, within which of any point there is the centre of a cell
EDGE = 0.022  # [m] the same of a cliff sensor: half of what a robot drives between readings, and half a cell, about
RIM = 2  # [cells] around all that is known


def believed_plan(grid: Grid, name: str, dock: Optional[Pose] = None,
                  findings: Optional[Findings] = None, finest: float = math.inf) -> FloorPlan:
    """The plan of a grid, without the cells around it of which nothing is known.

    Args:
        grid: with some free cells.
        name: of the plan.
        dock: where the dock is, map frame; None if that is not known.
        findings: what the laser did not see; None if there is nothing.
        finest: side of a cell of the plan, at most [m]: larger ones are divided, unless that makes too many.

    Raises:
        MapError: no cell is free.
    """
    side = grid.resolution
    rows, columns = (np.flatnonzero((grid.odds != 0.0).any(axis=axis)) for axis in (1, 0))
    top, left = max(int(rows[0]) - RIM, 0), max(int(columns[0]) - RIM, 0)
    bottom, right = (min(int(used[-1]) + 1 + RIM, size) for used, size in zip((rows, columns), grid.odds.shape))
    odds = np.where(grid.hidden(), np.float32(0.0), grid.odds)[top:bottom, left:right]
    origin = grid.origin[0] + left * side, grid.origin[1] + top * side
    parts = math.ceil(side / finest) if finest < side else 1
    parts = parts if odds.size * parts ** 2 <= MOST else 1
    side /= parts
    cells = occupancy(odds, grid.field[top:bottom + 1, left:right + 1], parts, side)
    cliff = None
    if findings is not None:
        _clear_body(cells, findings, origin, side)
        cells[around(findings.touched, RADIUS, cells.shape, origin, side)] = OCCUPIED
        cliff = around(findings.cliffs, EDGE, cells.shape, origin, side) if findings.cliffs else None
    return FloorPlan(name, cells, side, origin, cliff=cliff, dock=dock)


def _clear_body(cells: Array, findings: Findings, origin: Point, side: float) -> None:
    """Free the occupied cells in which the body of the robot was: a laser that tells too little shows walls there."""
    rows, columns = np.nonzero(cells == OCCUPIED)
    if not findings.stood or not len(rows):
        return
    centres = (np.stack([columns, rows], axis=1) + 0.5) * side + origin
    away = cKDTree(list(findings.stood.values())).query(centres, distance_upper_bound=findings.radius)[0]
    is_body = away < findings.radius - max(side, SLACK)
    cells[rows[is_body], columns[is_body]] = FREE


def occupancy(odds: Array, field: Array, parts: int, side: float) -> Array:
    """OCCUPIED, FREE or UNKNOWN: int8 (parts * rows, parts * columns).

    A beam that errs ends in the cell before a wall. If the centre of a part of that is clearly before the wall, and
    another part shows the wall, it is free: or robots would stay away from walls by half a cell. Of parts behind each
    other the first one shows the wall.

    Args:
        odds: logarithms (rows, columns); 0 tells nothing.
        field: of the grid (rows + 1, columns + 1).
        parts: into which each side of a cell is divided.
        side: of a part [m].
    """
    odds = np.kron(odds, np.ones((parts, parts), np.float32))
    free, occupied = odds < 0.0, odds > 0.0
    off = centres(field, parts)
    before = occupied & (off > BEFORE)
    before &= ndimage.binary_dilation(occupied & ~before, np.ones((3, 3), np.bool_), iterations=parts)
    free, occupied = free | before, occupied & ~before & ((parts == 1) | (off > -side))
    gaps = math.ceil(GAPS / side)
    closed = ndimage.binary_closing(np.pad(free, gaps), np.ones((3, 3), np.bool_), iterations=gaps)[
        gaps:-gaps, gaps:-gaps]
    cells = np.full(odds.shape, UNKNOWN, np.int8)
    cells[free | closed & ~ndimage.binary_dilation(occupied, iterations=2 * parts)] = FREE
    cells[occupied] = OCCUPIED
    return cells


def centres(field: Array, parts: int) -> Array:
    """The field (rows + 1, columns + 1) at the centres of the parts of its cells: (parts * rows, parts * columns)."""
    up = (np.arange(parts, dtype=np.float32) + 0.5) / parts
    rows = (field[:-1, np.newaxis] * (1 - up)[:, np.newaxis] + field[1:, np.newaxis] * up[:, np.newaxis]).reshape(
        -1, field.shape[1])
    return (rows[:, :-1, np.newaxis] * (1 - up) + rows[:, 1:, np.newaxis] * up).reshape(len(rows), -1)


def around(points: List[Point], radius: float, shape: Tuple[int, ...], origin: Tuple[float, float],
           side: float) -> Array:
    """The cells around points: bool (rows, columns).

    Args:
        points: [m], map frame.
        radius: to the centres of the cells [m].
        shape: rows and columns.
        origin: of the cells [m].
        side: of a cell [m].
    """
    rows, columns = shape
    x = origin[0] + (np.arange(columns) + 0.5) * side
    y = (origin[1] + (np.arange(rows) + 0.5) * side)[:, np.newaxis]
    cells = np.zeros((rows, columns), np.bool_)
    radius = max(radius, HALF * side)
    for point_x, point_y in points:
        cells |= np.hypot(x - point_x, y - point_y) < radius
    return cells
