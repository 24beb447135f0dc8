"""Writes a map that a robot has made as one of map_server, with what else it found: `map:=` takes it."""

import os
import pathlib
from typing import List, Tuple

import numpy as np

from rumba_localisation.mapping.findings import Findings
from rumba_sim.model import drawing
from rumba_sim.model.errors import MapError, quoted
from rumba_sim.model.floor_plan import FREE, OCCUPIED, FloorPlan
from rumba_sim.model.kernel import Array

TITLE = 'A map that a robot has made'
RADIUS = 0.03  # [m] of what was found at a point


def save(path: str, plan: FloorPlan, findings: Findings) -> None:
    """Write a map: the YAML file, an image of the floor, and one of the cliffs if there are any.

    Args:
        path: of the YAML file; the images are written beside it.
        plan: as the laser saw it.
        findings: what it did not see.

    Raises:
        MapError: the path does not end in .yaml, or cannot be written.
    """
    folder, file = os.path.split(os.path.abspath(path))
    name, ending = os.path.splitext(file)
    if ending != '.yaml' or not name:
        raise MapError(f'{quoted(path)}: the file of a map must end in .yaml')
    drawn = drawing.Drawing(*plan.bounds, plan.resolution)
    drawn.paint(plan.occupancy == FREE, drawing.FREE)
    drawn.paint(plan.occupancy == OCCUPIED)
    drawn.paint(_around(plan, findings.touched))
    if findings.cliffs:
        drawn.layers['cliff'] = _around(plan, findings.cliffs)
    try:
        drawn.save(pathlib.Path(folder), name, TITLE, {} if plan.dock is None else {'dock': plan.dock})
    except OSError as error:
        raise MapError(f'{path}: cannot be written: {error.strerror}') from error


def _around(plan: FloorPlan, points: List[Tuple[float, float]]) -> Array:
    """The cells around points [m]: bool (rows, columns)."""
    left, bottom = plan.origin
    x = left + (np.arange(plan.columns) + 0.5) * plan.resolution
    y = (bottom + (np.arange(plan.rows) + 0.5) * plan.resolution)[:, np.newaxis]
    cells = np.zeros((plan.rows, plan.columns), np.bool_)
    for point_x, point_y in points:
        cells |= np.hypot(x - point_x, y - point_y) < RADIUS
    return cells
