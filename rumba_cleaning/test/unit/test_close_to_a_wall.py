"""A robot that begins where its map shows a wall too close: the nearest node is free, its pose is not."""

import math

from missions import mission
from rooms import RADIUS, room

from rumba_cleaning.control import steps
from rumba_sim.model.common.geometry import Pose


def test_a_robot_so_close_to_a_wall_of_its_map_that_it_would_not_fit_begins_nevertheless():
    start = Pose(4.0 - RADIUS + 0.002, 1.2, math.pi)
    world, behaviour = mission(room(4.0, 3.0, 0.02), truth=room(4.02, 3.0, 0.02), start=start)
    assert behaviour._context.ground.are_free([start[:2]])[0]
    assert behaviour._context.plan.safe_clearance_at(*start[:2]) < RADIUS
    for _ in steps(behaviour, world, seconds=5.0):
        pass
    assert math.hypot(*(a - b for a, b in zip(behaviour._context.swept.start, start))) < 0.05
    assert behaviour._context.swept.reachable_area > 9.0
