"""How a robot drives, against closed forms."""

import itertools
import math

import pytest
from pytest import approx
from rooms import alone, drive, drove

from rumba_sim.model.common.errors import CommandError
from rumba_sim.model.common.geometry import Pose, wrap_angle

START = Pose(10.0, 10.0, 0.4)
BASE, ACCELERATION = 0.235, 0.9
AT_ONCE = {'acceleration': 1000.0}


@pytest.mark.parametrize('step_rate', [10, 50, 100])
@pytest.mark.parametrize('v', [0.3, -0.45])
def test_a_robot_speeds_up_at_its_acceleration_and_then_goes_straight_ahead(v, step_rate):
    world, robot = alone(START, step_rate=step_rate)
    dt, distance = 1.0 / step_rate, 0.0
    for tick, pose in enumerate(drive(world, v, 0.0, 2 * step_rate), 1):
        speed = math.copysign(min(ACCELERATION * tick * dt, abs(v)), v)
        distance += speed * dt
        assert robot.twist == approx((speed, 0.0))
        assert pose == approx((10.0 + distance * math.cos(0.4), 10.0 + distance * math.sin(0.4), 0.4))
        assert robot.distance == approx(abs(distance))


def test_the_distance_after_a_start_is_that_of_constant_acceleration():
    ticks, dt = 25, 0.01
    world, _ = alone(step_rate=100)
    assert drove(world, 0.4, 0.0, ticks).x - 10.0 == approx(ACCELERATION * dt ** 2 * ticks * (ticks + 1) / 2.0)


@pytest.mark.parametrize('v, w', [(0.3, 0.8), (0.3, -0.8), (-0.2, 0.5), (-0.2, -0.5), (0.4, 0.001), (0.1, 1.5)])
def test_a_robot_at_speed_follows_an_exact_circle(v, w):
    world, robot = alone(START)
    begin = drove(world, v, w, 100)
    assert robot.twist == approx((v, w))
    for tick, pose in enumerate(drive(world, v, w, 400), 1):
        turned = w * tick / 50.0
        assert pose.x == approx(begin.x + v / w * (math.sin(begin.theta + turned) - math.sin(begin.theta)))
        assert pose.y == approx(begin.y - v / w * (math.cos(begin.theta + turned) - math.cos(begin.theta)))
        assert wrap_angle(pose.theta - begin.theta - turned) == approx(0.0, abs=1e-9)


@pytest.mark.parametrize('w', [1.2, -1.2])
def test_a_turn_in_place_is_counter_clockwise_if_w_is_positive_and_keeps_the_position(w):
    world, robot = alone(START, drive=AT_ONCE)
    for tick, pose in enumerate(drive(world, 0.0, w, 200), 1):
        assert pose[:2] == START[:2]
        assert wrap_angle(pose.theta - 0.4 - w * tick / 50.0) == approx(0.0, abs=1e-9)
    assert robot.distance == 0.0


def test_a_turn_begins_at_the_acceleration_of_the_wheels():
    world, robot = alone(START)
    drove(world, 0.0, 1.5, 3)
    assert robot.twist == approx((0.0, 3 * 0.02 * 2.0 * ACCELERATION / BASE))
    assert robot.pose.theta == approx(0.4 + (1 + 2 + 3) * 0.02 ** 2 * 2.0 * ACCELERATION / BASE)


def test_a_robot_brakes_with_the_same_acceleration():
    world, robot = alone(START)
    drove(world, 0.36, 0.0, 50)
    speeds = [robot.twist.v for _ in drive(world, 0.0, 0.0, 25)]
    assert speeds == approx([max(0.36 - 0.018 * tick, 0.0) for tick in range(1, 26)], abs=1e-12)
    assert speeds[-1] == 0.0


