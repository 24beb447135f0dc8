"""An office of 500 m2 with loops, and a drive around them."""

import math

import numpy as np

from rumba_sim.model.common.geometry import Pose, wrap_angle
from rumba_sim.model.maps.floor_plan import FREE, OCCUPIED, FloorPlan

WIDTH, HEIGHT, CELL = 25.0, 20.0, 0.05  # [m]
BLOCKS = ((2.0, 2.0, 11.5, 9.0), (13.5, 2.0, 23.0, 9.0), (2.0, 11.0, 11.5, 18.0), (13.5, 11.0, 23.0, 18.0))
DOORS = 1.1  # [m] wide, in the middle of each long side of a block: rooms behind them make up the block
CORNERS = ((24.0, 1.0), (24.0, 19.0), (1.0, 19.0), (1.0, 10.0), (12.5, 10.0), (12.5, 1.0), (1.0, 1.0), (1.0, 19.0),
           (12.5, 19.0), (12.5, 10.0), (24.0, 10.0), (24.0, 1.0), (1.0, 1.0))
START = Pose(1.0, 1.0, 0.0)


def plan():
    """The floor plan: corridors of 2 m around four blocks of two rooms, with a cupboard here and there."""
    rows, columns = round(HEIGHT / CELL) + 2, round(WIDTH / CELL) + 2
    x, y = (np.arange(columns) - 0.5) * CELL, ((np.arange(rows) - 0.5) * CELL)[:, np.newaxis]
    cells = np.full((rows, columns), OCCUPIED, np.int8)
    cells[1:-1, 1:-1] = FREE

    def fill(left, bottom, right, top, value=OCCUPIED):
        cells[(x > left) & (x < right) & (y > bottom) & (y < top)] = value
    for number, (left, bottom, right, top) in enumerate(BLOCKS):
        fill(left, bottom, right, top)
        middle = 0.5 * (left + right) + 0.4 * number - 0.6
        for first, last in ((left + 0.1, middle - 0.05), (middle + 0.05, right - 0.1)):
            fill(first, bottom + 0.1, last, top - 0.1, FREE)
            door = first + 1.0 + 0.3 * number
            fill(door, bottom - 0.1, door + DOORS, bottom + 0.2, FREE)
        fill(left + 3.0, top, left + 3.8, top + 0.3)
        fill(right, bottom + 2.0 + number, right + 0.35, bottom + 2.9 + number)
    return FloorPlan('office', cells, CELL, (-CELL, -CELL))


def drive(world, speed=0.4):
    """Drive along the corridors by the true pose; yields ten times a second."""
    robot = world.robots['rumba']
    for x, y in CORNERS:
        while math.hypot(x - robot.pose.x, y - robot.pose.y) > 0.2:
            off = wrap_angle(math.atan2(y - robot.pose.y, x - robot.pose.x) - robot.pose.theta)
            robot.command(0.0 if abs(off) > 0.3 else speed, max(min(3.0 * off, 1.5), -1.5), world.tick)
            world.step(5)
            yield
