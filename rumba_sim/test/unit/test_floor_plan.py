"""The floor plan against distances and reachable cells that are computed cell by cell."""

import math
import pickle

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pytest import approx

from rumba_sim.model.common.errors import MapError
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.kernel.sensors.beams import IN_WALL
from rumba_sim.model.maps.floor_plan import FREE, MAX_CELLS, OCCUPIED, UNKNOWN, FloorPlan, check_size

SIGNS = {'#': OCCUPIED, '.': FREE, '?': UNKNOWN, '~': FREE}


def drawn(text, resolution=1.0, origin=(0.0, 0.0), **kwargs):
    """A floor plan from its picture: top line first, # wall, ? unknown, . free, ~ free and a cliff."""
    lines = text.split()[::-1]
    if '~' in text:
        kwargs['cliff'] = np.array([[sign == '~' for sign in line] for line in lines])
    return FloorPlan('flat', np.array([[SIGNS[sign] for sign in line] for line in lines], np.int8), resolution,
                     origin, **kwargs)


def distance_to_square(x, y, row, column):
    """From a point to the square of a cell; all in cells."""
    return math.hypot(max(column - x, 0.0, x - column - 1.0), max(row - y, 0.0, y - row - 1.0))


def distance_to_blocked(blocked, x, y):
    """From a point on the grid to the nearest blocked cell or the edge; all in cells."""
    rows, columns = blocked.shape
    edge = min(x, y, columns - x, rows - y)
    return min([edge] + [distance_to_square(x, y, row, column) for row, column in np.argwhere(blocked)])


@st.composite
def grids(draw):
    rows, columns = draw(st.integers(1, 7)), draw(st.integers(1, 9))
    cells = draw(st.lists(st.sampled_from([FREE, FREE, FREE, OCCUPIED, UNKNOWN]), min_size=rows * columns,
                          max_size=rows * columns))
    grid = np.array(cells, np.int8).reshape(rows, columns)
    grid[draw(st.integers(0, rows - 1)), draw(st.integers(0, columns - 1))] = FREE
    return grid


@settings(max_examples=60, deadline=None)
@given(grids(), st.sampled_from([0.02, 0.05, 1.0]), st.data())
def test_clearance_and_safe_clearance_are_the_exact_distances_at_every_node(grid, resolution, data):
    cliff = np.array(data.draw(st.lists(st.booleans(), min_size=grid.size, max_size=grid.size))).reshape(grid.shape)
    plan = FloorPlan('flat', grid, resolution, (-1.25, 7.5), cliff=cliff)
    for field in (plan.clearance, plan.safe_clearance):
        assert field.shape == (grid.shape[0] + 1, grid.shape[1] + 1)
        assert field.dtype == np.float64 and field.flags.c_contiguous
    for row in range(grid.shape[0] + 1):
        for column in range(grid.shape[1] + 1):
            x, y = -1.25 + column * resolution, 7.5 + row * resolution
            exact = distance_to_blocked(grid != FREE, column, row) * resolution
            assert plan.clearance[row, column] == approx(exact)
            assert plan.clearance_at(x, y) == approx(exact, abs=1e-9)
            assert plan.safe_clearance[row, column] == approx(
                distance_to_blocked((grid != FREE) | cliff, column, row) * resolution)


def test_between_nodes_clearance_is_interpolated_and_close_to_the_exact_distance():
    plan = drawn('''
        ########
        #......#
        #...#..#
        #......#
        #......#
        ########''')
    corners = plan.clearance[2:4, 2:4]
    x_share, y_share = 0.3, 0.8
    below = corners[0, 0] + x_share * (corners[0, 1] - corners[0, 0])
    above = corners[1, 0] + x_share * (corners[1, 1] - corners[1, 0])
    assert plan.clearance_at(2.3, 2.8) == approx(below + y_share * (above - below))
    blocked = plan.occupancy != FREE
    for x, y in np.random.default_rng(1).uniform((0.0, 0.0), (8.0, 6.0), (200, 2)):
        assert plan.clearance_at(x, y) == approx(distance_to_blocked(blocked, x, y), abs=0.5)


