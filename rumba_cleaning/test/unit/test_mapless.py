"""Robots without map and laser clean for a time, look for their dock and find it, by what they sense alone."""

import itertools
import math
import re
import types

import numpy as np
import pytest
from drivers import run
from rooms import RADIUS, quiet, room

from rumba_cleaning import strategies
from rumba_cleaning.behaviour import Command, Observation, Status
from rumba_cleaning.behaviours.bounded import Bounded
from rumba_cleaning.behaviours.homing import BUOYS
from rumba_cleaning.belief.context import Context
from rumba_cleaning.belief.recent import REMEMBERED
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.control import steps
from rumba_cleaning.edges.guard import RECENT_SPEED, Guard
from rumba_cleaning.mission.mapless import MaplessMission
from rumba_cleaning.mission.seek import Seek
from rumba_cleaning.mission.stages import State
from rumba_cleaning.outcome import Outcome
from rumba_cleaning.pose_source import reckoned
from rumba_cleaning.ros.cleaner.goals import activities
from rumba_cleaning.strategies.wander import LINES, ROOMY, SPARSE, WALLS, Wander
from rumba_msg.msg import CleanGoal, DockGoal, GoToGoal
from rumba_sim.model.common.config import updated
from rumba_sim.model.common.errors import ConfigError, MapError, StrategyError
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.kernel.geometry import arc
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation.world import World

DOCK = Pose(4.0 - RADIUS - 0.01, 1.2, 0.0)
PLAN = room(4.0, 3.0, 0.05, dock=DOCK)
TIME = 300.0  # [s] to clean
STAIRS = room(4.0, 3.0, 0.02, cliff=(0.0, 2.3, 2.0, 3.0), dock=DOCK)


def context(robot=None, seed=1, **config):
    """What a robot knows without a map."""
    return Context.without_map(robot or RobotConfig(), CleaningConfig(**config), seed)


def mission(plan=PLAN, strategy='wander', start=None, charge=1.0, seed=1, seconds=TIME, **battery):
    """A world after its first tick, in which wheels err, and a robot that begins a mission."""
    robot = updated(RobotConfig(), {'battery': battery}, 'test')
    world = World(plan, robot, seed=seed)
    world.spawn('rumba', start, charge, brushes_up=True)
    world.step()
    return world, MaplessMission(context(robot, seed, cleaning_time=seconds), strategy)


def states(behaviour, world, seconds=6000.0):
    """The states of a mission, one after the other."""
    return [state for state, _ in itertools.groupby(
        behaviour.state for _ in steps(behaviour, world, seconds=seconds, source=reckoned))]


# --- wander ---------------------------------------------------------------------------------------------------------

def on_free_floor(behaviour, seconds, bumps=()):
    """The names of the parts of wander, one after the other, on floor without end; it is touched at some times [s]."""
    pose, parts = Pose(0.0, 0.0, 0.0), []
    for step in range(round(10.0 * seconds)):
        touched = any(math.isclose(0.1 * step, bump) for bump in bumps)
        command = behaviour.step(Observation(0.1, pose, bumper=(touched, touched)))
        parts.append(type(behaviour._part).__name__)
        theta = pose.theta + 0.1 * command.w
        pose = Pose(pose.x + 0.1 * command.v * math.cos(theta), pose.y + 0.1 * command.v * math.sin(theta), theta)
    return [(name, 0.1 * len(list(group))) for name, group in itertools.groupby(parts)]


def test_wander_begins_with_a_spiral_and_goes_on_with_lines_and_walls_in_turn():
    bumps = np.arange(40.0, 400.0, 5.0)  # so that it never has space for another spiral
    found = on_free_floor(Wander(context()), 200.0, bumps)
    assert [name for name, _ in found[:4]] == ['Spiral', 'Bounce', 'WallFollow', 'Bounce']
    assert [time for _, time in found[1:3]] == pytest.approx([LINES, WALLS], abs=0.3)


def test_wander_begins_a_new_spiral_where_it_has_space_but_not_too_often():
    found = on_free_floor(Wander(context()), 400.0)
    spirals = [index for index, (name, _) in enumerate(found) if name == 'Spiral']
    assert len(spirals) >= 3
    assert all(sum(time for _, time in found[first + 1:second]) > SPARSE for first, second in zip(spirals, spirals[1:]))
    before = [found[index - 1] for index in spirals[1:]]
    assert all(name == 'Bounce' and 0.3 * time > ROOMY - 0.1 for name, time in before)


def test_wander_without_spirals_never_makes_one():
    assert 'Spiral' not in dict(on_free_floor(Wander(context(), spirals=False), 400.0))


# --- the mission ----------------------------------------------------------------------------------------------------

