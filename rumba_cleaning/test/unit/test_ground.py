"""Where a robot can stand and drive straight, against exact distances and closed forms."""

import math

import numpy as np
import pytest
from floors import GROUNDS, along, closed_off, ground, standing_points
from hypothesis import given, settings
from hypothesis import strategies as st
from pytest import approx
from rooms import NAMES, RADIUS, crooked, distances, room

from rumba_sim.model.floors.reachability import SLACK

INDEX = st.integers(0, 10 ** 6)
RESOLUTIONS = pytest.mark.parametrize('resolution', [0.02, 0.05, 0.1])


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


# --- lines ---------------------------------------------------------------------------------------------------------

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
