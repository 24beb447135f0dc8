"""Which edits of a route are made, and what becomes of the route."""

import numpy as np
import pytest
from floors import length
from hypothesis import given
from hypothesis import strategies as st
from pytest import approx

from rumba_cleaning.planning.search.edits import APART, BETTER, BETWEEN, applied, chosen, dense
from rumba_cleaning.planning.simulate.rehearsal import Edit
from rumba_cleaning.route import Route

DEAREST = 1000.0
NONE = np.zeros((0, 2))
LINE = Route(np.stack([np.arange(0.0, 60.0), np.zeros(60)], axis=1), np.full(59, 0.3))
EDITS = st.lists(st.tuples(st.integers(0, 50), st.integers(1, 8), st.floats(-5.0, 5.0), st.floats(-0.05, 0.05)),
                 max_size=12)


def edit(first, seconds, area, last=None):
    return Edit(first, first + 1 if last is None else last, NONE, seconds, area)


def test_of_what_sweeps_more_that_which_costs_least_is_chosen_until_it_is_enough():
    edits = [edit(0, 1.0, 0.01), edit(10, 3.0, 0.01), edit(20, 2.0, 0.01), edit(30, 9.0, 0.01)]
    for need, firsts in ((0.005, {0}), (0.015, {0, 20}), (0.03, {0, 10, 20}), (0.035, {0, 10, 20, 30})):
        found, price = chosen(edits, need, DEAREST)
        assert {each.first for each in found} == firsts
        assert max(each.seconds / each.area for each in found) <= price


def test_of_what_saves_time_that_which_loses_least_is_chosen_as_long_as_enough_is_swept():
    edits = [edit(0, -5.0, -0.01), edit(10, -1.0, -0.01), edit(20, -3.0, -0.01)]
    for need, firsts in ((0.0, set()), (-0.01, {0}), (-0.025, {0, 20}), (-1.0, {0, 10, 20})):
        assert {each.first for each in chosen(edits, need, DEAREST)[0]} == firsts


def test_something_dear_is_dropped_to_pay_for_something_cheap():
    found, price = chosen([edit(0, -5.0, -0.01), edit(10, 1.0, 0.01)], 0.0, DEAREST)
    assert {each.first for each in found} == {0, 10} and 100.0 < price < 500.0


def test_what_saves_time_and_sweeps_more_is_always_chosen_and_what_is_too_dear_never():
    found, _ = chosen([edit(0, -1.0, 0.01), edit(10, DEAREST * 0.02, 0.01)], 1.0, DEAREST)
    assert [each.first for each in found] == [0]
    assert chosen([edit(0, -0.5 * BETTER, 0.0)], 0.0, DEAREST)[0] == []


def test_an_edit_has_the_same_place_in_routes_that_are_equal_there_and_another_one_if_anything_differs():
    path = np.array([[7.5, 1.0]])
    place = Edit(5, 8, path).place(LINE)
    longer = Route(np.concatenate([[[-1.0, 5.0]], LINE.waypoints]), np.append(LINE.speeds, 0.3))
    assert Edit(6, 9, path, 1.0, 2.0).place(longer) == place
    for other, route in ((Edit(5, 8, NONE), LINE), (Edit(5, 9, path), LINE), (Edit(4, 8, path), LINE),
                         (Edit(5, 8, path + 0.001), LINE), (Edit(5, 8, path), longer)):
        assert other.place(route) != place


@pytest.mark.parametrize('seconds, area, is_near', [
    (1.15, 0.01, True), (1.25, 0.01, False),  # at 1.2 times the price it would be worth it
    (-0.8, -0.01, False), (-0.87, -0.01, True),  # at that price divided by 1.2
    (-1.0, 0.01, True), (1.0, -0.01, False)])
def test_an_edit_is_near_a_price_if_a_fifth_more_or_less_would_do(seconds, area, is_near):
    assert edit(0, seconds, area).is_near(100.0) is is_near


@given(EDITS, st.floats(-0.2, 0.2))
def test_chosen_edits_are_apart_and_sweep_enough_if_that_can_be(rows, need):
    edits = [edit(first, seconds, area, first + span) for first, span, seconds, area in rows]
    found, price = chosen(edits, need, DEAREST)
    for one in found:
        assert price * one.area - one.seconds >= BETTER
        assert all(other is one or other.first >= one.last + BETWEEN or other.last <= one.first - BETWEEN
                   for other in found)
    more = sum(each.area for each in chosen(edits, np.inf, DEAREST)[0])
    assert sum(each.area for each in found) >= min(need, more) - 1e-12


@given(EDITS, st.floats(1.0, DEAREST))
def test_the_best_edits_come_first_and_each_that_has_room_beside_those_is_made(rows, price):
    edits = [edit(first, seconds, area, first + span) for first, span, seconds, area in rows]
    left = [each for each in edits if price * each.area - each.seconds >= BETTER]
    found = chosen(edits, np.inf, price)[0]
    for one in found:
        worth = price * one.area - one.seconds
        assert worth == max(price * each.area - each.seconds for each in left)
        left = [each for each in left if each.last + BETWEEN <= one.first or each.first - BETWEEN >= one.last]
    assert not left


def test_an_edit_replaces_what_is_between_its_waypoints():
    aside = np.array([[2.0, 1.0], [4.0, 1.0]])
    route = applied(LINE, [Edit(10, 13, NONE), Edit(1, 5, aside)], 0.2)
    assert route.waypoints.tolist() == [[0.0, 0.0], [1.0, 0.0], *aside.tolist(), *LINE.waypoints[5:11].tolist(),
                                        *LINE.waypoints[13:].tolist()]
    assert route.speeds.tolist() == [0.3, 0.2, 0.2, 0.2, *5 * [0.3], 0.2, *46 * [0.3]]
    assert applied(LINE, [], 0.2).waypoints.tolist() == LINE.waypoints.tolist()


def test_a_dense_route_is_the_same_with_more_waypoints():
    route = dense(Route(np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 0.05]]), np.array([0.3, 0.45])))
    assert length(route.waypoints) == approx(1.05)
    assert np.hypot(*np.diff(route.waypoints, axis=0).T).max() <= APART + 1e-9
    assert route.speeds[:-1] == pytest.approx(0.3) and route.speeds[-1] == 0.45
