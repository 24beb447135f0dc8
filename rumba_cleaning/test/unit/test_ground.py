"""Where a robot can stand, and its paths, against exact distances and closed forms."""

import math

import numpy as np
import pytest
from floors import along, ground, length, over, standing_points, wall_with_gap
from hypothesis import given, settings
from hypothesis import strategies as st
from pytest import approx
from rooms import NAMES, PLANS, RADIUS, crooked, distances, room

from rumba_cleaning.belief.ground import EXTRA_CLEARANCE
from rumba_sim.model.reachability import SLACK

GROUNDS = {name: ground(plan) for name, plan in PLANS.items()}
INDEX = st.integers(0, 10 ** 6)
RESOLUTIONS = pytest.mark.parametrize('resolution', [0.02, 0.05, 0.1])


def closed_off(resolution=0.05):
    """A room, and another that no door joins to it."""
    return room(4.0, 2.0, resolution, [(1.9, 0.0, 2.1, 2.0)])


# --- points and nodes ----------------------------------------------------------------------------------------------

def test_nodes_and_points_are_those_of_the_floor_plan():
    floor = ground(crooked(0.1))
    assert floor.node(1.02, 0.58) == (7, 11) and floor.points([[7, 11]]) == approx(np.array([[1.0, 0.6]]))
    assert floor.nodes([[1.02, 0.58], [0.0, 2.0]]).tolist() == [[7, 11], [21, 1]]
    assert floor.node(-9.0, -9.0) == (0, 0) and floor.node(99.0, 1.0) == (11, 42) and floor.node(1.0, 99.0) == (32, 11)


@RESOLUTIONS
def test_the_robot_can_stand_at_nodes_with_enough_exact_distance_to_walls(resolution):
    plan = crooked(resolution, cliff=(3.4, 2.4, 4.0, 3.0))
    floor = ground(plan)
    assert RADIUS < floor.reach < RADIUS + 0.01
    rows, columns = floor.fits.shape
    nodes = np.random.default_rng(3).integers((0, 0), (rows, columns), (300, 2))
    exact = distances(plan, floor.points(nodes))
    beyond = np.maximum(np.array([3.4, 2.4]) - floor.points(nodes), 0.0)  # of the cliff, whose corner this is
    fits = np.minimum(exact, np.hypot(*beyond.T)) >= floor.reach + SLACK
    assert (floor.fits[nodes[:, 0], nodes[:, 1]] == fits).all() and 50 < fits.sum() < 250
    assert (floor.are_free(floor.points(nodes)) == fits).all()


@RESOLUTIONS
def test_the_nearest_node_to_stand_is_the_nearest_of_all(resolution):
    floor = ground(crooked(resolution))
    rows, columns = floor.fits.shape
    nodes = np.random.default_rng(4).integers((0, 0), (rows, columns), (60, 2))
    found = floor.standing(nodes)
    free = np.argwhere(floor.fits)
    assert floor.fits[found[:, 0], found[:, 1]].all()
    for node, nearest in zip(nodes, found):
        assert np.sum((node - nearest) ** 2) == np.sum((free - node) ** 2, axis=1).min()
        if floor.fits[tuple(node)]:
            assert (node == nearest).all()
    assert floor.standing_at(0.0, 1.0) == tuple(floor.standing(floor.nodes([[0.0, 1.0]]))[0])


def test_the_nearest_node_to_stand_changes_when_an_obstacle_is_met_there():
    floor = ground(room(4.0, 2.0))
    assert floor.standing_at(2.0, 1.0) == floor.node(2.0, 1.0)
    floor.mark(2.0, 1.0, 0.1)
    away = floor.points([floor.standing_at(2.0, 1.0)])[0] - (2.0, 1.0)
    assert floor.reach + 0.1 <= math.hypot(*away) < floor.reach + 0.1 + 0.05


