"""boustrophedon goes on after doors that are closed, people who drive it elsewhere, and robots in its way."""

import math
import re

import numpy as np
import pytest
from drivers import context_of, drive_by_hand, run, slanted_gap, with_box
from rooms import RADIUS, quiet, room

from rumba_cleaning.behaviour import Status
from rumba_cleaning.control import steps
from rumba_cleaning.mission.mission import Mission
from rumba_cleaning.mission.stages import State
from rumba_cleaning.outcome import Outcome
from rumba_cleaning.pose_source import seeing, truth
from rumba_cleaning.route import Route
from rumba_cleaning.strategies import boustrophedon
from rumba_cleaning.strategies.boustrophedon import Boustrophedon
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.simulation.obstacle import Obstacle
from rumba_sim.model.simulation.world import World


@pytest.mark.thorough
def test_a_closed_door_does_not_keep_it_busy_for_ever():
    plan = room(7.0, 5.0, boxes=[(3.4, 0.0, 3.6, 2.0), (3.4, 2.9, 3.6, 5.0)], start=Pose(1.0, 1.0, 0.0))
    world = World(with_box(plan, (3.4, 1.9, 3.6, 3.0)), quiet())
    world.spawn('rumba')
    mission = Mission(context_of(plan, world), 'boustrophedon', 0.99)
    assert max(observation.state_of_charge for observation, _ in steps(mission, world, seconds=3000.0)) == 1.0
    assert (mission.status, mission.outcome) == (Status.FAILED, Outcome.INCOMPLETE)
    assert re.fullmatch('.* of what lies beside obstacles, the target is 99.0 %: nothing more can be reached',
                        mission.message)
    assert world.floor.coverage >= 0.98


@pytest.mark.parametrize('vain, is_enough', [(boustrophedon.PATIENT - 1, True), (boustrophedon.PATIENT, False)])
def test_while_much_is_left_it_plans_again_after_some_rounds_that_gained_nothing(vain, is_enough, monkeypatch):
    """As if something unknown ended these rounds where they began."""
    plan = room(2.0, 1.5, start=Pose(0.5, 0.5, 0.0))
    world = World(plan, quiet())
    world.spawn('rumba')
    planned, rounds, nowhere = boustrophedon.plan, [], Route(np.full((2, 2), 0.5), np.array([0.3]))

    def vainly(context, pose, end=None):
        rounds.append(pose)
        return nowhere if len(rounds) <= vain else planned(context, pose, end)
    monkeypatch.setattr(boustrophedon, 'plan', vainly)
    mission = Mission(context_of(plan, world), 'boustrophedon', 0.98)
    run(mission, world)
    assert (mission.outcome is Outcome.SUCCEEDED) == is_enough
    assert (len(rounds) == vain) != is_enough
    assert is_enough or mission.message.endswith('the target is 98.0 %: another round would gain too little')


def test_rounds_that_each_gain_little_of_what_is_missing_but_enough_go_on(monkeypatch):
    """As if something unknown ended each of them early."""
    plan = room(2.0, 1.5, start=Pose(0.5, 0.5, 0.0))
    world = World(plan, quiet())
    world.spawn('rumba')
    planned, rounds = boustrophedon.plan, []

    def beginning(context, pose, end=None):
        rounds.append(pose)
        route = planned(context, pose, end)
        count = 5 if len(rounds) <= 2 * boustrophedon.PATIENT else len(route.waypoints)
        return Route(route.waypoints[:count], route.speeds[:count - 1])
    monkeypatch.setattr(boustrophedon, 'plan', beginning)
    mission = Mission(context_of(plan, world), 'boustrophedon', 0.97)
    run(mission, world)
    assert mission.outcome is Outcome.SUCCEEDED and len(rounds) > boustrophedon.PATIENT + 2


