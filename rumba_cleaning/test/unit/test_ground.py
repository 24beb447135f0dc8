"""Where a robot can stand and how it gets about: exact distances, closed forms of ways, obstacles that it met."""

import itertools
import math

import numpy as np
import pytest
from floors import along, ground, length, off, over
from hypothesis import given, settings
from hypothesis import strategies as st
from pytest import approx
from rooms import NAMES, PLANS, RADIUS, crooked, distances, room

from rumba_cleaning.belief.ground import EASE, GROWTH, LARGEST, MARGIN, SHY

GROUNDS = {name: ground(plan) for name, plan in PLANS.items()}
INDEX = st.integers(0, 10 ** 6)
RESOLUTIONS = pytest.mark.parametrize('resolution', [0.02, 0.05, 0.1])


def standing_places(floor):
    """All places at nodes where the robot can stand: float64 (any, 2)."""
    return floor.places(np.argwhere(floor.fits))


def wall_with_gap(resolution=0.05, height=3.0, gap=0.8):
    """A room of 4 m, and a wall across it with a gap at its upper end."""
    return room(4.0, height, resolution, [(1.9, 0.0, 2.1, height - gap)])


def closed_off(resolution=0.05):
    """A room, and another that no door joins to it."""
    return room(4.0, 2.0, resolution, [(1.9, 0.0, 2.1, 2.0)])


# --- places and nodes ----------------------------------------------------------------------------------------------

def test_nodes_and_places_are_as_the_floor_plan_has_them():
    floor = ground(crooked(0.1))
    assert floor.node(1.02, 0.58) == (7, 11) and floor.places([[7, 11]]) == approx(np.array([[1.0, 0.6]]))
    assert floor.nodes([[1.02, 0.58], [0.0, 2.0]]).tolist() == [[7, 11], [21, 1]]
    assert floor.node(-9.0, -9.0) == (0, 0) and floor.node(99.0, 1.0) == (11, 42) and floor.node(1.0, 99.0) == (32, 11)


@RESOLUTIONS
def test_the_robot_can_stand_where_the_exact_distance_leaves_it_room(resolution):
    plan = crooked(resolution, cliff=(3.4, 2.4, 4.0, 3.0))
    floor = ground(plan)
    assert RADIUS < floor.reach < RADIUS + 0.01
    rows, columns = floor.fits.shape
    nodes = np.random.default_rng(3).integers((0, 0), (rows, columns), (300, 2))
    exact = distances(plan, floor.places(nodes))
    beyond = np.maximum(np.array([3.4, 2.4]) - floor.places(nodes), 0.0)  # of the cliff, whose corner this is
    fits = np.minimum(exact, np.hypot(*beyond.T)) >= floor.reach + MARGIN
    assert (floor.fits[nodes[:, 0], nodes[:, 1]] == fits).all() and 50 < fits.sum() < 250
    assert (floor.are_free(floor.places(nodes)) == fits).all()


@RESOLUTIONS
def test_the_nearest_place_to_stand_is_the_nearest_of_all(resolution):
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


def test_the_nearest_place_to_stand_is_another_once_an_obstacle_lies_there():
    floor = ground(room(4.0, 2.0))
    assert floor.standing_at(2.0, 1.0) == floor.node(2.0, 1.0)
    floor.mark(2.0, 1.0, 0.1)
    away = floor.places([floor.standing_at(2.0, 1.0)])[0] - (2.0, 1.0)
    assert floor.reach + 0.1 <= math.hypot(*away) < floor.reach + 0.1 + 0.05


@pytest.mark.parametrize('distance', [0.0, 0.085, 0.3])
@RESOLUTIONS
def test_cells_within_a_distance_of_where_the_robot_can_stand_are_found_and_few_beyond(distance, resolution):
    plan = crooked(resolution)
    floor = ground(plan)
    within = floor.within(distance)
    assert within.shape == plan.occupancy.shape
    free = np.argwhere(floor.fits)
    for row, column in np.random.default_rng(5).integers((0, 0), within.shape, (100, 2)):
        away = min(np.hypot(*(free - (row + 0.5, column + 0.5)).T)) * resolution
        if within[row, column]:
            assert away < distance + 2.0 * resolution
        else:
            assert away > distance


# --- ways ----------------------------------------------------------------------------------------------------------