def test_clearance_is_zero_inside_a_wall_outside_the_grid_and_at_no_number():
    plan = drawn('''
        .....
        .....
        ..#..
        .....''', origin=(-1.0, -2.0))
    assert plan.clearance_at(-1.0 + 2.4, -2.0 + 1.7) == 0.0
    for x, y in [(-5.0, 0.0), (4.5, 0.0), (0.0, 2.5), (0.0, -2.5), (math.nan, 0.0), (0.0, math.nan),
                 (math.inf, 0.0), (0.0, -math.inf)]:
        assert plan.clearance_at(x, y) == plan.safe_clearance_at(x, y) == 0.0
        assert not plan.contains(x, y)


def free_cells_around(blocked):
    """How many whole cells are free around each cell, from the distances between squares, in whole numbers."""
    rows, columns = blocked.shape
    result = np.zeros(blocked.shape, int)
    obstacles = np.argwhere(np.pad(blocked, 1, mode='constant', constant_values=True)) - 1
    for row, column in np.ndindex(rows, columns):
        gaps = np.maximum(np.abs(obstacles - (row, column)) - 1, 0)
        result[row, column] = math.isqrt(int(np.min(np.sum(gaps ** 2, axis=1))))
    result[blocked] = IN_WALL
    return result


@settings(max_examples=60, deadline=None)
@given(grids())
def test_skips_are_the_whole_cells_that_are_free_around_every_point_of_a_cell(grid):
    plan = FloorPlan('flat', grid, 0.05, (-1.25, 7.5))
    assert plan.skips.dtype == np.uint8 and (plan.skips == free_cells_around(grid != FREE)).all()


@pytest.mark.parametrize('resolution', [0.02, 0.05, 0.1, 0.3])
def test_skips_are_exact_at_long_distances_too_and_turn_with_the_plan(resolution):
    grid = np.full((33, 41), FREE, np.int8)
    grid[5, 7] = grid[18:22, 30:34] = OCCUPIED
    grid[29, 3:9] = UNKNOWN
    exact = free_cells_around(grid != FREE)
    assert exact[grid == FREE].max() > 10
    assert exact[9, 11] == math.hypot(3, 3) // 1 and exact[9, 12] == math.hypot(3, 4) == 5.0
    for turned in (lambda cells: cells, lambda cells: cells[::-1], lambda cells: cells[:, ::-1],
                   lambda cells: cells[::-1, ::-1], lambda cells: cells.T):
        plan = FloorPlan('flat', turned(grid), resolution, (0.7, -3.1))
        assert (plan.skips == turned(exact)).all()


def test_skips_end_below_the_byte_that_means_a_wall():
    assert FloorPlan('flat', np.zeros((600, 600), np.int8), 0.05, (0.0, 0.0)).skips[298:302, 298].tolist() == [254] * 4


def test_a_cell_contains_its_centre_and_its_left_and_lower_edge():
    plan = FloorPlan('flat', np.zeros((3, 5), np.int8), 0.5, (-1.0, 2.0))
    assert (plan.rows, plan.columns, plan.bounds) == (3, 5, (-1.0, 2.0, 1.5, 3.5))
    assert plan.cell(-1.0, 2.0) == (0, 0)
    assert plan.cell(1.4, 2.6) == (1, 4)
    assert plan.cell(-1.01, 1.99) == (-1, -1)
    assert plan.centre(1, 4) == approx((1.25, 2.75))
    assert plan.contains(-1.0, 2.0) and plan.contains(1.49, 3.49)
    assert not plan.contains(1.5, 2.0) and not plan.contains(0.0, 3.5) and not plan.contains(-1.01, 2.0)


def test_a_plan_keeps_its_own_copy_of_the_grid_and_can_be_sent_to_another_process():
    grid = np.zeros((3, 5), np.int8)
    plan = FloorPlan('flat', grid, 0.5, (0.0, 0.0), carpet=np.eye(3, 5, dtype=bool), dock=Pose(1.0, 0.5, 0.0))
    grid[:] = OCCUPIED
    copy = pickle.loads(pickle.dumps(plan))
    assert copy.free.all() and copy.dock == plan.dock and (copy.carpet == np.eye(3, 5)).all()
    assert copy.clearance_at(1.0, 0.5) == plan.clearance_at(1.0, 0.5) == 0.5