@pytest.mark.parametrize('distance', [0.0, 0.085, 0.3])
@RESOLUTIONS
def test_cells_around_where_the_robot_can_go_are_found_and_few_beyond(distance, resolution):
    plan = crooked(resolution)
    floor = ground(plan)
    for y in np.arange(0.0, 3.0, 0.1):
        floor.mark(2.0, y, 0.1)
    within = floor.around(0.5, 0.5, distance)
    assert within.shape == plan.occupancy.shape
    free = np.argwhere(floor.fits)
    free = free[floor.points(free)[:, 0] < 2.0]
    for row, column in np.random.default_rng(5).integers((0, 0), within.shape, (100, 2)):
        away = min(np.hypot(*(free - (row + 0.5, column + 0.5)).T)) * resolution
        if within[row, column]:
            assert away < distance + 2.0 * resolution
        else:
            assert away > distance


# --- paths ---------------------------------------------------------------------------------------------------------

@settings(max_examples=150)
@given(NAMES, INDEX, INDEX)
def test_a_path_joins_its_points_and_never_comes_nearer_to_a_wall_than_a_robot_can(name, first, second):
    floor = GROUNDS[name]
    points = standing_points(floor)
    start, end = points[first % len(points)], points[second % len(points)]
    path = floor.path(start, end)
    if path is None:
        assert np.isinf(floor.path_lengths_to(*end)[floor.node(*start)])
    else:
        assert (path[0] == start).all() and (path[-1] == end).all() and path.shape[1] == 2
        assert min(distances(floor.plan, along(path))) >= floor.reach


@settings(max_examples=60)
@given(st.tuples(st.floats(0.2, 3.8), st.floats(0.2, 2.8)), st.tuples(st.floats(0.2, 3.8), st.floats(0.2, 2.8)))
def test_a_path_between_points_that_are_no_nodes_keeps_off_walls_as_well(start, end):
    floor = GROUNDS['crooked', 0.02]
    if min(distances(floor.plan, [start, end])) >= floor.reach + SLACK:
        path = floor.path(np.array(start), np.array(end))
        assert tuple(path[0]) == start and tuple(path[-1]) == end
        assert min(distances(floor.plan, along(path))) >= floor.reach


def test_a_path_begins_and_ends_at_its_points_even_if_these_are_too_near_to_a_wall():
    floor = ground(room(4.0, 3.0, boxes=[(1.9, 0.0, 2.1, 2.2)]))
    start, end = np.array([0.1, 0.07]), np.array([3.93, 0.5])
    path = floor.path(start, end)
    assert (path[0] == start).all() and (path[-1] == end).all() and len(path) >= 4
    assert min(distances(floor.plan, along(path[1:-1]))) >= floor.reach


@pytest.mark.parametrize('start, end', [((0.5, 0.5), (3.5, 0.5)), ((0.3, 1.9), (3.0, 0.4)), ((3.6, 1.0), (1.0, 0.3))])
@RESOLUTIONS
def test_a_path_through_a_gap_is_little_longer_than_the_shortest(resolution, start, end):
    floor = ground(wall_with_gap(resolution))
    found = length(floor.path(np.array(start), np.array(end)))
    left, right = sorted((start, end))
    shortest = over(left, (1.9, 2.2), (2.1, 2.2), right, floor.reach)
    assert shortest <= found <= 1.15 * shortest


@RESOLUTIONS
def test_a_path_through_a_gap_far_away_is_found_too(resolution):
    floor = ground(wall_with_gap(resolution, 8.0))
    found = length(floor.path(np.array([0.5, 0.5]), np.array([3.5, 0.5])))
    shortest = over((0.5, 0.5), (1.9, 7.2), (2.1, 7.2), (3.5, 0.5), floor.reach)
    assert shortest <= found <= 1.1 * shortest


def test_a_path_is_a_straight_line_if_nothing_is_between_and_has_few_waypoints_if_something_is():
    for resolution in (0.02, 0.05):
        floor = ground(wall_with_gap(resolution))
        start, end = np.array([0.31, 0.5]), np.array([1.6, 2.71])
        assert (floor.path(start, end) == [start, end]).all()
        assert 4 <= len(floor.path(start, np.array([3.5, 0.5]))) <= 9


