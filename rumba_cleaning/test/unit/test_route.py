"""Routes: how long they take, by hand, and that their parts make up the whole."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from pytest import approx

from rumba_cleaning.route import BENT, STOP, TURN_RATE, Ahead, Route

ANGLE = Route(np.array([(0.0, 0.0), (3.0, 0.0), (3.0, 1.8)]), np.array([0.3, 0.45]))
ROUTES = st.lists(st.tuples(st.integers(-50, 50), st.integers(-50, 50)), min_size=2, max_size=12, unique=True).map(
    lambda points: Route(np.array(points, float) / 10.0, np.full(len(points) - 1, 0.3)))


def test_a_corner_takes_time_beside_the_ways_to_it_and_from_it():
    times = ANGLE.times()
    corner = (0.5 * math.pi - BENT) / TURN_RATE
    assert times == approx([0.0, 10.0 + corner, 10.0 + corner + 4.0])


def test_a_hairpin_costs_a_stop_and_a_slight_bend_nothing():
    straight, slight, back = (Route(np.array([(0.0, 0.0), (1.0, 0.0), (1.0 + math.cos(turn), math.sin(turn))]),
                                    np.array([0.5, 0.5])).times()[-1] for turn in (0.0, 0.4, 3.0))
    assert (straight, slight) == (approx(4.0), approx(4.0))
    assert back == approx(4.0 + (3.0 - BENT) / TURN_RATE + STOP)


@given(ROUTES, st.floats(0.0, 1.0))
def test_beginning_and_end_make_up_the_whole_route(route, share):
    beginning, end = route.beginning(share), route.end(share)
    assert len(beginning.speeds) >= 1 and (beginning.waypoints[-1] == end.waypoints[0]).all()
    assert_allclose(np.concatenate([beginning.waypoints, end.waypoints[1:]]), route.waypoints)
    assert beginning.length + end.length == approx(route.length)
    assert np.concatenate([beginning.speeds, end.speeds]).tolist() == route.speeds.tolist()


def test_half_of_the_time_is_where_half_of_the_time_has_passed():
    route = Route(np.stack([np.arange(11.0), np.zeros(11)], axis=1), np.repeat([0.1, 0.5], 5))  # 50 s and 10 s
    assert route.beginning(0.5).length == approx(3.0) and route.beginning(0.9).length == approx(7.0)


@given(ROUTES, st.floats(0.0, 1.0))
def test_the_rest_begins_where_the_robot_is_and_is_as_long_as_it_should_be(route, share):
    rest = Ahead(route, share * route.length).rest()
    assert rest.length == approx(share * route.length, abs=1e-9)
    assert (rest.waypoints[-1] == route.waypoints[-1]).all() and len(rest.speeds) == len(rest.waypoints) - 1


@pytest.mark.parametrize('taken, left', [(1.0, 4.8), (1.8, 3.0), (4.7, 3.0), (4.8, 0.0), (9.0, 0.0)])
def test_what_is_taken_over_ends_at_a_waypoint_of_the_plan(taken, left):
    rest = Ahead(ANGLE, ANGLE.length).without_end(taken)
    assert (rest.length if rest is not None else 0.0) == approx(left)
