"""How a floor is parted into regions: at doors and nowhere else, and each node lies in one of them."""

import numpy as np
import pytest
from floors import ground, two_rooms
from hypothesis import given, settings
from hypothesis import strategies as st
from rooms import NAMES, PLANS, room
from scipy import ndimage

from rumba_cleaning.planning.decompose.regions import regions, shapes

RESOLUTIONS = pytest.mark.parametrize('resolution', [0.02, 0.05, 0.1])


def labels(floor):
    """The labels of all regions, without 0."""
    return sorted(set(np.unique(regions(floor)).tolist()) - {0})


def at(floor, x, y):
    """The label of the region of a point [m]."""
    return int(regions(floor)[floor.node(x, y)])


@RESOLUTIONS
def test_two_rooms_with_a_door_between_them_are_two_regions_that_meet_in_the_door(resolution):
    floor = ground(two_rooms(resolution))
    of_nodes = regions(floor)
    assert of_nodes.shape == floor.fits.shape and len(labels(floor)) == 2
    x = np.arange(of_nodes.shape[1]) * resolution - resolution
    left, right = (set(np.unique(of_nodes[:, part][floor.fits[:, part]])) for part in (x < 2.6, x > 3.1))
    assert len(left) == len(right) == 1 and left != right


@RESOLUTIONS
def test_an_open_plan_is_one_region(resolution):
    for plan in (room(5.0, 2.4, resolution), room(4.0, 4.0, resolution, [(1.5, 0.0, 4.0, 1.5)])):
        assert len(labels(ground(plan))) == 1


def test_a_wide_passage_is_no_door():
    assert len(labels(ground(room(5.0, 3.0, boxes=[(2.4, 0.0, 2.6, 1.6)])))) == 1
    assert len(labels(ground(room(5.0, 3.0, boxes=[(2.4, 0.0, 2.6, 2.1)])))) == 2


@pytest.mark.parametrize('boxes, count', [
    ([(1.9, 0.0, 2.1, 0.8), (1.9, 1.6, 2.1, 2.4), (3.9, 0.0, 4.1, 0.8), (3.9, 1.6, 4.1, 2.4)], 3),
    ([(1.9, 0.0, 2.1, 0.8), (1.9, 1.6, 2.1, 2.4)], 2)])
def test_doors_part_rooms_into_regions(boxes, count):
    assert len(labels(ground(room(6.0, 2.4, boxes=boxes)))) == count


def test_an_alcove_with_a_wide_part_that_is_too_small_belongs_to_the_room_beside_it():
    floor = ground(room(4.0, 3.0, boxes=[(2.0, 0.0, 2.1, 1.2), (2.0, 1.8, 2.1, 3.0),  # a door ...
                                         (2.1, 0.0, 4.0, 0.9), (2.1, 2.1, 4.0, 3.0)]))  # ... to 1.9 m x 1.2 m
    assert len(labels(floor)) == 1 and at(floor, 3.0, 1.5) == at(floor, 1.0, 1.5)


@RESOLUTIONS
def test_a_narrow_corridor_without_a_wide_part_is_a_region_of_its_own(resolution):
    floor = ground(room(4.0, 0.6, resolution))
    assert len(labels(floor)) == 1 and (regions(floor)[floor.fits] > 0).all()


@pytest.mark.parametrize('width, height, is_open, has_lanes', [(10.0, 10.0, True, False), (5.0, 3.0, False, True),
                                                               (8.0, 0.8, False, False)])
@RESOLUTIONS
def test_lanes_suit_rooms_but_neither_halls_nor_corridors(width, height, is_open, has_lanes, resolution):
    floor = ground(room(width, height, resolution))
    found, label = shapes(floor, regions(floor)), at(floor, 0.5 * width, 0.5 * height)
    assert (found.is_open[label], found.has_lanes[label]) == (is_open, has_lanes)


def test_narrow_corridors_that_nothing_joins_are_separate_regions():
    floor = ground(room(5.0, 3.0, boxes=[(0.0, 0.6, 5.0, 0.7), (0.0, 1.3, 5.0, 1.4)]))
    found = [at(floor, 1.0, y) for y in (0.3, 1.0, 2.2)]
    assert sorted(found) == labels(floor) == sorted(set(found)) and len(found) == 3 and min(found) > 0
    assert found == [at(floor, 4.0, y) for y in (0.3, 1.0, 2.2)]


@settings(max_examples=40)
@given(NAMES)
def test_a_node_has_a_region_if_the_robot_can_stand_there_and_only_then(name):
    floor = ground(PLANS[name])
    assert ((regions(floor) > 0) == floor.fits).all()


@st.composite
def mazes(draw):
    """A room full of pillars."""
    cells = draw(st.lists(st.tuples(st.integers(0, 9), st.integers(0, 7)), max_size=10))
    return room(3.0, 2.4, 0.1, [(0.3 * x, 0.3 * y, 0.3 * x + 0.1, 0.3 * y + 0.1) for x, y in cells])


@settings(max_examples=60)
@given(mazes())
def test_among_pillars_each_node_has_a_region_and_each_region_is_connected(plan):
    floor = ground(plan)
    of_nodes = regions(floor)
    assert ((of_nodes > 0) == floor.fits).all()
    for label in labels(floor):
        assert ndimage.label(of_nodes == label, np.ones((3, 3)))[1] == 1


@pytest.mark.parametrize('boxes', [[(0.0, 0.0, 2.0, 0.9), (2.3, 1.2, 4.0, 3.0)],
                                   [(0.0, 1.2, 1.7, 3.0), (2.0, 0.0, 4.0, 0.9)]])
def test_two_parts_that_meet_only_diagonally_are_one_region_if_only_one_of_them_is_wide(boxes):
    floor = ground(room(4.0, 3.0, 0.1, boxes))
    assert ndimage.label(floor.fits)[1] == 2 and ndimage.label(floor.fits, np.ones((3, 3)))[1] == 1
    assert len(labels(floor)) == 1 and (regions(floor)[floor.fits] > 0).all()