@settings(max_examples=150)
@given(NAMES, INDEX, INDEX)
def test_a_way_joins_its_places_and_never_comes_nearer_to_a_wall_than_a_robot_can(name, first, second):
    floor = GROUNDS[name]
    places = standing_places(floor)
    start, end = places[first % len(places)], places[second % len(places)]
    way = floor.way(start, end)
    if way is None:
        assert np.isinf(floor.lengths_to(*end)[floor.node(*start)])
    else:
        assert (way[0] == start).all() and (way[-1] == end).all() and way.shape[1] == 2
        assert min(distances(floor.plan, along(way))) >= floor.reach


@settings(max_examples=60)
@given(st.tuples(st.floats(0.2, 3.8), st.floats(0.2, 2.8)), st.tuples(st.floats(0.2, 3.8), st.floats(0.2, 2.8)))
def test_a_way_between_places_that_are_no_nodes_keeps_off_walls_as_well(start, end):
    floor = GROUNDS['crooked', 0.02]
    if min(distances(floor.plan, [start, end])) >= floor.reach + MARGIN:
        way = floor.way(np.array(start), np.array(end))
        assert tuple(way[0]) == start and tuple(way[-1]) == end
        assert min(distances(floor.plan, along(way))) >= floor.reach


def test_a_way_begins_and_ends_at_its_places_also_where_these_are_too_near_to_a_wall():
    floor = ground(room(4.0, 3.0, boxes=[(1.9, 0.0, 2.1, 2.2)]))
    start, end = np.array([0.1, 0.07]), np.array([3.93, 0.5])
    way = floor.way(start, end)
    assert (way[0] == start).all() and (way[-1] == end).all() and len(way) >= 4
    assert min(distances(floor.plan, along(way[1:-1]))) >= floor.reach


@pytest.mark.parametrize('start, end', [((0.5, 0.5), (3.5, 0.5)), ((0.3, 1.9), (3.0, 0.4)), ((3.6, 1.0), (1.0, 0.3))])
@RESOLUTIONS
def test_a_way_through_a_gap_is_hardly_longer_than_the_shortest(resolution, start, end):
    floor = ground(wall_with_gap(resolution))
    found = length(floor.way(np.array(start), np.array(end)))
    left, right = sorted((start, end))
    shortest = over(left, (1.9, 2.2), (2.1, 2.2), right, floor.reach)
    assert shortest <= found <= 1.15 * shortest


@RESOLUTIONS
def test_a_way_to_a_gap_that_is_far_off_is_found_too(resolution):
    floor = ground(wall_with_gap(resolution, 8.0))
    found = length(floor.way(np.array([0.5, 0.5]), np.array([3.5, 0.5])))
    shortest = over((0.5, 0.5), (1.9, 7.2), (2.1, 7.2), (3.5, 0.5), floor.reach)
    assert shortest <= found <= 1.1 * shortest


def test_a_way_is_two_places_where_nothing_is_between_them_and_few_where_something_is():
    for resolution in (0.02, 0.05):
        floor = ground(wall_with_gap(resolution))
        start, end = np.array([0.31, 0.5]), np.array([1.6, 2.71])
        assert (floor.way(start, end) == [start, end]).all()
        assert 4 <= len(floor.way(start, np.array([3.5, 0.5]))) <= 9


@pytest.mark.parametrize('resolution', [0.02, 0.05])
def test_a_way_keeps_a_little_more_off_walls_than_it_must_where_there_is_room(resolution):
    plan = wall_with_gap(resolution)
    floor = ground(plan)
    way = floor.way(np.array([0.5, 0.5]), np.array([3.5, 0.5]))
    assert min(distances(plan, along(way))) >= floor.reach + EASE - 0.01
    beside = np.array([0.19, 0.3]), np.array([0.19, 2.7])
    assert max(distances(plan, along(floor.way(*beside)))) >= floor.reach + EASE
    assert (floor.way(beside[0], beside[0] + (0.0, 0.3)) == [beside[0], beside[0] + (0.0, 0.3)]).all()


def test_there_is_no_way_into_a_region_that_is_closed_off_nor_through_a_gap_that_is_too_narrow():
    start, end = np.array([0.5, 0.5]), np.array([3.5, 0.5])
    assert ground(closed_off()).way(start, end) is None
    assert ground(wall_with_gap(gap=0.35)).way(start, end) is None
    assert ground(wall_with_gap(gap=0.45)).way(start, end) is not None


