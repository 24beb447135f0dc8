"""Encoder ticks and odometry, against closed forms and statistics."""

import math

import numpy as np
import pytest
from pytest import approx
from rooms import RADIUS, alone, drove, hall, quiet, room

from rumba_sim.model.common.geometry import Pose, wrap_angle
from rumba_sim.model.simulation.world import World

BASE = 0.235
TICKS_PER_METRE = 508.8 / (math.pi * 0.072)
TICK = 1.0 / TICKS_PER_METRE


def hall_of_robots(rows=8, columns=12, seed=1, **odometry):
    """A world with many robots that all face along x, with 4 m of free floor ahead and behind."""
    world = World(hall(), quiet(odometry=odometry), seed=seed)
    for row in range(rows):
        for column in range(columns):
            world.spawn(f'rumba{row}_{column}', Pose(4.5 + column, 1.0 + 2.0 * row, 0.0))
    return world


def drive_all(world, v, w, ticks):
    """Give all robots the same commands."""
    for _ in range(ticks):
        for robot in world.robots.values():
            robot.command(v, w, world.tick)
        world.step()


@pytest.mark.parametrize('v', [0.3, -0.3])
@pytest.mark.parametrize('turns', [1, 5, 20])
def test_a_turn_of_a_wheel_counts_508_8_ticks(v, turns):
    world, robot = alone(step_rate=100, drive={'acceleration': 1000.0})
    ticks = round(turns * math.pi * 0.072 / (abs(v) / 100.0))
    drove(world, v, 0.0, ticks)
    expected = math.copysign(robot.distance / (math.pi * 0.072) * 508.8, v)
    assert expected == approx(math.copysign(turns * 508.8, v), abs=8.0)
    assert robot.ticks == (math.floor(expected + 1e-6),) * 2


def test_ticks_are_counted_in_both_directions_for_each_wheel():
    world, robot = alone(drive={'acceleration': 1000.0})
    drove(world, 0.0, 1.0, 100)
    assert robot.ticks == approx((-BASE * TICKS_PER_METRE, BASE * TICKS_PER_METRE), abs=1.0)
    drove(world, 0.0, -1.0, 100)
    assert robot.ticks == approx((0.0, 0.0), abs=1.0)
    drove(world, 0.3, 0.5, 100)
    assert robot.ticks == approx(((0.6 - BASE / 2.0) * TICKS_PER_METRE, (0.6 + BASE / 2.0) * TICKS_PER_METRE), abs=1.0)


@pytest.mark.parametrize('traction', [0.98, 0.7])
def test_a_wheel_that_slips_counts_more_than_the_driven_distance(traction):
    world, robot = alone(odometry={'floor_traction': traction})
    drove(world, 0.3, 0.0, 500)
    assert robot.ticks == approx((robot.distance / traction * TICKS_PER_METRE,) * 2, abs=1.0)
    assert robot.odometry.x == approx(robot.distance / traction, abs=TICK)
    assert robot.odometry_twist == approx((0.3 / traction, 0.0))


def test_traction_changes_on_a_carpet_that_both_wheels_stand_on():
    plan = room(6.0, 2.0, carpet=(2.0, 0.0, 4.0, 1.0))
    grips = {'floor_traction': 0.98, 'carpet_traction': 0.9}
    for y, slip in ((0.5, 2.0 / 0.9 + 2.0 / 0.98), (1.05, 4.0 / 0.98), (1.5, 4.0 / 0.98)):
        world, robot = alone(Pose(1.0, y, 0.0), plan, odometry=grips, drive={'acceleration': 1000.0})
        drove(world, 0.4, 0.0, 500)
        assert robot.distance == approx(4.0)
        assert robot.ticks == approx((slip * TICKS_PER_METRE,) * 2, abs=10.0)


def test_the_odometry_of_exact_wheels_is_right_within_a_tick():
    world, robot = alone(Pose(10.0, 10.0, 1.0))
    rng = np.random.default_rng(4)
    for _ in range(60):
        drove(world, rng.uniform(-0.3, 0.5), rng.uniform(-1.5, 1.5), 25)
        true, odometry = robot.pose, robot.odometry
        cos, sin = math.cos(1.0), math.sin(1.0)
        x = 10.0 + cos * odometry.x - sin * odometry.y
        y = 10.0 + sin * odometry.x + cos * odometry.y
        assert wrap_angle(true.theta - 1.0 - odometry.theta) == approx(0.0, abs=TICK / BASE + 1e-9)
        assert (x, y) == approx((true.x, true.y), abs=TICK + TICK / BASE * robot.distance)
    assert robot.distance > 5.0


