"""Docks in sight of each other, at right angles: robots come home to theirs, or to another one that is free."""

import itertools
import math

import pytest
from drivers import context_of, run
from rooms import RADIUS, quiet, room

from rumba_cleaning.behaviours.dock import Dock
from rumba_cleaning.belief.mates import Report, Task
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.simulation.obstacle import Obstacle
from rumba_sim.model.simulation.robot import put
from rumba_sim.model.simulation.world import World

AWAY = RADIUS + 0.03
TOP, RIGHT = Pose(1.4, 3.0 - AWAY, 0.5 * math.pi), Pose(3.0 - AWAY, 1.8, 0.0)
STARTS = [Pose(1.0, 1.0, 0.3), Pose(2.2, 2.2, 2.0), Pose(0.6, 2.0, -2.0)]


def floor(docks):
    """A room of 3 x 3 m with docks."""
    return room(3.0, 3.0, dock=docks[0], further_docks=tuple(docks[1:]))


@pytest.mark.parametrize('docks, start', itertools.product([(TOP, RIGHT), (RIGHT, TOP)], STARTS))
def test_a_robot_docks_although_it_sees_the_beams_of_two_docks(docks, start):
    world = World(floor(docks), quiet())
    world.spawn('rumba', start)
    world.step()
    behaviour = Dock(context_of(world.plan, world))
    assert run(behaviour, world) < 200.0
    assert (behaviour.message, world.robots['rumba'].is_docked) == ('docked', True)


def test_a_robot_that_stands_at_another_dock_is_docked_and_at_home_there():
    world = World(floor((TOP, RIGHT)), quiet())
    world.spawn('rumba', RIGHT)
    world.step()
    context = context_of(world.plan, world)
    behaviour = Dock(context)
    run(behaviour, world, seconds=1.0)
    assert behaviour.message == 'docked' and context.home == RIGHT


@pytest.mark.parametrize('task', [Task.DOCKED, Task.OFF])
def test_a_robot_goes_to_a_free_dock_if_a_mate_stands_at_its_own(task):
    world = World(floor((TOP, RIGHT)), quiet())
    world.spawn('rumba', Pose(1.0, 1.0, 0.3))
    world.spawn('rumba2', TOP)
    world.step()
    context = context_of(world.plan, world)
    context.hear('rumba2', Report(TOP, True, task, None))
    behaviour = Dock(context)
    run(behaviour, world)
    assert (behaviour.message, context.home, world.robots['rumba'].is_docked) == ('docked', RIGHT, True)


def test_a_robot_waits_if_mates_stand_at_all_docks():
    world = World(floor((TOP, RIGHT)), quiet())
    world.spawn('rumba', Pose(1.0, 1.0, 0.3))
    context = context_of(world.plan, world)
    for name, dock in (('rumba2', TOP), ('rumba3', RIGHT)):
        context.hear(name, Report(dock, True, Task.DOCKED, None))
    behaviour = Dock(context)
    run(behaviour, world, seconds=60.0)
    assert behaviour.message == 'waiting for the dock, where rumba2 is' and not world.robots['rumba'].is_docked


def test_a_robot_leaves_the_dock_of_a_mate_that_it_touches_on_its_way_home():
    world = World(floor((TOP, RIGHT)), quiet())
    world.spawn('rumba', Pose(1.0, 1.0, 0.3))
    context = context_of(world.plan, world)
    context.hear('rumba2', Report(Pose(2.4, 0.6, 0.0), False, Task.SWEEPING, None))
    behaviour = Dock(context)
    run(behaviour, world, seconds=1.0)
    put(world.robots['rumba'].state, RIGHT)
    world.step()
    assert world.robots['rumba'].is_docked
    run(behaviour, world)
    assert (behaviour.message, context.home, world.robots['rumba'].is_docked) == ('docked', TOP, True)


def test_a_robot_before_its_dock_goes_to_another_one_as_soon_as_a_mate_stands_there():
    world = World(floor((TOP, RIGHT)), quiet())
    world.spawn('rumba', Pose(TOP.x, 2.0, 0.5 * math.pi))
    context = context_of(world.plan, world)
    behaviour = Dock(context)
    run(behaviour, world, seconds=2.0)
    assert behaviour.is_homing
    world.spawn('rumba2', TOP)
    context.hear('rumba2', Report(TOP, True, Task.OFF, None))
    assert run(behaviour, world) < 60.0
    assert (behaviour.message, context.home, world.robots['rumba'].is_docked) == ('docked', RIGHT, True)


def test_a_robot_that_cannot_dock_at_its_own_dock_goes_to_another_one():
    box = Obstacle('box', Pose(TOP.x, TOP.y - 0.4, 0.0), 0.3, 0.1)
    world = World(floor((TOP, RIGHT)), quiet(), obstacles=[box])
    world.spawn('rumba', Pose(1.0, 1.0, 0.3))
    world.step()
    context = context_of(world.plan, world)
    behaviour = Dock(context)
    run(behaviour, world, seconds=900.0)
    assert (behaviour.message, context.home, world.robots['rumba'].is_docked) == ('docked', RIGHT, True)


@pytest.mark.parametrize('own, left, right, start', [
    (2.0, 2.4, 0.7, Pose(3.3, 1.5, -0.5)), (1.4, 1.2, 0.9, Pose(3.0, 1.6, 2.8)), (2.3, 1.7, 0.5, Pose(2.9, 2.3, 2.5)),
    (1.3, 2.3, 0.7, Pose(2.7, 1.5, -0.8)), (1.6, 1.2, 0.8, Pose(0.8, 2.4, 2.2)),
])
def test_a_robot_drives_straight_into_its_dock_although_there_is_one_on_each_side(own, left, right, start):
    """The beams of the docks aside led it past the contacts, again and again."""
    docks = [Pose(own, AWAY, -0.5 * math.pi), Pose(AWAY, left, math.pi), Pose(4.0 - AWAY, right, 0.0)]
    world = World(room(4.0, 3.0, dock=docks[0], further_docks=tuple(docks[1:])), quiet())
    world.spawn('rumba', start)
    behaviour = Dock(context_of(world.plan, world))
    assert run(behaviour, world, seconds=120.0) < 60.0
    assert behaviour.message == 'docked' and abs(world.robots['rumba'].pose.x - own) < 0.1


def test_a_robot_begins_nearer_to_its_dock_if_a_mate_is_docked_before_it():
    own, other = Pose(AWAY, 1.5, math.pi), Pose(AWAY + 0.71, 1.42, 0.0)
    world = World(room(AWAY + 0.71 + AWAY, 3.0, dock=own, further_docks=(other,)), quiet())
    world.spawn('rumba', Pose(0.5, 2.4, 0.0))
    world.spawn('rumba2', Pose(other.x - 0.07, other.y, 0.0))
    world.step()
    context = context_of(world.plan, world)
    context.hear('rumba2', Report(world.robots['rumba2'].pose, True, Task.OFF, None))
    behaviour = Dock(context)
    assert run(behaviour, world, seconds=300.0) < 100.0
    assert (behaviour.message, world.robots['rumba'].pose.x < 0.35) == ('docked', True)
