"""Detours around obstacles that were met on a route, and back onto it."""

import math

import numpy as np
import pytest
from floors import along, knowing, length
from pytest import approx
from rooms import distances, room

from rumba_cleaning.behaviours.detour import HORIZON, detour
from rumba_cleaning.route import Route
from rumba_sim.model.common.geometry import Pose

POST = np.array([2.0, 1.5])
START = Pose(0.5, 1.5, 0.0)


def lane(first, last, y=1.5, step=0.25, speed=0.21):
    """A route along x with a different speed on each leg."""
    waypoints = np.array([[x, y] for x in np.arange(first, last + 0.01, step)])
    return Route(waypoints, speed + 0.001 * np.arange(len(waypoints) - 1))


def obstructed(*posts, plan=None, radius=0.05):
    """The context of a robot that has met obstacles; by default in a room of 4 m x 3 m."""
    context = knowing(plan or room(4.0, 3.0), START)
    for post in posts:
        context.ground.mark(*post, radius)
    return context


def holds(route, point):
    """Whether a point is one of the waypoints of a route."""
    return bool((np.hypot(*(route.waypoints - point).T) < 1e-9).any())


def test_a_detour_leads_around_an_obstacle_and_rejoins_the_route():
    context, rest = obstructed(POST), lane(1.0, 3.5)
    around = detour(context, START, rest)
    near = context.ground.reach + 0.05
    assert tuple(around.waypoints[0]) == START[:2] and (around.waypoints[-1] == rest.waypoints[-1]).all()
    assert min(np.hypot(*(along(around.waypoints) - POST).T)) >= near
    assert len(around.speeds) == len(around.waypoints) - 1
    assert length(around.waypoints) < 3.6
    back = around.waypoints[around.waypoints[:, 0] > 2.4]
    assert (back[:, 1] == 1.5).all() and len(back) >= 4


def test_waypoints_that_an_obstacle_covers_are_left_out_and_no_others():
    context, rest = obstructed(POST), lane(1.0, 3.5)
    around = detour(context, START, rest)
    near = context.ground.reach + 0.05
    for waypoint in rest.waypoints:
        assert holds(around, waypoint) == (math.hypot(*(waypoint - POST)) >= near + 0.01), waypoint


def test_legs_that_are_kept_keep_their_speeds_and_new_legs_have_the_cleaning_speed():
    context, rest = obstructed(POST), lane(1.0, 3.5)
    around = detour(context, START, rest)
    speeds = {tuple(waypoint): speed for waypoint, speed in zip(rest.waypoints[1:], rest.speeds)}
    left_out = [waypoint for waypoint in rest.waypoints if not holds(around, waypoint)]
    rejoined = float(max(waypoint[0] for waypoint in left_out)) + 0.25
    for start, end, speed in zip(around.waypoints[:-1], around.waypoints[1:], around.speeds):
        on_route = tuple(end) in speeds and holds(rest, start) and end[0] != approx(rejoined)
        assert speed == (speeds[tuple(end)] if on_route else context.config.speed), end
    assert set(around.speeds) > {context.config.speed}


def test_if_no_obstacle_lies_on_the_route_it_is_kept_as_it_is():
    rest = lane(1.0, 3.5)
    around = detour(obstructed((2.0, 0.5)), START, rest)
    assert (around.waypoints[1:] == rest.waypoints).all() and (around.speeds[1:] == rest.speeds).all()
    assert around.speeds[0] == obstructed().config.speed


def test_several_obstacles_on_a_route_are_each_driven_around():
    posts = [np.array([1.5, 1.5]), np.array([2.7, 1.55])]
    context, rest = obstructed(*posts), lane(0.75, 3.5)
    around = detour(context, START, rest)
    for post in posts:
        assert min(np.hypot(*(along(around.waypoints) - post).T)) >= context.ground.reach + 0.05
    assert (around.waypoints[-1] == rest.waypoints[-1]).all() and length(around.waypoints) < 3.8


def test_a_detour_keeps_off_walls_as_well():
    plan = room(4.0, 3.0, boxes=[(1.0, 1.8, 3.0, 1.9)])
    context = obstructed((2.0, 1.4), plan=plan)
    around = detour(context, START, lane(1.0, 3.5))
    assert min(distances(plan, along(around.waypoints))) >= context.ground.reach
    assert around.waypoints[:, 1].min() < 1.2 and (around.waypoints[-1] == (3.5, 1.5)).all()


def test_the_end_of_a_route_under_an_obstacle_is_left_out():
    context, rest = obstructed((3.4, 1.5)), lane(1.0, 3.5)
    around = detour(context, START, rest)
    assert (around.waypoints[-1] == (3.0, 1.5)).all() and len(around.speeds) == len(around.waypoints) - 1


def test_after_a_waypoint_that_cannot_be_reached_the_detour_leads_to_the_next_one():
    plan = room(4.0, 3.0, boxes=[(2.8, 0.0, 2.9, 3.0), (1.4, 0.9, 1.8, 1.1)])
    context = obstructed((2.2, 1.5), plan=plan)
    rest = Route(np.array([[1.0, 1.5], [3.4, 1.5], [2.3, 0.4]]), np.array([0.2, 0.2]))  # the second: behind the wall
    around = detour(context, START, rest)
    assert (around.waypoints[-1] == (2.3, 0.4)).all() and not holds(around, (3.4, 1.5))
    assert min(distances(plan, along(around.waypoints))) >= context.ground.reach


@pytest.mark.parametrize('rest', [lane(3.2, 3.8), lane(1.9, 2.1, step=0.1)])
def test_if_nothing_can_be_reached_there_is_no_detour(rest):
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
    assert (around.waypoints[-8:] == rest.waypoints[-8:]).all() and (around.speeds[-8:] == rest.speeds[-8:]).all()
    assert len(around.speeds) == len(around.waypoints) - 1