def test_wheels_that_slip_at_a_wall_still_count():
    world, robot = alone(Pose(1.0, 1.0, 0.0), room(2.0, 2.0))
    drove(world, 0.3, 0.0, 500)
    before, ticks = robot.pose, robot.ticks
    drove(world, 0.3, 0.0, 100)
    assert robot.pose == approx(before, abs=1e-9) and robot.pose.x == approx(2.0 - RADIUS, abs=0.005)
    assert robot.ticks == approx((ticks[0] + 0.6 * TICKS_PER_METRE,) * 2, abs=1.0)
    assert robot.odometry.x > robot.distance + 1.0


def test_each_wheel_has_its_own_scale_and_the_odometry_turns_away_from_the_larger():
    lefts = []
    for seed in range(6):
        world = World(hall(), quiet(odometry={'scale_error': 0.05}), seed=seed)
        robot = world.spawn('rumba', Pose(10.0, 10.0, 0.0))
        drove(world, 0.3, 0.0, 250)
        left, right = (ticks / TICKS_PER_METRE for ticks in robot.ticks)
        assert (left, right) == approx((robot.distance * float(robot.state['left_scale']),
                                        robot.distance * float(robot.state['right_scale'])), abs=TICK)
        assert robot.odometry.theta == approx((right - left) / BASE)
        assert (robot.odometry.theta > 0.0) == (right > left) == (robot.odometry.y > 0.0)
        assert robot.pose.theta == 0.0
        lefts.append(left > right)
    assert set(lefts) == {True, False}


def test_scale_errors_of_both_wheels_have_their_standard_deviation_and_no_correlation():
    world = hall_of_robots(scale_error=0.04)
    drive_all(world, 0.4, 0.0, 100)
    counted = np.array([robot.ticks for robot in world.robots.values()]) * TICK
    errors = counted / next(iter(world.robots.values())).distance - 1.0
    assert np.std(errors, axis=0) == approx([0.04, 0.04], rel=0.25)
    assert np.mean(errors, axis=0) == approx([0.0, 0.0], abs=4.0 * 0.04 / math.sqrt(len(errors)))
    assert abs(np.corrcoef(errors[:, 0], errors[:, 1])[0, 1]) < 0.35


@pytest.mark.parametrize('v', [0.4, -0.2])
@pytest.mark.parametrize('seconds', [2, 10])
def test_noise_grows_with_the_square_root_of_the_distance(v, seconds):
    world = hall_of_robots(noise=0.01)
    drive_all(world, v, 0.0, 50 * seconds)
    counted = np.array([robot.ticks for robot in world.robots.values()]) * TICK
    distance = next(iter(world.robots.values())).distance
    errors = np.abs(counted) - distance
    assert distance == approx(abs(v) * seconds, abs=0.1)
    assert np.std(errors, axis=0) == approx([0.01 * math.sqrt(distance)] * 2, rel=0.25)
    assert np.mean(errors) == approx(0.0, abs=4.0 * 0.01 * math.sqrt(distance / errors.size))
    assert abs(np.corrcoef(errors[:, 0], errors[:, 1])[0, 1]) < 0.35


def test_noise_does_not_depend_on_the_length_of_a_tick():
    for step_rate in (20, 100):
        world = World(hall(), quiet(odometry={'noise': 0.02}), step_rate, seed=3)
        for index in range(64):
            world.spawn(f'rumba{index}', Pose(1.0 + index % 8, 1.0 + 2.0 * (index // 8), 0.0))
        drive_all(world, 0.4, 0.0, 5 * step_rate)
        errors = [ticks * TICK - robot.distance for robot in world.robots.values() for ticks in robot.ticks]
        assert np.std(errors) == approx(0.02 * math.sqrt(2.0), rel=0.2)


def test_wheels_that_stand_still_make_no_noise():
    world = hall_of_robots(2, 2, noise=0.1, scale_error=0.2)
    world.step(500)
    assert all(robot.ticks == (0, 0) and robot.odometry == (0.0, 0.0, 0.0) for robot in world.robots.values())


def test_a_teleport_changes_the_true_pose_and_not_the_odometry():
    world, robot = alone()
    drove(world, 0.3, 0.2, 100)
    odometry, ticks = robot.odometry, robot.ticks
    world.teleport('rumba', Pose(3.0, 4.0, -1.0))
    world.step(50)
    assert robot.pose == approx((3.0, 4.0, -1.0)) and (robot.odometry, robot.ticks) == (odometry, ticks)
    assert robot.twist == robot.odometry_twist == (0.0, 0.0)
