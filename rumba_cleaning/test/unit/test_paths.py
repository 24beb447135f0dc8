"""Paths from point to point, and their lengths, against exact distances and closed forms."""

import math

import numpy as np
import pytest
from floors import GROUNDS, along, closed_off, ground, length, over, standing_points, wall_with_gap
from hypothesis import given, settings
from hypothesis import strategies as st
from pytest import approx
from rooms import NAMES, distances, room

from rumba_cleaning.belief import paths
from rumba_cleaning.belief.paths import EXTRA_CLEARANCE
from rumba_sim.model.floors.reachability import SLACK

INDEX = st.integers(0, 10 ** 6)
RESOLUTIONS = pytest.mark.parametrize('resolution', [0.02, 0.05, 0.1])


@settings(max_examples=150)
@given(NAMES, INDEX, INDEX)
def test_a_path_joins_its_points_and_never_comes_nearer_to_a_wall_than_a_robot_can(name, first, second):
    floor = GROUNDS[name]
    points = standing_points(floor)
    start, end = points[first % len(points)], points[second % len(points)]
    path = paths.between(floor, start, end)
    if path is None:
        assert np.isinf(paths.lengths_to(floor, *end)[floor.node(*start)])
    else:
        assert (path[0] == start).all() and (path[-1] == end).all() and path.shape[1] == 2
        assert min(distances(floor.plan, along(path))) >= floor.reach


@settings(max_examples=60)
@given(st.tuples(st.floats(0.2, 3.8), st.floats(0.2, 2.8)), st.tuples(st.floats(0.2, 3.8), st.floats(0.2, 2.8)))
def test_a_path_between_points_that_are_no_nodes_keeps_off_walls_as_well(start, end):
    floor = GROUNDS['crooked', 0.02]
    if min(distances(floor.plan, [start, end])) >= floor.reach + SLACK:
        path = paths.between(floor, np.array(start), np.array(end))
        assert tuple(path[0]) == start and tuple(path[-1]) == end
        assert min(distances(floor.plan, along(path))) >= floor.reach


def test_a_path_begins_and_ends_at_its_points_even_if_these_are_too_near_to_a_wall():
    floor = ground(room(4.0, 3.0, boxes=[(1.9, 0.0, 2.1, 2.2)]))
    start, end = np.array([0.1, 0.07]), np.array([3.93, 0.5])
    path = paths.between(floor, start, end)
    assert (path[0] == start).all() and (path[-1] == end).all() and len(path) >= 4
    assert min(distances(floor.plan, along(path[1:-1]))) >= floor.reach


@pytest.mark.parametrize('start, end', [((0.5, 0.5), (3.5, 0.5)), ((0.3, 1.9), (3.0, 0.4)), ((3.6, 1.0), (1.0, 0.3))])
@RESOLUTIONS
def test_a_path_through_a_gap_is_little_longer_than_the_shortest(resolution, start, end):
    floor = ground(wall_with_gap(resolution))
    found = length(paths.between(floor, np.array(start), np.array(end)))
    left, right = sorted((start, end))
    shortest = over(left, (1.9, 2.2), (2.1, 2.2), right, floor.reach)
    assert shortest <= found <= 1.15 * shortest


@RESOLUTIONS
def test_a_path_through_a_gap_far_away_is_found_too(resolution):
    floor = ground(wall_with_gap(resolution, 8.0))
    found = length(paths.between(floor, np.array([0.5, 0.5]), np.array([3.5, 0.5])))
    shortest = over((0.5, 0.5), (1.9, 7.2), (2.1, 7.2), (3.5, 0.5), floor.reach)
    assert shortest <= found <= 1.1 * shortest


def test_a_path_is_a_straight_line_if_nothing_is_between_and_has_few_waypoints_if_something_is():
    for resolution in (0.02, 0.05):
        floor = ground(wall_with_gap(resolution))
        start, end = np.array([0.31, 0.5]), np.array([1.6, 2.71])
        assert (paths.between(floor, start, end) == [start, end]).all()
        assert 4 <= len(paths.between(floor, start, np.array([3.5, 0.5]))) <= 9


@pytest.mark.parametrize('resolution', [0.02, 0.05])
def test_a_path_keeps_the_extra_clearance_from_walls_if_the_floor_is_wide_enough(resolution):
    plan = wall_with_gap(resolution)
    floor = ground(plan)
    path = paths.between(floor, np.array([0.5, 0.5]), np.array([3.5, 0.5]))
    assert min(distances(plan, along(path))) >= floor.reach + EXTRA_CLEARANCE - 0.01
    beside = np.array([0.19, 0.3]), np.array([0.19, 2.7])
    assert max(distances(plan, along(paths.between(floor, *beside)))) >= floor.reach + EXTRA_CLEARANCE
    assert (paths.between(floor, beside[0], beside[0] + (0.0, 0.3)) == [beside[0], beside[0] + (0.0, 0.3)]).all()


def test_there_is_no_path_into_a_closed_room_or_through_a_gap_that_is_too_narrow():
    start, end = np.array([0.5, 0.5]), np.array([3.5, 0.5])
    assert paths.between(ground(closed_off()), start, end) is None
    assert paths.between(ground(wall_with_gap(gap=0.35)), start, end) is None
    assert paths.between(ground(wall_with_gap(gap=0.45)), start, end) is not None


# --- lengths -------------------------------------------------------------------------------------------------------

@RESOLUTIONS
def test_path_lengths_in_a_straight_corridor_are_those_of_the_corridor(resolution):
    floor = ground(room(4.0, 0.6, resolution))
    lengths = paths.lengths_to(floor, 3.0, 0.3)
    row = floor.node(3.0, 0.3)[0]
    assert lengths.shape == floor.fits.shape
    for x in np.arange(0.3, 3.8, 0.1):
        assert lengths[row, floor.node(x, 0.3)[1]] == approx(abs(x - 3.0), abs=1e-9)
    assert np.isinf(lengths[~floor.fits]).all() and np.isfinite(lengths[floor.fits]).all()
    beside = paths.lengths_to(floor, 3.0, 0.03)  # too near to a wall to stand there
    assert (beside[floor.fits] <= lengths[floor.fits] + 0.15).all()


def test_path_lengths_go_straight_and_diagonally_and_around_walls():
    floor = ground(wall_with_gap())
    lengths = paths.lengths_to(floor, 3.5, 0.5)
    for x, y in [(3.0, 0.3), (2.5, 1.4), (3.7, 2.0)]:
        sides = sorted((abs(x - 3.5), abs(y - 0.5)))
        assert lengths[floor.node(x, y)] == approx(sides[1] + (math.sqrt(2.0) - 1.0) * sides[0])
    around = over((0.5, 0.5), (1.9, 2.2), (2.1, 2.2), (3.5, 0.5), floor.reach)
    assert around <= lengths[floor.node(0.5, 0.5)] <= 1.09 * around


def test_path_lengths_into_a_closed_room_are_infinite():
    floor = ground(closed_off())
    lengths = paths.lengths_to(floor, 3.5, 0.5)
    right = np.arange(floor.fits.shape[1]) * 0.05 > 2.1
    assert np.isfinite(lengths[floor.fits & right]).all() and np.isinf(lengths[floor.fits & ~right]).all()