@pytest.mark.parametrize('v, w, left, right', [
    (0.3, 1.0, 0.3 - 0.1175, 0.3 + 0.1175),
    (2.0, 0.0, 0.5, 0.5),
    (-2.0, 0.0, -0.5, -0.5),
    (0.0, 9.0, -1.9 * BASE / 2.0, 1.9 * BASE / 2.0),
    (0.0, -9.0, 1.9 * BASE / 2.0, -1.9 * BASE / 2.0),
    (0.5, 1.5, 0.5 * 0.32375 / 0.67625, 0.5),
    (-0.5, 1.5, -0.5, -0.5 * 0.32375 / 0.67625),
])
def test_a_command_is_cut_to_the_limits_and_keeps_its_arc(v, w, left, right):
    world, robot = alone(START, drive=AT_ONCE)
    drove(world, v, w, 1)
    assert robot.twist == approx(((left + right) / 2.0, (right - left) / BASE))
    if abs(v) <= 0.5 and abs(w) <= 1.9 and v:
        assert robot.twist.w / robot.twist.v == approx(w / v)


@pytest.mark.parametrize('v, w, moves', [
    (0.0109, 0.0, False), (0.0111, 0.0, True), (-0.0109, 0.0, False), (-0.0111, 0.0, True),
    (0.0, 0.0108 / (BASE / 2.0), False), (0.0, 0.0112 / (BASE / 2.0), True)])
def test_a_wheel_stands_still_in_its_dead_band(v, w, moves):
    world, robot = alone(START)
    drove(world, v, w, 50)
    assert (robot.distance > 0.0 or abs(robot.pose.theta - 0.4) > 0.001) == moves


def test_each_wheel_has_its_own_dead_band():
    world, robot = alone(START, drive=AT_ONCE)
    drove(world, 0.05, 0.4, 1)
    assert robot.twist == approx(((0.05 + 0.047) / 2.0, (0.05 + 0.047) / BASE))


@pytest.mark.parametrize('step_rate, timeout, ticks', [(50, 0.5, 25), (100, 0.2, 20), (10, 1.0, 10), (10, 0.02, 1)])
def test_a_command_stays_in_force_for_exactly_its_timeout(step_rate, timeout, ticks):
    world, robot = alone(START, step_rate=step_rate, drive={'command_timeout': timeout, **AT_ONCE})
    world.step(7)
    robot.command(0.3, 0.0, world.tick)
    moved = []
    for _ in range(ticks + 5):
        before = robot.pose
        world.step()
        moved.append(robot.pose != before)
    assert moved == [True] * ticks + [False] * 5


def test_a_new_command_starts_a_new_timeout():
    world, robot = alone(START, drive=AT_ONCE)
    robot.command(0.3, 0.0, world.tick)
    world.step(20)
    robot.command(0.3, 0.0, world.tick)
    world.step(25)
    assert robot.twist.v == approx(0.3)
    world.step()
    assert robot.twist.v == 0.0


def test_nothing_moves_before_the_first_command():
    world, robot = alone(START)
    world.step(1000)
    assert robot.pose == approx(START) and robot.distance == 0.0 and robot.ticks == (0, 0)


@pytest.mark.parametrize('v, w', [
    pair for value in (math.nan, math.inf, -math.inf) for pair in ((value, 0.0), (0.0, value))])
def test_a_command_that_is_not_finite_is_refused_and_the_previous_one_stays_in_force(v, w):
    world, robot = alone(START, drive=AT_ONCE)
    robot.command(0.2, 0.5, world.tick)
    world.step(10)
    with pytest.raises(CommandError, match=rf'^rumba: velocity {v} m/s, {w} rad/s: must be finite numbers$'):
        robot.command(v, w, world.tick)
    world.step(15)
    assert robot.twist == approx((0.2, 0.5))
    world.step(1)
    assert robot.twist == (0.0, 0.0)


def test_the_heading_stays_in_its_interval_after_many_turns():
    world, _ = alone(START)
    for sign, _ in itertools.product((1.0, -1.0), range(3)):
        assert all(-math.pi < pose.theta <= math.pi for pose in drive(world, 0.1, sign * 1.9, 200))
