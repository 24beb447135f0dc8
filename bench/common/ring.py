"""A ring of corridors that show a laser little: a robot errs there by decimetres until a loop closes."""

import math

from common.drawings import Drawing, box, drawn, union

from rumba_sim.model.common.geometry import Pose

WIDTH, HEIGHT, CORRIDOR, CELL = 26.0, 5.0, 1.0, 0.05  # [m]
PILLARS = (4.0, 8.0, 12.0, 16.0, 20.0)  # [m] x of pillars along the upper corridor; the lower one is bare
THICK, DEEP = 0.4, 0.3  # [m] of a pillar
DOCK = Pose(0.184, 2.0, math.pi)  # at the left wall


def plan():
    """The floor plan."""
    block = box(CORRIDOR, CORRIDOR, WIDTH - CORRIDOR, HEIGHT - CORRIDOR)
    pillars = [box(x, HEIGHT - DEEP, x + THICK, HEIGHT) for x in PILLARS]
    return drawn('ring', Drawing(WIDTH, HEIGHT, union([block, *pillars]), dock=DOCK), CELL)
