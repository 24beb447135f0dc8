"""Back onto a route, around what was met on it."""

import math

import numpy as np
import pytest
from floors import along, knowing, length
from pytest import approx
from rooms import distances, room

from rumba_cleaning.behaviours.detour import HORIZON, detour
from rumba_cleaning.behaviours.follower import Route
from rumba_sim.model.geometry import Pose

POST = np.array([2.0, 1.5])
START = Pose(0.5, 1.5, 0.0)


def lane(first, last, y=1.5, step=0.25, speed=0.21):
    """A route along x whose parts have speeds of their own."""
    places = np.array([[x, y] for x in np.arange(first, last + 0.01, step)])
    return Route(places, speed + 0.001 * np.arange(len(places) - 1))


def obstructed(*posts, plan=None, radius=0.05):
    """What a robot knows that met obstacles in a room of 4 m x 3 m."""
    context = knowing(plan or room(4.0, 3.0), START)
    for post in posts:
        context.ground.mark(*post, radius)
    return context


def holds(route, place):
    """Whether a route leads to a place."""
    return bool((np.hypot(*(route.places - place).T) < 1e-9).any())


def test_a_detour_leads_around_an_obstacle_and_rejoins_the_route():
    context, rest = obstructed(POST), lane(1.0, 3.5)
    around = detour(context, START, rest)
    near = context.ground.reach + 0.05
    assert tuple(around.places[0]) == START[:2] and (around.places[-1] == rest.places[-1]).all()
    assert min(np.hypot(*(along(around.places) - POST).T)) >= near
    assert len(around.speeds) == len(around.places) - 1
    assert length(around.places) < 3.6
    back = around.places[around.places[:, 0] > 2.4]
    assert (back[:, 1] == 1.5).all() and len(back) >= 4


def test_places_that_an_obstacle_covers_are_left_out_and_no_others():
    context, rest = obstructed(POST), lane(1.0, 3.5)
    around = detour(context, START, rest)
    near = context.ground.reach + 0.05
    for place in rest.places:
        assert holds(around, place) == (math.hypot(*(place - POST)) >= near + 0.01), place


def test_parts_that_are_kept_keep_their_speeds_and_new_ones_have_that_of_cleaning():
    context, rest = obstructed(POST), lane(1.0, 3.5)
    around = detour(context, START, rest)
    speeds = {tuple(place): speed for place, speed in zip(rest.places[1:], rest.speeds)}
    left_out = [place for place in rest.places if not holds(around, place)]
    rejoined = float(max(place[0] for place in left_out)) + 0.25
    for start, end, speed in zip(around.places[:-1], around.places[1:], around.speeds):
        on_route = tuple(end) in speeds and holds(rest, start) and end[0] != approx(rejoined)
        assert speed == (speeds[tuple(end)] if on_route else context.config.speed), end
    assert set(around.speeds) > {context.config.speed}


def test_where_nothing_is_in_the_way_the_rest_is_kept_as_it_is():
    rest = lane(1.0, 3.5)
    around = detour(obstructed((2.0, 0.5)), START, rest)
    assert (around.places[1:] == rest.places).all() and (around.speeds[1:] == rest.speeds).all()
    assert around.speeds[0] == obstructed().config.speed


def test_several_obstacles_on_a_route_are_each_driven_around():
    posts = [np.array([1.5, 1.5]), np.array([2.7, 1.55])]
    context, rest = obstructed(*posts), lane(0.75, 3.5)
    around = detour(context, START, rest)
    for post in posts:
        assert min(np.hypot(*(along(around.places) - post).T)) >= context.ground.reach + 0.05
    assert (around.places[-1] == rest.places[-1]).all() and length(around.places) < 3.8


def test_a_detour_keeps_off_walls_as_well():
    plan = room(4.0, 3.0, boxes=[(1.0, 1.8, 3.0, 1.9)])
    context = obstructed((2.0, 1.4), plan=plan)
    around = detour(context, START, lane(1.0, 3.5))
    assert min(distances(plan, along(around.places))) >= context.ground.reach
    assert around.places[:, 1].min() < 1.2 and (around.places[-1] == (3.5, 1.5)).all()


def test_the_end_of_a_route_under_an_obstacle_is_left_out():
    context, rest = obstructed((3.4, 1.5)), lane(1.0, 3.5)
    around = detour(context, START, rest)
    assert (around.places[-1] == (3.0, 1.5)).all() and len(around.speeds) == len(around.places) - 1


def test_after_a_place_that_no_way_leads_to_the_next_is_gone_to_around_what_is_between():
    plan = room(4.0, 3.0, boxes=[(2.8, 0.0, 2.9, 3.0), (1.4, 0.9, 1.8, 1.1)])
    context = obstructed((2.2, 1.5), plan=plan)
    rest = Route(np.array([[1.0, 1.5], [3.4, 1.5], [2.3, 0.4]]), np.array([0.2, 0.2]))  # the second: behind the wall
    around = detour(context, START, rest)
    assert (around.places[-1] == (2.3, 0.4)).all() and not holds(around, (3.4, 1.5))
    assert min(distances(plan, along(around.places))) >= context.ground.reach


@pytest.mark.parametrize('rest', [lane(3.2, 3.8), lane(1.9, 2.1, step=0.1)])
def test_where_nothing_can_be_reached_there_is_no_detour(rest):
    context = obstructed(POST, plan=room(4.0, 3.0, boxes=[(2.8, 0.0, 2.9, 3.0)]), radius=0.2)
    assert detour(context, START, rest) is None


def test_obstacles_beyond_the_horizon_are_left_for_later():
    plan = room(12.0, 3.0, 0.1)
    far, near = (3.0 + HORIZON, 1.5), (3.0, 1.5)
    context = knowing(plan, START)
    rest = lane(1.0, 11.0)
    for post in (far, near):
        context.ground.mark(*post, 0.05)
    around = detour(context, START, rest)
    assert not holds(around, near) and holds(around, far)
    assert (around.places[-8:] == rest.places[-8:]).all() and (around.speeds[-8:] == rest.speeds[-8:]).all()
    assert len(around.speeds) == len(around.places) - 1
