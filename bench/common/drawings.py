"""Drawings of floors: functions of x and y that say where walls and cliffs are, at any resolution.

A cell is a wall if any of the points that are looked at in it is one, so that thin walls and legs do not vanish on
large cells.
"""

import math
from typing import Callable, NamedTuple, Optional

import numpy as np

from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.maps.floor_plan import FREE, OCCUPIED, FloorPlan

SAMPLE = 0.025  # [m] between the points that are looked at within a cell, at most
WALL = 0.1  # [m] thickness
LEG = 0.02  # [m] radius of the leg of a chair or a table


class Drawing(NamedTuple):
    """A floor; its corner lies at (0, 0)."""

    width: float  # [m]
    height: float  # [m]
    is_wall: Callable  # of x and y, arrays [m]: bool
    is_cliff: Optional[Callable] = None
    dock: Optional[Pose] = None


def drawn(name, drawing, resolution):
    """The floor plan of a drawing with cells of a resolution [m]."""
    columns, rows = (math.ceil(side / resolution - 1e-6) + 2 for side in (drawing.width, drawing.height))
    count = max(math.ceil(resolution / SAMPLE - 1e-6), 1)
    wall, cliff = np.zeros((2, rows, columns), bool)
    for up in (np.arange(count) + 0.5) / count:
        for right in (np.arange(count) + 0.5) / count:
            x = ((np.arange(columns) + right - 1.0) * resolution)[np.newaxis]
            y = ((np.arange(rows) + up - 1.0) * resolution)[:, np.newaxis]
            inside = (x > 0.0) & (x < drawing.width) & (y > 0.0) & (y < drawing.height)
            wall |= ~inside | drawing.is_wall(x, y)
            if drawing.is_cliff is not None:
                cliff |= drawing.is_cliff(x, y)
    return FloorPlan(name, np.where(wall, OCCUPIED, FREE), resolution, (-resolution, -resolution),
                     cliff=None if drawing.is_cliff is None else cliff & ~wall, dock=drawing.dock)


# --- shapes: functions of x and y -----------------------------------------------------------------------------------

def union(shapes):
    """Where any of the shapes is."""
    def shape(x, y):
        found = np.zeros(np.broadcast(x, y).shape, bool)
        for part in shapes:
            found |= part(x, y)
        return found
    return shape


def box(left, bottom, right, top):
    """A rectangle along the axes."""
    return lambda x, y: (x > left) & (x < right) & (y > bottom) & (y < top)


def disc(centre_x, centre_y, radius):
    """A disc."""
    return lambda x, y: np.hypot(x - centre_x, y - centre_y) < radius


def pentagon(centre_x, centre_y, radius):
    """A pentagon with equal sides; `radius` [m] is that of the circle in it."""
    sides = [(math.cos(angle), math.sin(angle)) for angle in 0.4 * math.pi * np.arange(5)]
    return lambda x, y: np.max([(x - centre_x) * cos + (y - centre_y) * sin for cos, sin in sides], axis=0) < radius


def turned(shape, angle, about):
    """A shape turned about a point."""
    cos, sin = math.cos(angle), math.sin(angle)
    return lambda x, y: shape(about[0] + cos * (x - about[0]) + sin * (y - about[1]),
                              about[1] - sin * (x - about[0]) + cos * (y - about[1]))


def outside(shape):
    """Everything but a shape."""
    return lambda x, y: ~shape(x, y)


def legs(x, y, width, depth, angle=0.0):
    """Four legs of a table or a chair around a point."""
    corners = [(x + a * width / 2, y + b * depth / 2) for a in (-1, 1) for b in (-1, 1)]
    return turned(union([disc(*corner, LEG) for corner in corners]), angle, (x, y))