def test_the_most_open_pose_is_far_from_walls_and_from_cliffs():
    picture = '''
        .........
        .........
        .........
        .........
        .......{0}{0}
        ........{0}'''
    assert drawn(picture.format('.'), origin=(10.0, 20.0)).most_open_pose() == Pose(13.0, 23.0, 0.0)
    assert drawn('''
        ..........
        ..........
        ..........
        ~~~~~~~~~.
        ..........
        ..........''', origin=(10.0, 20.0)).most_open_pose() == Pose(11.0, 21.0, 0.0)


TWO_ROOMS = '''
    ########################
    #.........#............#
    #.........#............#
    #......................#
    #......................#
    #......................#
    #.........#............#
    #.........#........~~~~#
    #.........#........~~~~#
    ########################'''


@pytest.mark.parametrize('resolution, refined', [
    (0.005, 0.005), (0.02, 0.02), (0.025, 0.025), (0.03, 0.015), (0.05, 0.025), (0.1, 0.025)])
def test_a_refined_plan_is_the_same_floor_in_cells_of_at_most_25_mm(resolution, refined):
    plan = drawn(TWO_ROOMS, resolution=resolution, origin=(0.5, -1.0), dock=Pose(1.0, 0.0, 0.0))
    fine = plan.refined()
    assert fine.resolution == approx(refined) and (fine is plan) == (refined == resolution)
    assert plan.refined() is fine and fine.refined() is fine
    assert (fine.name, fine.origin, fine.dock, fine.bounds) == (plan.name, plan.origin, plan.dock, approx(plan.bounds))
    parts = round(resolution / refined)
    for layer in ('occupancy', 'cliff'):
        coarse = getattr(plan, layer)
        assert all((getattr(fine, layer)[row::parts, column::parts] == coarse).all()
                   for row, column in np.ndindex(parts, parts))
    assert (fine.clearance[::parts, ::parts] == approx(plan.clearance))
    assert plan.sample_pitch <= 0.01 and plan.sample_pitch * plan.sample_squares == plan.resolution


@pytest.mark.thorough
def test_a_huge_plan_is_not_refined_beyond_the_limit_of_cells():
    plan = FloorPlan('hall', np.zeros((3000, 4000), np.int8), 0.1, (0.0, 0.0))
    assert plan.refined() is plan and plan.sample_squares == 1


@pytest.mark.parametrize('x, y, message', [
    (0.5, 0.13, r'^dock at \(0\.50, 0\.13\) m is 0\.030 m from the nearest wall: '
                r'a robot of radius 0\.170 m does not fit$'),
    (1.05, 0.2, r'^dock at \(1\.05, 0\.20\) m is 0\.000 m from the nearest wall'),
    (2.41, 0.2, r'^dock at \(2\.41, 0\.20\) m lies outside the map \(x 0\.00 to 2\.40 m, y 0\.00 to 1\.00 m\)$'),
    (-0.01, 0.2, r'lies outside the map'),
    (math.nan, 0.2, r'lies outside the map'),
])
def test_a_pose_in_which_the_robot_does_not_fit_is_refused_with_the_reason(x, y, message):
    plan = drawn(TWO_ROOMS, resolution=0.1)
    with pytest.raises(MapError, match=message):
        plan.check_pose(Pose(x, y, 0.0), 0.17, 'dock')


def test_a_pose_with_just_enough_clearance_is_allowed():
    drawn(TWO_ROOMS, resolution=0.1).check_pose(Pose(0.5, 0.3, 1.0), 0.2, 'dock')


def test_a_grid_without_free_floor_is_refused():
    with pytest.raises(MapError, match='^flat: no free floor'):
        drawn('#?#')


def test_a_layer_of_another_shape_is_refused():
    with pytest.raises(MapError, match=r'^flat: carpet layer has \(rows, columns\) \(2, 3\), the map has \(3, 2\)'):
        FloorPlan('flat', np.zeros((3, 2), np.int8), 0.1, (0.0, 0.0), carpet=np.zeros((2, 3), bool))


def test_a_grid_that_is_too_large_is_refused_with_advice():
    check_size('flat', (5000, MAX_CELLS // 5000))
    with pytest.raises(MapError, match='^flat: 5001 x 5000 cells are more than 25 million: cut the image'):
        check_size('flat', (5000, 5001))
