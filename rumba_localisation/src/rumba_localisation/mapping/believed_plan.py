"""The floor plan that a grid shows."""

from typing import Optional

import numpy as np
from scipy import ndimage

from rumba_localisation.mapping.grid import RESOLUTION, Grid
from rumba_sim.model.floor_plan import FREE, OCCUPIED, UNKNOWN, FloorPlan
from rumba_sim.model.geometry import Pose
from rumba_sim.model.kernel import Array

GAPS = 4  # [cells] half the width of what lies unseen between two beams, and is free if all around it is
RIM = 2  # [cells] around all that is known


def believed_plan(grid: Grid, name: str, dock: Optional[Pose] = None) -> FloorPlan:
    """The plan of a grid, without the cells around it of which nothing is known.

    Args:
        grid: with some free cells.
        name: of the plan.
        dock: where the dock is, map frame; None if that is not known.

    Raises:
        MapError: no cell is free.
    """
    rows, columns = (np.flatnonzero((grid.odds != 0.0).any(axis=axis)) for axis in (1, 0))
    top, left = max(int(rows[0]) - RIM, 0), max(int(columns[0]) - RIM, 0)
    odds = grid.odds[top:int(rows[-1]) + 1 + RIM, left:int(columns[-1]) + 1 + RIM]
    x, y = grid.origin
    return FloorPlan(name, occupancy(odds), RESOLUTION, (x + left * RESOLUTION, y + top * RESOLUTION), dock=dock)


def occupancy(odds: Array) -> Array:
    """OCCUPIED, FREE or UNKNOWN, by the logarithms of the odds (rows, columns), in which 0 tells nothing: int8."""
    free, occupied = odds < 0.0, odds > 0.0
    closed = ndimage.binary_closing(np.pad(free, GAPS), np.ones((3, 3), np.bool_), iterations=GAPS)[
        GAPS:-GAPS, GAPS:-GAPS]
    cells = np.full(odds.shape, UNKNOWN, np.int8)
    cells[free | closed & ~ndimage.binary_dilation(occupied, iterations=2)] = FREE
    cells[occupied] = OCCUPIED
    return cells
