"""The floor around a robot that has no map."""

import math

import numpy as np

from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.maps.floor_plan import FREE, FloorPlan

SIZE = 6.0  # [m] of a plan: more than a robot drives until it gets the next one, and sees, to all sides
CELL = 0.05  # [m]


def blank(pose: Pose) -> FloorPlan:
    """A plan of free floor around a pose, in the frame of that: such a robot knows of nothing in its way."""
    cells = int(SIZE / CELL)
    left, bottom = (CELL * math.floor((middle - 0.5 * SIZE) / CELL) for middle in pose[:2])
    return FloorPlan('the floor around the robot', np.full((cells, cells), FREE, np.int8), CELL, (left, bottom))
