"""Turns on the spot end at rest at their heading, without a swing, and in good time."""

import math

import numpy as np
import pytest
from pytest import approx
from rooms import alone, drive, drove, quiet

from rumba_cleaning.behaviours.compiled_follower import STOPPING, fastest
from rumba_cleaning.behaviours.follower import Turn, turn_rate
from rumba_sim.model.common.geometry import Pose, wrap_angle

DRIVE = quiet().drive
DT, TICKS = 0.1, 5  # [s] from command to command, and ticks of the world in it


@pytest.mark.parametrize('angle', [0.05, -0.3, 1.2, -2.2, 3.1])
@pytest.mark.parametrize('ticks', [1, 5, 10])
def test_a_turn_ends_at_rest_at_its_heading_without_a_swing_and_in_good_time(angle, ticks):
    world, robot = alone(Pose(10.0, 10.0, 0.4))
    turn, most = Turn(wrap_angle(0.4 + angle), DRIVE), 0.0
    while not turn.is_done:
        rate = turn.rate(robot.pose, ticks / 50.0)
        for pose in drive(world, 0.0, rate, ticks):
            most = max(most, math.copysign(1.0, angle) * wrap_angle(pose.theta - 0.4 - angle))
        assert world.time < abs(angle) / DRIVE.max_turn_rate + 2.0 and abs(rate) <= DRIVE.max_turn_rate
    before = robot.pose
    after = list(drive(world, 0.0, 0.0, 50))[-1]
    assert most <= 0.05 and abs(wrap_angle(after.theta - 0.4 - angle)) <= 0.03
    assert abs(wrap_angle(after.theta - before.theta)) < 0.01 and after[:2] == (10.0, 10.0)


def test_a_turn_is_done_once_the_robot_rests_at_the_heading_and_not_when_it_swings_by():
    turn = Turn(1.0, DRIVE)
    for theta, is_done in ((0.9, False), (0.99, False), (1.005, False), (1.006, True), (1.2, False), (1.01, False),
                           (1.01, True)):
        rate = turn.rate(Pose(0.0, 0.0, theta), DT)
        assert turn.is_done == is_done and (rate == 0.0) == (abs(theta - 1.0) < 0.02), theta


@pytest.mark.parametrize('angle', [0.1, -1.2, 3.0])
def test_the_rate_of_a_turn_leads_to_its_angle_without_a_swing(angle):
    world, robot = alone(Pose(10.0, 10.0, 0.4))
    left = angle
    while abs(left) > 0.03:
        drove(world, 0.0, turn_rate(left, DT, DRIVE), TICKS)
        left = wrap_angle(0.4 + angle - robot.pose.theta)
        assert world.time < abs(angle) / DRIVE.max_turn_rate + 1.5 and left * angle > -0.05 * abs(angle)
    drove(world, 0.0, 0.0, 50)
    assert abs(wrap_angle(robot.pose.theta - 0.4 - angle)) <= 0.05


def test_a_turn_is_never_faster_than_the_drive_nor_so_slow_that_it_stands_still():
    for angle in np.linspace(-3.1, 3.1, 63):
        for dt in (0.0, 0.02, 0.1, 1.0):
            rate = turn_rate(angle, dt, DRIVE)
            assert rate * angle >= 0.0 and abs(rate) <= DRIVE.max_turn_rate
            assert abs(rate) * 0.5 * DRIVE.wheel_base > DRIVE.dead_band
    assert turn_rate(3.0, DT, DRIVE) == DRIVE.max_turn_rate


@pytest.mark.parametrize('distance, dt', [(0.5, 0.1), (0.02, 0.1), (0.02, 0.5), (3.0, 0.02), (1.0, 0.0)])
def test_at_the_fastest_speed_one_can_go_on_for_a_while_and_still_stop_in_time(distance, dt):
    speed = fastest(distance, dt, 0.9)
    assert speed * dt + speed ** 2 / (2.0 * STOPPING * 0.9) == approx(distance)
