"""Robots never overlap walls or each other; the distances from the disc to each square are exact here."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from pytest import approx
from rooms import NAMES, PLANS, RADIUS, STARTS, alone, distances, drive, drove, hall, quiet, room, start

from rumba_sim.model.common.errors import WorldError
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.simulation.world import World

EXACT = 1e-6  # [m]


COMMANDS = st.lists(st.tuples(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0), st.integers(5, 60)), min_size=2, max_size=8)


def fast_world(plan, step_rate, share):
    """A world whose wheels reach a share of the largest allowed speed at once."""
    return World(plan, quiet(drive={'max_speed': min(share * RADIUS * step_rate, 10.0), 'acceleration': 1000.0,
                                    'max_turn_rate': 50.0}), step_rate)


@settings(max_examples=250)
@given(NAMES, st.sampled_from([10, 20, 50, 100]), st.sampled_from([0.03, 0.2, 1.0]), STARTS, COMMANDS)
def test_a_robot_never_overlaps_a_wall_nor_passes_through_one(plan, step_rate, share, where, commands):
    world = fast_world(PLANS[plan], step_rate, share)
    robot = world.spawn('rumba', start(plan, where))
    limit = world.config.drive.max_speed
    path = [robot.pose[:2]]
    for v, turn, ticks in commands:
        path += [pose[:2] for pose in drive(world, v * limit, 10.0 * turn, ticks)]
    assert min(distances(world.plan, path)) >= RADIUS - EXACT
    assert max(np.hypot(*np.diff(path, axis=0).T)) < 2.0 * RADIUS


@settings(max_examples=100)
@given(NAMES, st.sampled_from([10, 50]), STARTS, st.sampled_from([1, -1]))
@example(('slanted', 0.05), 50, (0, -0.4420871324757756), 1)  # between a wall and a slanted one: in a dent
def test_a_robot_that_backs_off_from_a_wall_gets_free(plan, step_rate, where, sign):
    world = World(PLANS[plan], quiet(drive={'acceleration': 1000.0}), step_rate)
    world.spawn('rumba', start(plan, where))
    before = drove(world, sign * 0.3, 0.0, 8 * step_rate)
    cos, sin = math.cos(before.theta), math.sin(before.theta)
    behind = [(before.x - sign * away * cos, before.y - sign * away * sin) for away in np.arange(0.02, 0.22, 0.01)]
    assume(min(distances(world.plan, behind)) > RADIUS + 0.002)
    after = drove(world, -sign * 0.3, 0.0, step_rate // 2)
    assert math.hypot(after.x - before.x, after.y - before.y) > 0.14


def apart(world):
    """Smallest distance between two robots, from edge to edge."""
    poses = [robot.pose for robot in world.robots.values()]
    return min(math.hypot(a.x - b.x, a.y - b.y) for a, b in itertools.combinations(poses, 2)) - 2.0 * RADIUS


@settings(max_examples=150)
@given(NAMES, st.sampled_from([10, 50]), st.sampled_from([0.03, 0.3, 1.0]),
       st.lists(st.tuples(STARTS, st.floats(-1.0, 1.0)), min_size=2, max_size=7))
def test_robots_never_overlap_walls_or_each_other_nor_pass_through_them(plan, step_rate, share, drivers):
    world = fast_world(PLANS[plan], step_rate, share)
    speeds = {}
    for name, (where, v) in enumerate(drivers):
        try:
            world.spawn(str(name), start(plan, where))
            speeds[str(name)] = v * world.config.drive.max_speed
        except WorldError:
            continue
    assume(len(speeds) > 1)
    before = [robot.pose[:2] for robot in world.robots.values()]
    for tick in range(60):
        for name, v in speeds.items():
            world.robots[name].command(v if tick < 40 else -v, 3.0 * v, world.tick)
        world.step()
        now = [robot.pose[:2] for robot in world.robots.values()]
        assert apart(world) >= -EXACT
        assert min(distances(world.plan, now)) >= RADIUS - EXACT
        assert max(np.hypot(*np.subtract(now, before).T)) < 2.0 * RADIUS
        before = now


@pytest.mark.parametrize('theta', [0.4, -0.4, 1.2, -1.2])
@pytest.mark.parametrize('resolution', [0.02, 0.05])
def test_a_robot_slides_along_a_wall_with_the_component_of_its_speed(theta, resolution):
    world, robot = alone(Pose(1.6, 1.5, theta), room(2.0, 3.0, resolution), drive={'acceleration': 1000.0})
    drove(world, 0.2, 0.0, 200 if abs(theta) < 1.0 else 280)
    before = robot.pose
    after = drove(world, 0.2, 0.0, 25)
    assert after.x == approx(before.x, abs=1e-9) and after.x == approx(2.0 - RADIUS, abs=0.003)
    assert after.y - before.y == approx(0.1 * math.sin(theta), abs=1e-6)
    assert after.theta == before.theta


@pytest.mark.parametrize('step_rate', [10, 50])
@pytest.mark.parametrize('shift', [0.0, 1e-9, 0.05, -0.2])
@pytest.mark.parametrize('order', ['ab', 'ba'])
def test_robots_that_drive_into_each_other_stop_or_slide_and_can_separate_again(step_rate, shift, order):
    world = World(room(6.0, 4.0), quiet(), step_rate)
    starts = {'a': Pose(2.0, 2.0, 0.0), 'b': Pose(3.0, 2.0 + shift, math.pi)}
    for name in order:
        world.spawn(name, starts[name])
    a, b = world.robots['a'], world.robots['b']
    for forward, seconds in ((True, 3), (False, 2)):
        for _ in range(seconds * step_rate):
            for robot in (a, b):
                robot.command(0.3 if forward else -0.3, 0.0, world.tick)
            world.step()
            assert apart(world) >= -EXACT
            if forward and abs(shift) < 0.01:
                assert a.pose.x < b.pose.x
    if abs(shift) < 0.01:
        assert apart(world) == approx(2 * (0.3 ** 2 / 0.9 / 2.0 + 0.3 * (2.0 - 2.0 * 0.3 / 0.9)), abs=0.04)


def test_a_robot_that_is_pushed_by_another_can_drive_away():
    world = World(room(6.0, 4.0), quiet())
    runner, presser = world.spawn('runner', Pose(3.0, 2.0, 0.0)), world.spawn('presser', Pose(2.6, 2.0, 0.0))
    for tick in range(200):
        presser.command(0.2, 0.0, world.tick)
        runner.command(0.0 if tick < 100 else 0.4, 0.0, world.tick)
        world.step()
        if tick == 99:
            assert runner.pose == Pose(3.0, 2.0, 0.0) and 0.0 <= apart(world) < 0.001
    assert runner.pose.x > 3.6 and apart(world) > 0.3


def test_two_robots_that_just_touch_are_not_stuck():
    world = World(room(6.0, 4.0), quiet())
    world.spawn('still', Pose(3.0, 2.0, 0.0))
    for angle in np.linspace(-3.0, 3.0, 50):
        distance = math.nextafter(2.0 * RADIUS, 9.0) if hasattr(math, 'nextafter') else 2.0 * RADIUS + 1e-15
        x, y = 3.0 + distance * math.cos(angle), 2.0 + distance * math.sin(angle)
        try:
            world.spawn('rumba', Pose(x, y, angle))
        except WorldError:  # rounded to the other side
            continue
        assert drove(world, 0.3, 0.0, 50) and apart(world) > 0.15
        world.kill('rumba')


@pytest.mark.parametrize('resolution', [0.02, 0.05])
@pytest.mark.parametrize('y', [1.2, 1.12, 1.29])
def test_a_robot_gets_through_a_door_that_is_a_little_wider_even_off_centre(y, resolution):
    plan = room(4.0, 2.4, resolution, [(1.9, 0.0, 2.1, 1.0), (1.9, 1.4, 2.1, 2.4)])
    world, _ = alone(Pose(1.0, y, 0.0), plan)
    assert drove(world, 0.3, 0.0, 500).x > 3.0


def test_a_robot_that_appears_in_front_of_another_is_noticed_at_once():
    world = World(hall(), quiet())
    world.spawn('rumba', Pose(3.0, 3.0, 0.0))
    world.spawn('other', Pose(17.0, 17.0, 0.0))
    drove(world, 0.3, 0.0, 50)
    for x in (4.2, 5.0):
        if x == 4.2:
            world.teleport('other', Pose(x, 3.0, 0.0))
        else:
            world.kill('other')
            world.spawn('other', Pose(x, 3.0, 0.0))
        drove(world, 0.4, 0.0, 200)
        assert 0.0 <= apart(world) < 0.001