@pytest.mark.parametrize('resolution', [0.02, 0.05])
def test_a_path_keeps_the_extra_clearance_from_walls_if_the_floor_is_wide_enough(resolution):
    plan = wall_with_gap(resolution)
    floor = ground(plan)
    path = floor.path(np.array([0.5, 0.5]), np.array([3.5, 0.5]))
    assert min(distances(plan, along(path))) >= floor.reach + EXTRA_CLEARANCE - 0.01
    beside = np.array([0.19, 0.3]), np.array([0.19, 2.7])
    assert max(distances(plan, along(floor.path(*beside)))) >= floor.reach + EXTRA_CLEARANCE
    assert (floor.path(beside[0], beside[0] + (0.0, 0.3)) == [beside[0], beside[0] + (0.0, 0.3)]).all()


def test_there_is_no_path_into_a_closed_room_or_through_a_gap_that_is_too_narrow():
    start, end = np.array([0.5, 0.5]), np.array([3.5, 0.5])
    assert ground(closed_off()).path(start, end) is None
    assert ground(wall_with_gap(gap=0.35)).path(start, end) is None
    assert ground(wall_with_gap(gap=0.45)).path(start, end) is not None


def test_a_line_is_straight_if_it_has_the_margin_that_is_asked_for():
    floor = ground(room(4.0, 2.0))
    low, high = np.array([0.5, 0.25]), np.array([3.5, 0.25])
    assert floor.is_straight(low, high) and floor.is_straight(low, high, 0.07)
    assert not floor.is_straight(low, high, 0.08)
    assert not floor.is_straight(low, np.array([3.5, 0.1]))
    assert not ground(closed_off()).is_straight(np.array([0.5, 1.0]), np.array([3.5, 1.0]))


@settings(max_examples=100)
@given(NAMES, INDEX, INDEX)
def test_a_line_is_straight_if_the_exact_distance_to_walls_along_it_says_so(name, first, second):
    floor = GROUNDS[name]
    points = standing_points(floor)
    ends = np.array([points[first % len(points)], points[second % len(points)]])
    least = min(distances(floor.plan, along(ends))) - floor.reach
    off_node = 0.75 * floor.plan.resolution  # distance of a point from the nearest node, at most
    if abs(least - SLACK) > off_node:
        assert floor.is_straight(*ends) == (least > SLACK)


# --- lengths -------------------------------------------------------------------------------------------------------

@RESOLUTIONS
def test_path_lengths_in_a_straight_corridor_are_those_of_the_corridor(resolution):
    floor = ground(room(4.0, 0.6, resolution))
    lengths = floor.path_lengths_to(3.0, 0.3)
    row = floor.node(3.0, 0.3)[0]
    assert lengths.shape == floor.fits.shape
    for x in np.arange(0.3, 3.8, 0.1):
        assert lengths[row, floor.node(x, 0.3)[1]] == approx(abs(x - 3.0), abs=1e-9)
    assert np.isinf(lengths[~floor.fits]).all() and np.isfinite(lengths[floor.fits]).all()
    beside = floor.path_lengths_to(3.0, 0.03)  # too near to a wall to stand there
    assert (beside[floor.fits] <= lengths[floor.fits] + 0.15).all()


def test_path_lengths_go_straight_and_diagonally_and_around_walls():
    floor = ground(wall_with_gap())
    lengths = floor.path_lengths_to(3.5, 0.5)
    for x, y in [(3.0, 0.3), (2.5, 1.4), (3.7, 2.0)]:
        sides = sorted((abs(x - 3.5), abs(y - 0.5)))
        assert lengths[floor.node(x, y)] == approx(sides[1] + (math.sqrt(2.0) - 1.0) * sides[0])
    around = over((0.5, 0.5), (1.9, 2.2), (2.1, 2.2), (3.5, 0.5), floor.reach)
    assert around <= lengths[floor.node(0.5, 0.5)] <= 1.09 * around


def test_path_lengths_into_a_closed_room_are_infinite():
    floor = ground(closed_off())
    lengths = floor.path_lengths_to(3.5, 0.5)
    right = np.arange(floor.fits.shape[1]) * 0.05 > 2.1
    assert np.isfinite(lengths[floor.fits & right]).all() and np.isinf(lengths[floor.fits & ~right]).all()