@pytest.mark.parametrize('v, seconds', [(0.2, 1.0), (0.3, 6.0)])
def test_driven_elsewhere_by_a_person_it_returns_to_its_route_and_goes_on_where_it_left_off(v, seconds):
    plan = room(5.0, 4.0, start=Pose(0.5, 0.5, 0.0))
    world = World(plan, quiet())
    robot = world.spawn('rumba')
    context = context_of(plan, world)
    context.swept.begin(0.5, 0.5)
    behaviour = Boustrophedon(context)
    run(behaviour, world, seconds=97.0)
    before, pose = left(behaviour), robot.pose
    drive_by_hand(behaviour, world, v, 0.9, seconds)
    off = math.hypot(robot.pose.x - pose.x, robot.pose.y - pose.y)
    run(behaviour, world, seconds=0.3)
    assert before - 0.5 - 1.0 <= left(behaviour) <= before + 2.0 * off + 1.0
    for _ in steps(behaviour, world):
        context.swept.follow(robot.pose, robot.brushes_up)
    assert behaviour.message == 'nothing more can be reached'
    assert world.floor.coverage > 0.98


def left(behaviour):
    """What is left of the plan [m]."""
    return float(re.match(r'(\d+) m of the plan to go', behaviour.message).group(1))


def test_it_waits_for_what_stands_in_a_doorway_to_go():
    plan = room(5.0, 3.0, boxes=[(2.4, 0.0, 2.6, 1.0), (2.4, 1.9, 2.6, 3.0)], start=Pose(1.0, 1.0, 0.0))
    world = World(plan, quiet(), obstacles=[Obstacle('person', Pose(2.5, 1.45, 0.0), 1.7, 0.2)])
    robot = world.spawn('rumba')
    context = context_of(plan, world)
    context.swept.begin(1.0, 1.0)
    waited, before, is_open = 0.0, robot.pose, False
    for observation, _ in steps(Boustrophedon(context), world, seconds=1500.0):
        context.swept.follow(robot.pose, robot.brushes_up)
        waited = waited + observation.dt if robot.pose == before else 0.0
        before = robot.pose
        if waited > 5.0 and not is_open:
            assert context.swept.coverage < 0.6
            world.remove_obstacle('person')
            is_open = True
    assert is_open and context.swept.coverage > 0.98


@pytest.mark.thorough
def test_somebody_who_stands_in_the_only_door_now_and_then_does_not_end_it_early():
    """For minutes, but never for so long that it would have to be furniture."""
    plan = room(5.0, 3.0, boxes=[(2.4, 0.0, 2.6, 1.0), (2.4, 1.9, 2.6, 3.0)], start=Pose(1.0, 1.0, 0.0))
    world = World(plan, quiet())
    robot = world.spawn('rumba')
    context = context_of(plan, world, laser=True)
    context.swept.begin(1.0, 1.0)
    time, times = 0.0, 0  # [s] since the person came, and how often
    for observation, _ in steps(Boustrophedon(context), world, seconds=2500.0, source=seeing(truth)):
        context.swept.follow(robot.pose, robot.brushes_up)
        time += observation.dt if time > 0.0 or context.swept.coverage > 0.02 else 0.0
        stands = 0.0 < time < 500.0 and time % 50.0 < 47.0
        if stands and not world.obstacles.items and robot.pose.x < 2.1:
            world.add_obstacle(Obstacle('person', Pose(2.5, 1.45, 0.0), 1.7, 0.2))
            times += 1
        elif not stands and world.obstacles.items:
            world.remove_obstacle('person')
    assert times >= 3 and context.swept.coverage > 0.98


@pytest.mark.thorough
def test_it_squeezes_through_a_gap_that_leads_to_more_of_the_floor():
    plan = room(4.0, 2.4, 0.02, start=Pose(0.5, 1.0, 0.0))
    world = World(plan, quiet(), obstacles=slanted_gap(2.0 * RADIUS + 0.02, 0.4))
    world.spawn('rumba')
    mission = Mission(context_of(plan, world, laser=True), 'boustrophedon', 0.98)
    run(mission, world, seconds=3000.0, source=seeing(truth))
    assert world.floor.coverage >= 0.97