def test_a_straight_line_is_as_roomy_as_it_is_asked_to_be():
    floor = ground(room(4.0, 2.0))
    low, high = np.array([0.5, 0.25]), np.array([3.5, 0.25])
    assert floor.is_straight(low, high) and floor.is_straight(low, high, 0.07)
    assert not floor.is_straight(low, high, 0.08)
    assert not floor.is_straight(low, np.array([3.5, 0.1]))
    assert not ground(closed_off()).is_straight(np.array([0.5, 1.0]), np.array([3.5, 1.0]))


@settings(max_examples=100)
@given(NAMES, INDEX, INDEX)
def test_a_line_is_straight_where_the_exact_distance_along_it_says_so(name, first, second):
    floor = GROUNDS[name]
    places = standing_places(floor)
    ends = np.array([places[first % len(places)], places[second % len(places)]])
    least = min(distances(floor.plan, along(ends))) - floor.reach
    off_node = 0.75 * floor.plan.resolution  # so far is a place from the nearest node, at most
    if abs(least - MARGIN) > off_node:
        assert floor.is_straight(*ends) == (least > MARGIN)


# --- lengths -------------------------------------------------------------------------------------------------------

@RESOLUTIONS
def test_lengths_in_a_straight_corridor_are_those_of_the_corridor(resolution):
    floor = ground(room(4.0, 0.6, resolution))
    lengths = floor.lengths_to(3.0, 0.3)
    row = floor.node(3.0, 0.3)[0]
    assert lengths.shape == floor.fits.shape
    for x in np.arange(0.3, 3.8, 0.1):
        assert lengths[row, floor.node(x, 0.3)[1]] == approx(abs(x - 3.0), abs=1e-9)
    assert np.isinf(lengths[~floor.fits]).all() and np.isfinite(lengths[floor.fits]).all()
    assert (floor.lengths_to(3.0, 0.03)[floor.fits] <= lengths[floor.fits] + 0.15).all()  # too near to a wall to stand


def test_lengths_go_straight_and_diagonally_and_around_walls():
    floor = ground(wall_with_gap())
    lengths = floor.lengths_to(3.5, 0.5)
    for x, y in [(3.0, 0.3), (2.5, 1.4), (3.7, 2.0)]:
        sides = sorted((abs(x - 3.5), abs(y - 0.5)))
        assert lengths[floor.node(x, y)] == approx(sides[1] + (math.sqrt(2.0) - 1.0) * sides[0])
    around = over((0.5, 0.5), (1.9, 2.2), (2.1, 2.2), (3.5, 0.5), floor.reach)
    assert around <= lengths[floor.node(0.5, 0.5)] <= 1.09 * around


def test_lengths_into_a_region_that_is_closed_off_are_infinite():
    floor = ground(closed_off())
    lengths = floor.lengths_to(3.5, 0.5)
    right = np.arange(floor.fits.shape[1]) * 0.05 > 2.1
    assert np.isfinite(lengths[floor.fits & right]).all() and np.isinf(lengths[floor.fits & ~right]).all()


# --- obstacles that were met ---------------------------------------------------------------------------------------

def exact_room(floor, marks):
    """Distance of each node to walls and round obstacles [m]."""
    rows, columns = np.indices(floor.plan.safe_clearance.shape)
    places = floor.places(np.stack([rows.ravel(), columns.ravel()], axis=1))
    away = [np.maximum(np.hypot(*(places - mark[:2]).T) - mark[2], 0.0) for mark in marks]
    return np.min([floor.plan.safe_clearance.ravel(), *away], axis=0).reshape(rows.shape)


@settings(max_examples=30)
@given(st.sampled_from([0.02, 0.05, 0.1]),
       st.lists(st.tuples(st.floats(-0.3, 4.3), st.floats(-0.3, 3.3), st.floats(0.02, 0.2)), min_size=1, max_size=3))
def test_near_obstacles_that_were_met_there_is_as_much_room_as_they_leave(resolution, marks):
    floor = ground(PLANS['crooked', resolution])
    apart = [mark for index, mark in enumerate(marks) if all(
        math.hypot(mark[0] - other[0], mark[1] - other[1]) > mark[2] + other[2] for other in marks[:index])]
    for mark in apart:
        floor.mark(*mark)
    exact = exact_room(floor, apart)
    limit = floor.reach + SHY
    assert np.minimum(floor.room, limit) == approx(np.minimum(exact, limit))
    assert (floor.room <= floor.plan.safe_clearance).all() and (floor.fits == (floor.room >= floor.reach + MARGIN)).all()


