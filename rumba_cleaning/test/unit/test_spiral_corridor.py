"""A corridor hardly wider than the robot, wound to a spiral: no lane in it is exact, so each round leaves slivers."""

import re

import numpy as np
import pytest
from drivers import run
from missions import mission

from rumba_cleaning.outcome import Outcome
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.maps.floor_plan import FREE, OCCUPIED, FloorPlan

WIDE, WALL, RESOLUTION = 8, 2, 0.05  # [cells], [cells], [m]
STEP = WIDE + WALL
LEGS = ((0, 0), (0, 3), (3, 3), (3, 0), (1, 0), (1, 2), (2, 2), (2, 1))  # where the corridor bends: row and column
BOUND = 5.0  # [T]: our choice; one pass in the middle, and slivers after that, took 7 for 90 %


def spiral():
    """The floor: a corridor of 0.4 m with a dead end in the middle, 1.7 m2."""
    cells = np.full((4 * STEP + WALL, 4 * STEP + WALL), OCCUPIED, np.int8)
    for (row, column), (to_row, to_column) in zip(LEGS, LEGS[1:]):
        bottom, top, left, right = min(row, to_row), max(row, to_row), min(column, to_column), max(column, to_column)
        cells[WALL + bottom * STEP:(top + 1) * STEP, WALL + left * STEP:(right + 1) * STEP] = FREE
    middle = (WALL + 0.5 * WIDE) * RESOLUTION
    return FloorPlan('spiral', cells, RESOLUTION, (0.0, 0.0), start=Pose(middle, middle, 0.0))


@pytest.mark.parametrize('target', [0.98, 0.99])
def test_a_mission_ends_with_an_honest_share_once_rounds_gain_little_and_are_longer_than_the_first(target):
    world, behaviour = mission(spiral(), target=target)
    ideal = world.floor.reachable_area / (world.config.brush.width * 0.3)
    run(behaviour, world, seconds=12.0 * ideal)
    assert behaviour.outcome in (Outcome.SUCCEEDED, Outcome.INCOMPLETE) and world.time < BOUND * ideal
    told = float(re.match('(.*?) % swept', behaviour.message).group(1))
    assert told == pytest.approx(100.0 * world.floor.coverage, abs=0.3) and told > 97.0
    assert (behaviour.outcome is Outcome.SUCCEEDED) == (told >= 100.0 * target)


@pytest.mark.parametrize('width, most', [(0.37, 2.6), (0.4, 1.9)])
def test_a_corridor_that_is_all_of_the_floor_is_driven_along_both_walls(width, most):
    resolution = 0.01
    cells = np.full((round(width / resolution) + 2, 802), OCCUPIED, np.int8)
    cells[1:-1, 1:-1] = FREE
    start = Pose(0.5, 0.5 * width + resolution, 0.0)
    world, behaviour = mission(FloorPlan('corridor', cells, resolution, (0.0, 0.0), start=start), target=0.98)
    ideal = world.floor.reachable_area / (world.config.brush.width * 0.3)
    run(behaviour, world, seconds=most * ideal)
    assert behaviour.outcome is Outcome.SUCCEEDED and world.floor.coverage >= 0.98