def test_once_the_rest_is_swept_it_does_not_try_again_what_obstacles_cut_off_a_corner(monkeypatch):
    plan = room(4.0, 3.0, dock=Pose(4.0 - RADIUS - 0.01, 0.6, 0.0))
    world = World(plan, quiet(), obstacles=[
        Obstacle('shelf', Pose(0.6, 1.8, 0.0), 0.3, length=1.2, width=0.1),
        Obstacle('bench', Pose(1.2, 2.4, 0.0), 0.3, length=0.1, width=1.2)])
    world.spawn('rumba', brushes_up=True)
    world.step()
    mission = Mission(context_of(plan, world, laser=True), 'boustrophedon', 0.98)
    tries, retry = [], boustrophedon._retry

    def counting(context, is_cut_off):
        tries.append(context.beside_obstacles().coverage)
        return retry(context, is_cut_off)
    monkeypatch.setattr(boustrophedon, '_retry', counting)
    run(mission, world, seconds=3000.0, source=seeing(truth))
    assert mission.outcome is Outcome.SUCCEEDED and world.floor.coverage >= 0.97
    assert all(swept < 0.98 for swept in tries)


@pytest.mark.thorough
def test_a_robot_that_gave_up_where_it_was_shut_in_begins_again_at_its_dock():
    plan = room(5.0, 3.0, boxes=[(2.4, 0.0, 2.6, 1.0), (2.4, 1.9, 2.6, 3.0)], dock=Pose(4.9 - RADIUS, 1.45, 0.0))
    world = World(plan, quiet())
    robot = world.spawn('rumba', Pose(0.5, 0.5, 0.0))
    world.add_obstacle(Obstacle('person', Pose(2.5, 1.45, 0.0), 1.7, 0.2))
    mission = Mission(context_of(plan, world), 'boustrophedon', 0.98)
    states = [mission.state]
    for _ in steps(mission, world, seconds=3000.0):
        if mission.state != states[-1]:
            states.append(mission.state)
        if mission.state is State.RETURNING and world.obstacles.items:
            assert robot.pose.x < 2.4 and world.floor.coverage < 0.55
            world.remove_obstacle('person')
    once = [State.CLEANING, State.RETURNING, State.DOCKING]
    assert states == [State.IDLE, *once, State.UNDOCKING, *once, State.IDLE]
    assert mission.outcome is Outcome.SUCCEEDED


def test_a_robot_that_parks_in_the_way_is_cleaned_around_and_under_once_it_is_gone():
    plan = room(4.0, 3.0, start=Pose(0.5, 0.5, 0.0))
    world = World(plan, quiet())
    world.spawn('rumba')
    world.spawn('rumba2', Pose(2.0, 1.5, 0.0), brushes_up=True)
    mission = Mission(context_of(plan, world), 'boustrophedon', 0.99)
    for _ in steps(mission, world, seconds=2000.0):
        if 'rumba2' in world.robots and world.floor.coverage > 0.9:
            world.kill('rumba2')
    assert mission.state is State.IDLE
    assert world.floor.coverage >= 0.99


@pytest.mark.thorough
def test_a_laser_saves_half_of_the_touches_that_outline_obstacles():
    plan = room(4.0, 3.0, 0.02, start=Pose(0.5, 0.5, 0.0))
    bumps = []
    for laser in (False, True):
        world = World(plan, quiet(), 50, 1, [Obstacle('box', Pose(2.0, 1.5, 0.4), 0.3, length=0.6, width=0.4),
                                             Obstacle('bag', Pose(3.2, 0.8, 0.0), 0.3, 0.12)])
        robot = world.spawn('rumba')
        mission = Mission(context_of(plan, world, laser=laser), 'boustrophedon', 0.97)
        run(mission, world, seconds=1500.0, source=seeing(truth))
        assert mission.outcome is Outcome.SUCCEEDED and world.floor.coverage >= 0.97
        bumps.append(robot.bumps)
    assert bumps[1] <= 0.5 * bumps[0]
