"""Parts of the way along the walls, beside what was missed there."""

import numpy as np
import pytest
from floors import along, ground, length
from pytest import approx
from rooms import distances, room

from rumba_cleaning.planning.swaths.walls import LEAD, LONGEST, Walls

PLAN = room(4.0, 3.0, 0.02)
FLOOR = ground(PLAN)
WALLS = Walls(FLOOR)
RIM = 0.1  # [m] from the wall to what was missed there
FAR = FLOOR.reach  # [m] from the wall to the robot


@pytest.mark.parametrize('first, last', [(1.5, 1.5), (1.5, 1.7), (1.0, 1.4)])
def test_what_was_missed_along_a_wall_is_passed_along_the_wall_as_near_as_the_robot_can(first, last):
    part = WALLS.beside(np.array([[x, RIM] for x in np.arange(first, last + 0.01, 0.02)]))
    assert part[:, 1] == approx(FAR, abs=0.002)
    assert min(distances(PLAN, along(part))) >= FAR
    assert length(part) == approx(last - first + 2.0 * LEAD, abs=0.05)
    assert sorted(part[[0, -1], 0].tolist()) == approx([first - LEAD, last + LEAD], abs=0.03)


def test_the_way_goes_on_where_its_ring_is_closed():
    found = [WALLS.beside(np.array([[x, RIM]])) for x in np.arange(0.5, 3.5, 0.02)]
    assert all(part is not None and len(part) == len(found[0]) for part in found)
    right = [WALLS.beside(np.array([[4.0 - RIM, y]])) for y in np.arange(0.5, 2.5, 0.02)]
    assert all(part is not None and part[:, 0] == approx(4.0 - FAR, abs=0.002) for part in right)


@pytest.mark.parametrize('points', [
    [[2.0, 1.5]],  # in the middle of the room
    [[0.1, 0.1]],  # in a corner
    [[1.0, RIM], [1.0 + LONGEST, RIM]],  # too far apart
    [[1.0, RIM], [1.0, 2.9]]])  # at two walls
def test_elsewhere_there_is_no_part(points):
    assert WALLS.beside(np.array(points)) is None


def test_two_sides_of_a_thin_wall_have_no_part_in_common():
    walls = Walls(ground(room(4.0, 3.0, 0.02, [(1.0, 1.5, 3.0, 1.52)])))
    assert walls.beside(np.array([[2.0, 1.42]])) is not None
    assert walls.beside(np.array([[2.0, 1.42], [2.0, 1.6]])) is None


def test_a_floor_without_room_has_no_walls():
    assert Walls(ground(room(0.2, 0.2, 0.02))).beside(np.array([[0.1, 0.1]])) is None