@pytest.mark.thorough(except_for=['1-wander', '2-bounce'])
@pytest.mark.parametrize('strategy', ['wander', 'bounce'])
@pytest.mark.parametrize('seed', [1, 2, 3])
def test_it_cleans_for_its_time_and_comes_home_although_its_wheels_err(strategy, seed):
    world, behaviour = mission(strategy=strategy, seed=seed)
    seen = states(behaviour, world)
    assert seen[:3] == [State.UNDOCKING, State.CLEANING, State.RETURNING] and seen[-2:] == [State.DOCKING, State.IDLE]
    assert set(seen[3:-1]) <= {State.RETURNING, State.DOCKING}
    assert behaviour.outcome is Outcome.SUCCEEDED
    assert re.fullmatch('cleaned for [45] of 5 min|cleaned for 5 min', behaviour.message)
    assert world.robots['rumba'].is_docked and world.floor.coverage > 0.45
    believed, true = reckoned(world, 'rumba').pose, world.robots['rumba'].pose
    assert math.hypot(believed.x - true.x + DOCK.x, believed.y - true.y + DOCK.y) > 0.3  # it does not know where it is


@pytest.mark.parametrize('seed', [1, 2, 5])
def test_near_the_end_of_its_time_it_returns_once_it_receives_the_beams(seed):
    world, behaviour = mission(seed=seed)
    cleaned = 0.0
    for observation, _ in steps(behaviour, world, source=reckoned):
        if behaviour.state not in (State.IDLE, State.UNDOCKING, State.CLEANING):
            break
        cleaned += observation.dt * (behaviour.state is State.CLEANING)
    assert observation.infrared.omni & BUOYS and 0.9 * TIME - 0.2 <= cleaned < TIME - 1.0


def test_near_the_end_of_its_charge_it_returns_once_it_receives_the_beams():
    world, behaviour = mission(seconds=900.0, drain=20.0)
    for observation, _ in steps(behaviour, world, source=reckoned):
        if behaviour.state not in (State.IDLE, State.UNDOCKING, State.CLEANING):
            break
    assert observation.infrared.omni & BUOYS and 0.56 < observation.state_of_charge < 0.66


@pytest.mark.thorough
def test_it_charges_as_often_as_its_time_takes():
    world, behaviour = mission(seconds=900.0, drain=20.0)
    seen = states(behaviour, world)
    assert behaviour.outcome is Outcome.SUCCEEDED and behaviour.charges >= 2
    assert seen.count(State.CHARGING) == behaviour.charges and behaviour.charging_time > 100.0


def test_a_robot_that_is_low_begins_with_charging():
    world, behaviour = mission(charge=0.2)
    assert states(behaviour, world, seconds=3.0)[:2] == [State.CHARGING]


def test_a_battery_that_does_not_last_until_the_dock_is_found_strands_it():
    far = room(12.0, 9.0, 0.05, dock=Pose(12.0 - RADIUS - 0.01, 1.2, 0.0))
    world, behaviour = mission(far, start=Pose(1.0, 8.0, 2.0), charge=0.1, drain=60.0)
    behaviour._knows_dock = True
    assert states(behaviour, world)[-1] is State.STRANDED
    assert (behaviour.outcome, behaviour.message) == (Outcome.BATTERY_EMPTY,
                                                      'cleaned for 0 of 5 min: the battery is empty')


def test_a_robot_that_never_heard_of_a_dock_ends_where_it_is():
    world, behaviour = mission(room(4.0, 3.0, 0.05), start=Pose(1.0, 1.0, 0.0), seconds=60.0)
    assert states(behaviour, world) == [State.CLEANING, State.IDLE]
    assert behaviour.outcome is Outcome.SUCCEEDED and world.time == pytest.approx(60.0, abs=0.3)


def test_a_strategy_that_ends_ends_the_mission():
    world, behaviour = mission(strategy='spiral', start=Pose(2.4, 1.2, 0.0))
    states(behaviour, world)
    assert behaviour.message.startswith('cleaned for 1 of 5 min: a spot of 1.2 m is swept')
    assert world.robots['rumba'].is_docked


def test_resumed_it_cleans_for_what_is_left_of_its_time():
    world, behaviour = mission(seconds=200.0)
    run(behaviour, world, seconds=100.0, source=reckoned)
    behaviour.stop()
    behaviour.resume()
    began = world.time
    for _ in steps(behaviour, world, seconds=2000.0, source=reckoned):
        if behaviour.state not in (State.IDLE, State.CLEANING):
            break
    assert 70.0 < world.time - began < 110.0  # the sooner, the earlier it receives the beams near the end of its time


