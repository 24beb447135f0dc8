"""What the bumper reports about a contact: direction, sides, and number of presses."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pytest import approx
from rooms import NAMES, PLANS, RADIUS, STARTS, alone, drive, drove, quiet, room, start

from rumba_sim.model.common.geometry import Pose, wrap_angle
from rumba_sim.model.simulation.world import World

LEFT_ONLY, RIGHT_ONLY, BOTH, NONE = (True, False), (False, True), (True, True), (False, False)
AT_ONCE = {'acceleration': 1000.0}


@pytest.mark.parametrize('theta, pressed', [
    (0.0, BOTH), (0.17, BOTH), (-0.17, BOTH),
    (0.18, RIGHT_ONLY), (0.6, RIGHT_ONLY), (1.29, RIGHT_ONLY),
    (-0.18, LEFT_ONLY), (-0.6, LEFT_ONLY), (-1.29, LEFT_ONLY),
    (1.31, NONE), (-1.31, NONE)])
@pytest.mark.parametrize('wall', [0.0, math.pi / 2.0, math.pi, -math.pi / 2.0])
def test_a_wall_presses_the_side_on_which_it_lies(wall, theta, pressed):
    x, y = 2.0 + 1.8 * math.cos(wall), 2.0 + 1.8 * math.sin(wall)
    world, robot = alone(Pose(x, y, wall + theta), room(4.0, 4.0), drive=AT_ONCE)
    for _ in drive(world, 0.1, 0.0, 1000):
        if robot.contact_angle is not None:
            break
    assert robot.contact_angle == approx(-theta, abs=1e-3)
    assert robot.bumper == pressed
    assert robot.bumps == (1 if any(pressed) else 0)


@pytest.mark.parametrize('theta', [0.0, 0.5, -0.5])
def test_a_contact_behind_presses_nothing(theta):
    world, robot = alone(Pose(0.5, 0.5, theta), room(1.0, 1.0), drive=AT_ONCE)
    drove(world, -0.1, 0.0, 200)
    assert robot.contact_angle == approx(wrap_angle(math.pi - theta), abs=1e-3)
    assert robot.bumper == NONE and robot.bumps == 0


def test_far_from_obstacles_nothing_is_touched():
    world, robot = alone()
    drove(world, 0.3, 0.0, 100)
    assert (robot.contact_angle, robot.bumper, robot.bumps) == (None, NONE, 0)


def test_a_contact_counts_once_while_it_lasts_and_again_after_a_break():
    world, robot = alone(Pose(1.0, 1.0, 0.3), room(2.0, 9.0))
    for contact in (1, 2, 3):
        drove(world, 0.3, 0.0, 300)
        assert robot.bumps == contact and robot.bumper == RIGHT_ONLY
        drove(world, 0.0, 0.0, 20)
        assert robot.bumps == contact and robot.bumper == RIGHT_ONLY
        drove(world, -0.2, 0.0, 50)
        assert robot.bumps == contact and robot.bumper == NONE


def test_a_robot_that_slides_along_a_wall_keeps_its_contact():
    world, robot = alone(Pose(1.6, 1.0, 0.8), room(2.0, 9.0))
    drove(world, 0.3, 0.0, 100)
    for _ in drive(world, 0.3, 0.0, 1000):
        assert robot.bumper == RIGHT_ONLY
    assert robot.bumps == 1 and robot.pose.y > 5.0


def test_if_a_robot_turns_at_a_wall_the_contact_moves_around_it_in_the_other_direction():
    world, robot = alone(Pose(1.0, 1.0, 0.0), room(2.0, 2.0), drive=AT_ONCE)
    drove(world, 0.2, 0.0, 300)
    for pose in drive(world, 0.0, 1.0, 60):
        assert robot.contact_angle == approx(-pose.theta, abs=1e-6)
    assert robot.bumper == RIGHT_ONLY


@pytest.mark.parametrize('bearing, pressed', [
    (0.0, BOTH), (0.5, LEFT_ONLY), (-0.5, RIGHT_ONLY), (1.2, LEFT_ONLY), (-1.2, RIGHT_ONLY), (2.0, NONE), (-2.8, NONE)])
@pytest.mark.parametrize('theta', [0.0, 2.5])
def test_another_robot_presses_the_bumper_like_a_wall(bearing, pressed, theta):
    world = World(room(6.0, 6.0), quiet())
    robot = world.spawn('rumba', Pose(3.0, 3.0, theta))
    away = 2.0 * RADIUS + 0.0003
    world.spawn('other', Pose(3.0 + away * math.cos(theta + bearing), 3.0 + away * math.sin(theta + bearing), 0.7))
    world.step(10)
    assert robot.contact_angle == approx(bearing)
    assert (robot.bumper, robot.bumps) == (pressed, 1 if any(pressed) else 0)
    other = world.robots['other'].contact_angle
    assert wrap_angle(other + 0.7 - theta - bearing - math.pi) == approx(0.0, abs=1e-9)


def test_a_contact_ahead_is_reported_beside_one_with_a_wall():
    world = World(room(6.0, 2.0), quiet())
    robot = world.spawn('rumba', Pose(1.0, 0.3, -0.2))
    drove(world, 0.2, 0.0, 200)
    assert robot.contact_angle == approx(0.2 - math.pi / 2.0, abs=1e-3) and robot.bumper == NONE
    world.teleport('rumba', Pose(robot.pose.x, robot.pose.y, 0.0))
    world.spawn('other', Pose(robot.pose.x + 0.6, robot.pose.y, 1.0))
    drove(world, 0.2, 0.0, 150)
    assert robot.contact_angle == approx(0.0, abs=1e-3) and robot.bumper == BOTH


def test_two_robots_at_once_press_both_sides():
    world = World(room(6.0, 6.0), quiet())
    robot = world.spawn('rumba', Pose(3.0, 3.0, 0.0))
    away = 2.0 * RADIUS + 0.0003
    world.spawn('left', Pose(3.0 + away * math.cos(0.6), 3.0 + away * math.sin(0.6), 0.0))
    world.spawn('right', Pose(3.0 + away * math.cos(-0.9), 3.0 + away * math.sin(-0.9), 0.0))
    world.step()
    assert robot.bumper == BOTH and robot.contact_angle == approx(0.6)


@pytest.mark.parametrize('resolution', [0.02, 0.05, 0.1])
@pytest.mark.parametrize('theta', [0.2, 0.6, math.pi / 4.0, 1.0, 1.3])
def test_a_robot_that_is_stuck_in_a_corner_reports_one_contact_all_the_time(theta, resolution):
    for turn in range(4):
        world, robot = alone(Pose(1.0, 1.0, wrap_angle(theta + turn * math.pi / 2.0)), room(2.0, 2.0, resolution))
        drove(world, 0.3, 0.0, 800)
        before = robot.pose
        assert all(any(robot.bumper) for _ in drive(world, 0.3, 0.0, 50))
        assert robot.pose == approx(before, abs=3e-3) and robot.bumps == 1


@given(NAMES, st.sampled_from([10, 50]), STARTS, st.floats(0.05, 0.5), st.floats(-0.5, 0.5))
def test_a_robot_that_is_stopped_while_it_drives_forward_has_its_bumper_pressed(plan, step_rate, where, v, w):
    world, robot = alone(start(plan, where), PLANS[plan], step_rate, drive=AT_ONCE)
    before = robot.pose
    for pose in drive(world, v, w, 8 * step_rate):
        if math.hypot(pose.x - before.x, pose.y - before.y) < 0.2 * v / step_rate:
            assert any(robot.bumper) and abs(robot.contact_angle) < 1.3
        before = pose
