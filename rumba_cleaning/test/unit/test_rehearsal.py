"""A rehearsal is what a drive in the world would be, and edits are judged as rehearsals with them would show."""

import numpy as np
import pytest
from floors import knowing
from hypothesis import given, settings
from hypothesis import strategies as st
from pytest import approx
from rooms import alone, crooked, room

from rumba_cleaning.behaviours.follower import Follower
from rumba_cleaning.planning.planner import plan
from rumba_cleaning.planning.search.edits import applied, dense
from rumba_cleaning.planning.simulate import rehearsal as rehearsals
from rumba_cleaning.planning.simulate.rehearsal import Edit
from rumba_cleaning.planning.simulate.rehearsal import NO_PATH, Rehearsal
from rumba_cleaning.route import Route
from rumba_sim.model.common.geometry import Pose

DT, TICKS = 0.1, 5
START = Pose(0.5, 0.5, 0.3)
FLOOR = room(4.0, 3.0, 0.02)
LANES = Route(np.array([[0.5, 0.5], [3.5, 0.5], [3.5, 0.66], [0.5, 0.66], [0.5, 0.82], [3.5, 0.82], [2.0, 2.0],
                        [2.0, 2.6], [3.0, 2.6]]), np.array([0.3, 0.3, 0.3, 0.3, 0.3, 0.3, 0.45, 0.45]))


def driven(context, pose, route):
    """The time [s] that a robot in a world takes to follow a route, and the memory of what it swept."""
    world, robot = alone(pose, context.plan)
    swept, follower = context.swept.copy(), Follower(route, context.robot.drive)
    swept.follow(robot.pose, True)
    while True:
        is_up = follower.speed > context.config.speed
        command = follower.velocity(robot.pose, DT)
        if follower.is_done:
            return world.time, swept
        for _ in range(TICKS):
            robot.command(*command, world.tick)
            world.step()
        swept.follow(robot.pose, is_up)


@pytest.mark.parametrize('floor', [FLOOR, crooked(0.02), crooked(0.05)])
def test_a_rehearsal_takes_as_long_and_sweeps_as_much_as_a_drive(floor, monkeypatch):
    monkeypatch.setattr(rehearsals, 'SWIFT_SPEED', 1.0)  # nobody guards the robot that drives here
    context = knowing(floor, START)
    route = LANES if floor is FLOOR else plan(context, START)
    rehearsal = Rehearsal(context, START, route)
    seconds, swept = driven(context, START, route)
    assert rehearsal.is_complete and rehearsal.seconds == approx(seconds, rel=0.01, abs=0.2)
    assert rehearsal.swept.coverage == approx(swept.coverage, abs=0.001)
    differs = rehearsal.swept.missing_share() - swept.missing_share()
    assert np.abs(differs).sum() * floor.resolution ** 2 < 0.006 * swept.reachable_area
    assert context.swept.coverage == 0.0


def test_a_rehearsal_knows_when_each_waypoint_is_reached_and_what_is_swept_but_once_until_then():
    context = knowing(FLOOR, START)
    there_and_back = Route(np.array([[0.5, 0.5], [2.5, 0.5], [0.5, 0.5], [0.5, 2.5]]), np.full(3, 0.3))
    rehearsal = Rehearsal(context, START, there_and_back)
    reached = rehearsal.reached
    assert reached[0] == 0.0
    assert np.diff(reached) == approx(2.0 / 0.3 + np.array([0.7, 2.0, 1.0]), abs=0.8)
    assert rehearsal.seconds == approx(reached[-1], abs=0.2)
    once = np.diff(rehearsal.alone)
    assert max(once[:2]) < 0.03 and once[2] == approx(2.0 * 0.17, abs=0.03)