@pytest.mark.parametrize('name', ['boustrophedon', 'explore_and_clean'])
def test_a_strategy_that_needs_a_map_is_refused(name):
    with pytest.raises(StrategyError, match=f"^strategy '{name}' needs a map: without one there are bounce, spiral, "
                                            'wall_follow, wander$'):
        MaplessMission(context(), name)
    with pytest.raises(StrategyError, match='^unknown strategy'):
        strategies.check_mapless('nothing')


@pytest.mark.thorough(except_for=['2-bounce'])
@pytest.mark.parametrize('strategy', ['wander', 'bounce'])
@pytest.mark.parametrize('seed', [1, 2, 6])
def test_beside_stairs_it_neither_falls_nor_gives_up(strategy, seed):
    world, behaviour = mission(STAIRS, strategy, seed=seed, seconds=900.0)
    states(behaviour, world)
    assert behaviour.outcome is Outcome.SUCCEEDED, behaviour.message
    assert not world.robots['rumba'].has_fallen and world.robots['rumba'].is_docked


# --- the way home ---------------------------------------------------------------------------------------------------

def test_it_seeks_the_dock_until_it_is_there_and_drives_about_after_a_failed_attempt():
    behaviour = Seek(context(quiet()))
    world = World(PLAN, quiet())
    world.spawn('rumba', Pose(1.0, 2.5, math.pi), brushes_up=True)
    parts = []
    for _, command in steps(Bounded(behaviour, 2000.0), world, source=reckoned):
        parts.append(behaviour.is_homing)
        assert command.brushes_up
    assert behaviour.status is Status.SUCCEEDED and world.robots['rumba'].is_docked
    assert parts[0] is False and parts[-1] is True and math.isnan(behaviour.remaining)


def test_after_an_attempt_that_failed_beams_do_not_count_for_a_while():
    behaviour, pose = Seek(context()), Pose(0.0, 0.0, 0.0)
    beams = Observation(0.1, pose)._replace(infrared=types.SimpleNamespace(omni=0, left=0, right=0))
    heard = beams._replace(infrared=types.SimpleNamespace(omni=8, left=8, right=8))
    behaviour.step(heard)
    assert behaviour.is_homing
    for _ in range(100):  # silence: homing gives up
        behaviour.step(beams)
    assert not behaviour.is_homing
    behaviour.step(heard)
    assert not behaviour.is_homing
    for _ in range(60):
        behaviour.step(beams)
    behaviour.step(heard)
    assert behaviour.is_homing


# --- what it remembers ----------------------------------------------------------------------------------------------

def test_an_edge_is_remembered_for_a_metre_and_forgotten_after_two():
    knowledge = context(quiet())
    guard = Guard(knowledge)
    remembered = []
    for step in range(250):
        pose = Pose(0.01 * step, 0.0, 0.0)
        guard.step(lambda _: Command(0.1, 0.0), Observation(0.1, pose, cliffs=(step == 0, False, False, False)))
        remembered.append(bool(knowledge.cliff_map.seen))
    assert all(remembered[:100]) and not any(remembered[200:])
    assert knowledge.plan.bounds.left < 2.5 - 2.0 * REMEMBERED < 2.5 + 2.0 * REMEMBERED < knowledge.plan.bounds.right


@pytest.mark.parametrize('w', [0.0, 0.5, 1.5])
def test_over_floor_that_it_has_not_seen_no_wheel_is_fast_in_a_bend_either(w):
    knowledge, pose, fastest = context(), Pose(0.0, 0.0, 0.0), []
    guard = Guard(knowledge)
    for _ in range(15):
        v, turn = guard.step(lambda _: Command(0.3, w), Observation(0.1, pose))[:2]
        fastest.append(v + turn * 0.5 * knowledge.robot.drive.wheel_base)
        pose = Pose(*arc(*pose, 0.1 * v, 0.1 * turn))
    assert np.median(fastest) == pytest.approx(RECENT_SPEED)


# --- goals of the cleaner -------------------------------------------------------------------------------------------

def test_goals_without_a_map():
    knowledge = context(cleaning_time=60.0, strategy='wander')
    assert activities.Cleaning.of_goal(knowledge, CleanGoal()).strategy == 'wander'
    assert activities.Docking(knowledge, DockGoal()).state is State.RETURNING
    with pytest.raises(ConfigError, match='^target_coverage is 0.5: must be 0, since a robot without a map does not '
                                          'know what share is swept; it cleans for 60 s$'):
        activities.Cleaning.of_goal(knowledge, CleanGoal(target_coverage=0.5))
    with pytest.raises(MapError, match='^go_to needs a map, and this cleaner works without one .parameter mapless.$'):
        activities.GoingTo(knowledge, GoToGoal())
