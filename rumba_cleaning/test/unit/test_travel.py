"""Along a route, a robot drives on beside edges that the map shows, and backs off from others."""

import math

import numpy as np
import pytest
from drivers import context_of, guarded, with_cliffs
from rooms import quiet, room

from rumba_cleaning.behaviour import SIDE, Command, Observation
from rumba_cleaning.behaviours import recoil
from rumba_cleaning.behaviours.travel import Going, Travel
from rumba_cleaning.control import CONTROL_DT, observe
from rumba_cleaning.edges.guard import Guard
from rumba_cleaning.route import Route
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.simulation.world import World

ROOM, EDGE = room(4.0, 2.0, 0.02, start=Pose(0.5, 0.5, 0.0)), (0.0, 1.4, 4.0, 2.0)
START, TURN = Pose(1.0, 1.0, 0.5 * math.pi), (1.0, 1.25)  # there, sensors are over the edge
TO_EDGE = Route(np.array([START[:2], TURN, START[:2], (2.0, 0.9)]), np.full(3, 0.3))


def before_edge(is_shown):
    """A robot that is to drive to an edge, its world, and what it knows."""
    truth = with_cliffs(ROOM, EDGE)
    world = World(truth, quiet())
    robot = world.spawn('rumba', START)
    return robot, world, context_of(truth if is_shown else ROOM, world)


@pytest.mark.parametrize('is_shown, ends', [(True, Going.ARRIVED), (False, Going.BLOCKED)])
def test_only_an_edge_that_the_map_does_not_show_ends_a_travel(is_shown, ends):
    robot, world, context = before_edge(is_shown)
    guard, travel, most = Guard(context), Travel(context, TO_EDGE), 0.0

    def decide(observation):
        nonlocal most
        most = max(most, robot.pose.y if any(observation.cliffs) else 0.0)
        return travel.command(observation, True)
    for _ in guarded(guard, world, decide, seconds=30.0):
        if travel.going is not Going.ON:
            break
    assert most > 1.22 and travel.going is ends and not robot.has_fallen
    assert (robot.pose.x > 1.9) == is_shown


@pytest.mark.parametrize('is_held, is_other_seen', [(False, False), (True, False), (False, True)])
def test_at_an_edge_it_backs_off_if_that_holds_it_or_the_map_does_not_show_all(is_held, is_other_seen):
    _, world, context = before_edge(True)
    if is_other_seen:
        context.cliff_map._see(1.0, 0.5)
    observation = observe(world, 'rumba', CONTROL_DT)._replace(cliffs=(False, True, True, False), is_held=is_held)
    assert (Travel(context, TO_EDGE).command(observation, True).v < 0.0) == (is_held or is_other_seen)


@pytest.mark.parametrize('bumper, side', [((True, False), 1.0), ((False, True), -1.0)])
def test_what_presses_a_switch_is_remembered_on_the_side_of_that_switch(bumper, side):
    _, world, context = before_edge(False)
    pose = Pose(2.0, 1.0, 0.0)
    observation, travel = observe(world, 'rumba', CONTROL_DT)._replace(pose=pose), Travel(context, TO_EDGE)
    travel.command(observation, True)
    assert travel.command(observation._replace(bumper=bumper), True).v < 0.0
    ground = context.ground
    there, opposite = (float(ground.clearance[ground.node(pose.x + 0.13, pose.y + y)])
                       for y in (0.12 * side, -0.12 * side))
    assert there < opposite - 0.05


# --- what presses the bumper, and what holds the robot ----------------------------------------------------------------

ACROSS = Pose(1.2, 0.6, 0.5)
ALONG = Route(np.array([ACROSS[:2], (1.2 + 1.5 * math.cos(0.5), 0.6 + 1.5 * math.sin(0.5))]), np.full(1, 0.3))


def under_way():
    """What a robot knows at the start of a route through an empty room, what it senses there, and its travel."""
    context = context_of(ROOM, World(ROOM, quiet()))
    return context, Observation(CONTROL_DT, ACROSS), Travel(context, ALONG)


def commands(travel, observation, seconds):
    """What it does for some seconds in which nothing changes, at most until the route has to be left."""
    answers = []
    for _ in range(round(seconds / CONTROL_DT)):
        answers.append(travel.command(observation, False))
        if travel.going is not Going.ON:
            break
    return answers


def test_it_backs_off_straight_for_as_long_as_the_contact_asks_and_then_leaves_the_route():
    _, observation, travel = under_way()
    travel.command(observation, False)
    touching = observation._replace(bumper=(True, True))
    backward = commands(travel, touching, 5.0)
    assert set(backward) == {Command(-recoil.SPEED, 0.0, False)} and travel.going is Going.BLOCKED
    assert len(backward) * CONTROL_DT == pytest.approx(recoil.time_back(touching), abs=2.1 * CONTROL_DT)


@pytest.mark.parametrize('bumper', [(True, False), (False, True), (True, True)])
def test_a_contact_from_before_the_route_is_none_until_it_ends_and_comes_again(bumper):
    _, observation, travel = under_way()
    touching = observation._replace(bumper=bumper)
    assert all(command.v >= 0.0 for command in commands(travel, touching, 1.0)) and travel.going is Going.ON
    assert travel.command(observation, False).v >= 0.0
    assert travel.command(touching, False).v < 0.0


@pytest.mark.parametrize('angle, bumper', [(0.0, (True, True)), (SIDE, (True, False)), (-SIDE, (False, True))])
def test_what_it_touches_is_marked_at_the_rim_of_the_body_whatever_its_heading(angle, bumper):
    context, observation, travel = under_way()
    travel.command(observation, False)
    travel.command(observation._replace(bumper=bumper), False)
    ground, away = context.ground, context.robot.drive.radius + 0.05
    clearances = {turn: float(ground.clearance[ground.node(ACROSS.x + away * math.cos(ACROSS.theta + turn),
                                                           ACROSS.y + away * math.sin(ACROSS.theta + turn))])
                  for turn in (0.0, SIDE, -SIDE, math.pi)}
    assert min(clearances, key=clearances.get) == angle and clearances[angle] < 0.05


def test_a_robot_without_progress_takes_something_to_be_ahead_of_it_after_four_seconds():
    _, observation, travel = under_way()
    assert all(command.v >= 0.0 for command in commands(travel, observation, 3.9))
    later = commands(travel, observation, 0.4)
    assert later[-1].v < 0.0
    assert commands(travel, observation, 2.0) and travel.going is Going.BLOCKED


def test_slow_progress_is_progress_and_a_long_observation_is_no_waiting():
    _, observation, travel = under_way()
    for step in range(40):  # 2 cm in each second
        away = 0.02 * step
        pose = Pose(ACROSS.x + away * math.cos(0.5), ACROSS.y + away * math.sin(0.5), 0.5)
        assert all(command.v >= 0.0 for command in commands(travel, observation._replace(pose=pose), 1.0))
    _, observation, travel = under_way()
    for _ in range(4):
        assert travel.command(observation._replace(dt=60.0), False).v >= 0.0


@pytest.mark.parametrize('bumper, is_forgotten', [((False, False), True), ((True, False), False)])
def test_where_it_stands_and_touches_nothing_nothing_can_be(bumper, is_forgotten):
    context, observation, travel = under_way()
    context.ground.mark(ACROSS.x + 0.22, ACROSS.y, 0.1)
    here = context.ground.node(ACROSS.x + 0.13, ACROSS.y)
    assert context.ground.clearance[here] < 0.02
    travel.command(observation._replace(bumper=bumper), False)
    assert (context.ground.clearance[here] > 0.03) == is_forgotten