def test_a_way_leads_around_an_obstacle_that_was_met_until_it_is_forgotten():
    floor = ground(room(4.0, 3.0))
    start, end, post = np.array([0.5, 1.4]), np.array([3.5, 1.4]), np.array([2.0, 1.5])
    assert not floor.has_marks and (floor.way(start, end) == [start, end]).all()
    floor.mark(*post, 0.05)
    way = floor.way(start, end)
    assert floor.has_marks and min(np.hypot(*(along(way) - post).T)) >= floor.reach + 0.05
    assert max(off(way, start, end)) < 0.3 and min(way[:, 1]) < 1.3  # past it on its nearer side
    floor.forget()
    assert not floor.has_marks and (floor.way(start, end) == [start, end]).all()
    assert (floor.room == floor.plan.safe_clearance).all()


def test_obstacles_in_a_door_close_it():
    floor = ground(wall_with_gap())
    start, end = np.array([0.5, 0.5]), np.array([3.5, 0.5])
    floor.mark(2.0, 2.6, 0.05)
    assert floor.way(start, end) is None and np.isinf(floor.lengths_to(*end)[floor.node(*start)])
    floor.forget()
    assert floor.way(start, end) is not None and np.isfinite(floor.lengths_to(*end)[floor.node(*start)])


def radius_at(floor, x, y):
    """Of the obstacle around a place, from the room beside it [m]."""
    return 0.4 - float(floor.room[floor.node(x + 0.4, y)])


def test_an_obstacle_that_is_met_again_grows_up_to_a_limit_and_others_do_not():
    floor = ground(room(6.0, 4.0))
    floor.mark(4.0, 2.0, 0.05)
    for times in range(14):
        floor.mark(2.0, 2.0, 0.05)
        if times == 0:
            assert radius_at(floor, 2.0, 2.0) == approx(0.05)
        if times == 2:
            assert radius_at(floor, 2.0, 2.0) == approx(0.05 + 2.0 * GROWTH)
    assert radius_at(floor, 2.0, 2.0) == approx(LARGEST) and radius_at(floor, 4.0, 2.0) == approx(0.05)
    floor.mark(4.05, 2.0, 0.05)  # overlaps the other: met again a little farther on
    assert radius_at(floor, 4.05, 2.0) == approx(0.05 + GROWTH)
    floor.forget()
    floor.mark(2.0, 2.0, 0.05)
    assert radius_at(floor, 2.0, 2.0) == approx(0.05)


def test_an_obstacle_that_was_met_marks_what_leads_through_it_and_walls_do_not():
    floor = ground(room(4.0, 3.0, boxes=[(1.0, 0.0, 1.2, 1.0)]))
    through = np.array([0.5, 0.5]), np.array([3.5, 0.5])
    assert not floor.is_straight(*through) and not floor.is_marked(*through)
    floor.mark(2.5, 1.5, 0.05)
    for (start, end), is_marked in [(((0.5, 1.5), (3.5, 1.5)), True), (((2.5, 0.5), (2.5, 2.5)), True),
                                    (((0.5, 1.25), (3.5, 1.25)), False), (((0.5, 1.75), (3.5, 1.8)), False),
                                    (((0.5, 1.3), (3.5, 1.3)), True), (((2.4, 1.5), (2.4, 1.5)), True),
                                    (((0.5, 1.5), (2.2, 1.5)), False), (((0.5, 0.5), (3.5, 0.5)), False)]:
        assert floor.is_marked(np.array(start), np.array(end)) == is_marked, (start, end)
    floor.forget()
    assert not floor.is_marked(np.array([0.5, 1.5]), np.array([3.5, 1.5]))


def test_every_place_of_a_region_with_obstacles_is_reached_or_has_no_way():
    floor = ground(crooked())
    for mark in ((2.0, 1.0, 0.1), (1.5, 1.5, 0.1), (2.0, 2.5, 0.1)):
        floor.mark(*mark)
    lengths = floor.lengths_to(0.5, 0.5)
    places = standing_places(floor)
    end = np.array([0.5, 0.5])
    for start in itertools.islice(places, 0, None, max(len(places) // 60, 1)):
        way = floor.way(start, end)
        expected = lengths[floor.node(*start)]
        assert (way is None) == np.isinf(expected)
        if way is not None:
            assert math.hypot(*(start - end)) - 1e-9 <= length(way) <= 1.3 * expected + 0.1