def test_bends_take_longer_in_a_rehearsal_since_the_guard_slows_down_the_outer_wheel(monkeypatch):
    context = knowing(FLOOR, START)
    angles = np.linspace(-0.5 * np.pi, 1.5 * np.pi, 60)
    bend = Route(np.array([2.0, 1.5]) + 0.25 * np.stack([np.cos(angles), np.sin(angles)], axis=1), np.full(59, 0.3))
    at_bend = Pose(2.0, 1.25, 0.0)
    guarded = Rehearsal(context, at_bend, bend)
    monkeypatch.setattr(rehearsals, 'SWIFT_SPEED', 1.0)
    assert 0.1 < guarded.seconds - Rehearsal(context, at_bend, bend).seconds < 2.0


def test_with_the_brushes_up_nothing_is_swept():
    context = knowing(FLOOR, START)
    fast = Route(np.array([[0.5, 0.5], [3.5, 0.5]]), np.array([0.45]))
    assert Rehearsal(context, START, fast).swept.coverage == 0.0


def test_a_robot_slides_along_a_wall_in_a_rehearsal():
    context = knowing(FLOOR, START)
    into = Route(np.array([[0.5, 0.5], [2.0, 0.15], [3.5, 0.5]]), np.full(2, 0.3))
    rehearsal = Rehearsal(context, START, into)
    assert rehearsal.is_complete and rehearsal._trace[:, 1].min() == approx(context.ground.reach, abs=1e-3)


def test_a_route_that_nobody_can_follow_is_not_complete():
    context = knowing(room(4.0, 3.0, 0.02, [(1.9, 0.0, 2.1, 3.0)]), START)
    through = Route(np.array([[0.5, 0.5], [3.5, 0.5]]), np.array([0.3]))
    assert not Rehearsal(context, START, through).is_complete


def test_a_rehearsal_knows_how_far_the_robot_turns_to_and_fro():
    ahead = Pose(0.5, 0.5, 0.0)
    context = knowing(FLOOR, ahead)
    there_and_back = Route(np.array([[0.5, 0.5], [2.5, 0.5], [0.5, 0.5], [0.5, 2.5]]), np.full(3, 0.3))
    straight = Route(np.array([[0.5, 0.5], [2.5, 0.5]]), np.array([0.3]))
    assert Rehearsal(context, ahead, straight).turned == approx(0.0, abs=0.01)
    rehearsal = Rehearsal(context, ahead, there_and_back)
    headings = np.unwrap(rehearsal._trace[:, 2])
    assert rehearsal.turned == approx(np.abs(np.diff(headings)).sum(), rel=0.03)
    assert rehearsal.turned > np.pi


@settings(deadline=None, max_examples=40)
@given(st.integers(1, 95), st.integers(1, 25),
       st.lists(st.tuples(st.floats(-0.2, 0.2), st.floats(-0.2, 0.2)), max_size=2))
def test_an_edit_is_judged_as_a_rehearsal_with_it_shows(first, span, path):
    context, route = knowing(FLOOR, START), dense(LANES)
    rehearsal = Rehearsal(context, START, route)
    last = min(first + span, len(route.waypoints) - 2)
    middle = 0.5 * (route.waypoints[first] + route.waypoints[last])
    edit = Edit(first, last, middle + np.array(path).reshape(-1, 2))
    judged = rehearsal.judged([edit])
    again = Rehearsal(context, START, applied(route, [edit], 0.3))
    assert len(judged) == again.is_complete
    for each in judged:
        more = (again.swept.coverage - rehearsal.swept.coverage) * again.swept.reachable_area
        assert each.area == approx(more, abs=0.015)
        assert each.seconds == approx(again.seconds - rehearsal.seconds, abs=0.5)


def test_many_edits_are_judged_each_as_if_it_were_the_only_one():
    context = knowing(FLOOR, START)
    rehearsal = Rehearsal(context, START, dense(LANES))
    edits = [Edit(first, first + 5, NO_PATH) for first in range(1, 90, 7)]
    alone_each = [rehearsal.judged([edit])[0] for edit in edits]
    together = rehearsal.judged(edits)
    assert [each[3:] for each in together] == [each[3:] for each in alone_each]
    assert rehearsal.judged([]) == []
