"""From lane to lane: half circles where they fit, other ways where they do not, and all lanes in each manner."""

import math

import numpy as np
import pytest
from floors import along, ground, length
from pytest import approx
from rooms import distances, room

from rumba_cleaning.planning.links import BENDS, CORNERS, OFFSET, cell_manners

PLAN = room(4.0, 3.0)
FLOOR = ground(PLAN)
LANE = 0.17  # [m] from lane to lane


def lanes(*ends, step=LANE, bottom=1.0):
    """Along x from the first to the second of each of the ends [m], one above the other."""
    return [np.array([[left, bottom + step * index], [right, bottom + step * index]])
            for index, (left, right) in enumerate(ends)]


def between(floor, one, other):
    """Places between two lanes, in the manner that begins with the first end of the first."""
    way = cell_manners(floor, [one, other])[0]
    assert (way[:2] == one).all() and (way[-2:] == other[::-1]).all()
    return way[2:-2]


def turned(places, angle, about=(2.0, 1.5)):
    """Places turned about one of them."""
    cos, sin = math.cos(angle), math.sin(angle)
    return (np.asarray(places) - about) @ np.array([[cos, sin], [-sin, cos]]) + about


@pytest.mark.parametrize('angle', [0.0, 0.6, math.pi / 2.0, math.pi])
@pytest.mark.parametrize('step', [0.17, -0.17, 0.1, 0.3])
def test_two_lanes_side_by_side_are_joined_by_a_half_circle_beyond_their_ends(step, angle):
    one, other = (turned(lane, angle) for lane in lanes((1.2, 2.8), (1.2, 2.8), step=step, bottom=1.5))
    bend = between(FLOOR, one, other)
    middle, ahead = 0.5 * (one[1] + other[1]), (one[1] - one[0]) / 1.6
    assert len(bend) == CORNERS and bend[0] == approx(one[1]) and bend[-1] == approx(other[1])
    assert np.hypot(*(bend - middle).T) == approx(0.5 * abs(step))
    assert (((bend - middle) @ ahead)[1:-1] > 0.01).all()
    assert length(np.concatenate([one, bend])) == approx(1.6 + 0.5 * math.pi * abs(step), rel=0.01)


@pytest.mark.parametrize('first, second', [(2.4, 2.7), (2.7, 2.4)])
def test_a_half_circle_lies_beyond_the_end_that_is_farther_out(first, second):
    bend = between(FLOOR, *lanes((1.0, first), (1.0, second)))
    assert len(bend) == CORNERS and np.hypot(*(bend - (2.7, 1.0 + 0.5 * LANE)).T) == approx(0.5 * LANE)
    assert (bend[1:-1, 0] > 2.7).all() and bend[0] == approx([2.7, 1.0]) and bend[-1] == approx([2.7, 1.0 + LANE])


@pytest.mark.parametrize('ends', [((1.0, 3.78), (1.0, 3.78)), ((1.0, 3.6), (1.0, 3.8))])
def test_where_a_half_circle_would_touch_a_wall_there_is_another_way(ends):
    one, other = lanes(*ends)
    way = np.concatenate([one[1:], between(FLOOR, one, other), other[1:]])
    assert min(distances(PLAN, along(way))) >= FLOOR.reach and length(way) < 0.35
    assert way[:, 0].max() <= 3.8 + 1e-9


def test_where_an_obstacle_was_met_beside_the_lanes_there_is_another_way():
    floor = ground(PLAN)
    one, other = lanes((1.0, 2.5), (1.0, 2.5))
    assert len(between(floor, one, other)) == CORNERS
    floor.mark(2.79, 1.085, 0.05)
    assert len(between(floor, one, other)) < CORNERS


def test_lanes_that_are_not_side_by_side_are_joined_by_the_way_between_them():
    for one, other in (lanes((1.0, 2.5), (1.0, 2.5), step=BENDS[1] + 0.05), lanes((1.0, 2.0), (1.0, 2.1 + OFFSET)),
                       lanes((1.0, 2.5), (1.0, 2.5), step=0.03)):
        assert len(between(FLOOR, one, other)) == 0  # straight on


def test_a_way_from_lane_to_lane_leads_around_what_is_between_them():
    plan = room(4.0, 3.0, boxes=[(1.0, 1.3, 3.0, 1.5)])
    floor = ground(plan)
    one, other = np.array([[0.7, 1.0], [2.5, 1.0]]), np.array([[0.7, 1.8], [2.5, 1.8]])
    way = np.concatenate([one[1:], between(floor, one, other), other[1:]])
    assert len(way) >= 4 and min(distances(plan, along(way))) >= floor.reach
    assert 1.6 < length(way) < 2.2


def test_lanes_that_no_way_joins_follow_each_other_all_the_same():
    floor = ground(room(4.0, 2.0, boxes=[(1.9, 0.0, 2.1, 2.0)]))
    one, other = np.array([[0.5, 0.5], [0.5, 1.5]]), np.array([[3.0, 0.5], [3.0, 1.5]])
    assert len(between(floor, one, other)) == 0


ENDS = ((1.0, 2.5), (1.1, 2.6), (1.0, 2.4), (0.9, 2.5))


@pytest.mark.parametrize('count', [1, 2, 3, 4])
def test_each_of_four_manners_visits_all_lanes_to_and_fro_from_another_corner(count):
    cell = lanes(*ENDS[:count])
    manners = cell_manners(FLOOR, cell)
    assert len(manners) == 4
    for manner, (order, first) in zip(manners, [(cell, 0), (cell, 1), (cell[::-1], 0), (cell[::-1], 1)]):
        assert (manner[0] == order[0][first]).all()
        assert (manner[-1] == order[-1][(first + count) % 2]).all()
        steps = [np.concatenate(step).tolist() for step in zip(manner[:-1], manner[1:])]
        driven = [steps.index((lane if (index + first) % 2 == 0 else lane[::-1]).ravel().tolist())
                  for index, lane in enumerate(order)]
        assert driven == sorted(driven) and driven[0] == 0 and driven[-1] == len(steps) - 1
    corners = {tuple(manner[0]) for manner in manners}
    assert len(corners) == (4 if count > 1 else 2)
    assert min(distances(PLAN, along(manners[0]))) >= FLOOR.reach
