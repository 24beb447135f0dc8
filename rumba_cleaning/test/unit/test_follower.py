"""A robot in the world along routes: how near it keeps to them, how fast, and where it turns and ends."""

import math
from typing import NamedTuple

import numpy as np
import pytest
from floors import length, off
from pytest import approx
from rooms import alone, quiet

from rumba_cleaning.behaviours.follower import TENDERNESS, Follower, Route, Turn, fastest, turn_rate
from rumba_sim.model.geometry import Pose, wrap_angle

DRIVE = quiet().drive
DT, TICKS = 0.1, 5  # [s] from command to command, and ticks of the world in it
LANE = 0.17  # [m] from lane to lane
BOTH_SPEEDS = pytest.mark.parametrize('speed', [0.3, 0.45])


class Run(NamedTuple):
    """What a robot did along a route."""

    poses: np.ndarray  # x, y, theta in each tick, until it stands
    commands: np.ndarray  # v, w
    remaining: np.ndarray  # [m] at each command
    time: float  # [s] until the route is done


def route(places, speeds=0.3):
    places = np.array(places, float)
    return Route(places, np.full(len(places) - 1, speeds) if np.isscalar(speeds) else np.array(speeds))


def follow(places, speeds=0.3, theta=None, shift=0.0, limit=120.0):
    """Drive along a route from its beginning, or beside it, heading along it where `theta` is None."""
    way = route(places, speeds)
    (x, y), ahead = way.places[0], way.places[1] - way.places[0]
    world, robot = alone(Pose(x, y + shift, math.atan2(ahead[1], ahead[0]) if theta is None else theta))
    follower = Follower(way, DRIVE)
    poses, commands, remaining = [robot.pose], [], []
    while not follower.is_done:
        assert world.time < limit, f'{follower.remaining} m are left'
        commands.append(follower.update(robot.pose, DT))
        remaining.append(follower.remaining)
        assert not follower.is_lost
        poses += drive(world, robot, commands[-1], TICKS)
    time = world.time - DT
    poses += drive(world, robot, (0.0, 0.0), 40)
    return Run(np.array(poses), np.array(commands), np.array(remaining), time)


def drive(world, robot, command, ticks):
    """The poses in so many ticks of one command."""
    poses = []
    for _ in range(ticks):
        robot.command(*command, world.tick)
        world.step()
        poses.append(robot.pose)
    return poses


def nearest(run, place):
    """How near the robot came to a place [m]."""
    return min(np.hypot(*(run.poses[:, :2] - place).T))


# --- lines ---------------------------------------------------------------------------------------------------------

@pytest.mark.parametrize('theta', [0.0, 0.7, -2.5])
@pytest.mark.parametrize('speed', [0.1, 0.3, 0.5])
def test_a_straight_line_is_driven_straight_to_its_end_and_at_its_speed(speed, theta):
    start, end = np.array([10.0, 10.0]), np.array([10.0 + 3.0 * math.cos(theta), 10.0 + 3.0 * math.sin(theta)])
    run = follow([start, end], speed)
    assert math.hypot(*(run.poses[-1, :2] - end)) < 0.02
    assert max(off(run.poses[:, :2], start, end)) < 0.01
    assert run.time == approx(3.0 / speed + speed / DRIVE.acceleration, abs=0.3)


@pytest.mark.parametrize('shift, theta', [(0.1, 0.0), (-0.1, 0.0), (0.0, 1.0), (0.05, -1.2)])
def test_a_robot_beside_its_route_comes_onto_it(shift, theta):
    run = follow([(10.0, 10.0), (12.0, 10.0)], theta=theta, shift=shift)
    on = run.poses[run.poses[:, 0] > 10.8]
    assert max(abs(on[:, 1] - 10.0)) < 0.01 and math.hypot(*(run.poses[-1, :2] - (12.0, 10.0))) < 0.02


@pytest.mark.parametrize('theta', [math.pi, 2.3, -2.8])
def test_a_robot_that_looks_the_other_way_turns_before_it_drives(theta):
    run = follow([(10.0, 10.0), (12.0, 10.0)], theta=theta)
    turning = abs(run.poses[:, 2]) > 0.6
    assert turning.any() and max(np.hypot(*(run.poses[turning, :2] - 10.0).T)) < 1e-9
    assert math.hypot(*(run.poses[-1, :2] - (12.0, 10.0))) < 0.02
    assert run.time < 2.0 / 0.3 + abs(theta) / DRIVE.max_turn_rate + 2.0


def test_a_robot_drives_each_part_at_its_own_speed():
    run = follow([(10.0, 10.0), (11.0, 10.0), (12.0, 10.0), (13.0, 10.0)], [0.1, 0.4, 0.2])
    x = run.poses[:-1, 0]
    speed = np.hypot(*np.diff(run.poses[:, :2], axis=0).T) * 50.0
    for low, high, expected in [(10.1, 10.95, 0.1), (11.3, 11.9, 0.4), (12.3, 12.9, 0.2)]:
        assert speed[(x > low) & (x < high)] == approx(expected, abs=0.005)
    assert run.time == approx(10.0 + 2.5 + 5.0, abs=1.0)


def test_no_limit_of_the_drive_nor_speed_of_a_part_is_exceeded():
    places = [(10.0, 10.0), (11.0, 10.0), (11.0, 11.0), (10.9, 11.0), (10.9, 10.2), (10.0, 10.0), (11.0, 10.4)]
    for speed in (0.2, DRIVE.max_speed):
        run = follow(places, speed, theta=2.0)
        assert run.commands[:, 0].min() >= 0.0 and run.commands[:, 0].max() == approx(speed)
        assert abs(run.commands[:, 1]).max() <= DRIVE.max_turn_rate + 1e-9
        assert math.hypot(*(run.poses[-1, :2] - places[-1])) < 0.02
    run = follow([(10.0, 10.0), (13.0, 10.0)], 2.0)
    assert run.commands[:, 0].max() == DRIVE.max_speed and math.hypot(*(run.poses[-1, :2] - (13.0, 10.0))) < 0.02


def test_a_robot_that_is_turned_around_on_its_way_turns_back_before_it_drives_on():
    world, robot = alone(Pose(10.0, 10.0, 0.0))
    follower = Follower(route([(10.0, 10.0), (12.0, 10.0)]), DRIVE)
    poses = []
    while not follower.is_done:
        if world.tick == 100:
            world.teleport('rumba', robot.pose._replace(theta=3.0))
        poses += drive(world, robot, follower.update(robot.pose, DT), TICKS)
        assert world.time < 15.0
    poses = np.array(poses)
    turning = (abs(poses[:, 2]) > 0.7)
    assert np.hypot(*np.ptp(poses[turning, :2], axis=0)) < 1e-9 and max(abs(poses[:, 1] - 10.0)) < 0.03


# --- bends and corners ---------------------------------------------------------------------------------------------

@pytest.mark.parametrize('side', [1.0, -1.0])
def test_after_a_half_circle_the_next_lane_is_met(side):
    radius = 0.5 * LANE
    bend = [(12.0 + radius * math.sin(angle), 10.0 + side * radius * (1.0 - math.cos(angle)))
            for angle in np.linspace(0.0, math.pi, 9)]
    end = (10.5, 10.0 + side * LANE)
    run = follow([(10.5, 10.0), *bend, end])
    turn = int(np.argmax(run.poses[:, 0]))
    assert max(abs(run.poses[:turn, 1] - 10.0)[run.poses[:turn, 0] < 11.9]) < 0.01
    assert run.poses[turn, 0] == approx(12.0 + radius, abs=0.03)
    back = run.poses[turn:]
    assert max(abs(back[back[:, 0] < 11.7, 1] - end[1])) < 0.01
    assert max(abs(back[:, 1] - end[1])[back[:, 0] < 12.0]) < 0.03
    assert math.hypot(*(run.poses[-1, :2] - end)) < 0.02 and run.time < 3.27 / 0.3 + 3.0


@pytest.mark.parametrize('side', [1.0, -1.0])
@BOTH_SPEEDS
def test_a_right_angle_is_cut_by_little_and_left_on_the_line(speed, side):
    end = (12.0, 10.0 + 2.0 * side)
    run = follow([(10.0, 10.0), (12.0, 10.0), end], speed)
    away = np.minimum(off(run.poses[:, :2], (10.0, 10.0), (12.0, 10.0)), off(run.poses[:, :2], (12.0, 10.0), end))
    assert max(away) < 0.15 * speed and nearest(run, (12.0, 10.0)) < 0.05
    after = run.poses[abs(run.poses[:, 1] - 10.0) > 0.6]
    assert max(abs(after[:, 0] - 12.0)) < 0.01 and math.hypot(*(run.poses[-1, :2] - end)) < 0.02
    assert run.time < 4.0 / speed + 2.0


@BOTH_SPEEDS
def test_a_hairpin_is_driven_to_its_end_before_the_robot_turns(speed):
    run = follow([(10.0, 10.0), (12.0, 10.0), (10.2, 10.1)], speed)
    assert run.poses[:, 0].max() == approx(12.0, abs=0.02) and nearest(run, (12.0, 10.0)) < 0.01
    turned = np.flatnonzero(abs(run.poses[:, 2]) > 0.3)[0]
    assert run.poses[turned, 0] == approx(12.0, abs=0.02)
    assert max(off(run.poses[turned:, :2], (12.0, 10.0), (10.2, 10.1))) < 0.12 * speed
    assert math.hypot(*(run.poses[-1, :2] - (10.2, 10.1))) < 0.02


def test_each_of_many_hairpins_is_driven_to_its_end():
    places = [(10.0 + 0.6 * (index % 2), 10.0 + 0.03 * index) for index in range(6)]
    run = follow(places)
    for place in places[1:]:
        assert nearest(run, place) < 0.02
    assert run.remaining[0] == approx(length(places))


@BOTH_SPEEDS
def test_a_closed_loop_does_not_end_where_it_begins(speed):
    loop = [(10.0, 10.0), (11.0, 10.0), (11.0, 11.0), (10.0, 11.0), (10.0, 10.0)]
    run = follow(loop, speed)
    for place in loop:
        assert nearest(run, place) < 0.05
    assert math.hypot(*(run.poses[-1, :2] - (10.0, 10.0))) < 0.02
    assert 3.9 / speed < run.time < 4.0 / speed + 3.0


def test_a_small_circle_is_driven_all_around():
    angles = np.linspace(0.0, 2.0 * math.pi, 41)
    run = follow(np.stack([10.0 + 0.3 * np.sin(angles), 10.3 - 0.3 * np.cos(angles)], axis=1))
    away = np.hypot(run.poses[:, 0] - 10.0, run.poses[:, 1] - 10.3)
    assert max(abs(away - 0.3)) < 0.03 and sum(np.diff(np.unwrap(run.poses[:, 2]))) == approx(2.0 * math.pi, abs=0.3)


def test_the_shortest_legs_around_the_sharpest_corners_come_to_an_end():
    follow([(10.0, 10.0), (10.3, 10.0), (10.322, 10.056), (10.305, 10.045)], limit=10.0)
    generator = np.random.default_rng(5)
    for _ in range(40):
        lengths = generator.choice([0.02, 0.03, 0.05, 0.1, 0.3], 5)
        headings = np.cumsum(generator.uniform(-3.0, 3.0, 5))
        legs = lengths[:, np.newaxis] * np.stack([np.cos(headings), np.sin(headings)], axis=1)
        follow(np.concatenate([[[10.0, 10.0]], 10.0 + np.cumsum(legs, axis=0)]), limit=30.0)


# --- what is left --------------------------------------------------------------------------------------------------

ZIGZAG = [(10.0, 10.0), (12.0, 10.0), (12.0, 11.0), (11.99, 10.0), (10.0, 10.5), (10.0, 10.5), (11.0, 10.0)]


@BOTH_SPEEDS
def test_the_way_that_remains_shrinks_from_its_length_to_nothing(speed):
    run = follow(ZIGZAG, speed)
    assert run.remaining[0] == approx(length(ZIGZAG)) and run.remaining[-1] == 0.0
    assert (np.diff(run.remaining) <= 1e-12).all() and max(-np.diff(run.remaining)) < 0.12


def test_the_rest_holds_the_places_and_speeds_that_are_still_to_come():
    speeds = np.array([0.31, 0.32, 0.33, 0.34, 0.35, 0.36])
    follower = Follower(route(ZIGZAG, speeds), DRIVE)
    world, robot = alone(Pose(10.0, 10.0, 0.0))
    lengths = set()
    while not follower.is_done and follower.rest() is not None:
        command = follower.update(robot.pose, DT)
        rest = follower.rest()
        drive(world, robot, command, TICKS)
        if rest is None:
            break
        count = len(rest.places)
        lengths.add(count)
        assert (rest.places == np.array(ZIGZAG)[[1, 2, 3, 4, 6]][-count:]).all()
        assert rest.speeds.tolist() == speeds[[1, 2, 3, 5]][5 - count:].tolist()
        assert length(rest.places) <= follower.remaining + 1e-9
        assert follower.remaining - length(rest.places) == approx(
            math.hypot(*(rest.places[0] - robot.pose[:2])), abs=0.15)
    assert lengths == {1, 2, 3, 4, 5}


def test_nothing_is_left_of_a_route_that_is_done():
    follower = Follower(route([(10.0, 10.0), (10.5, 10.0)]), DRIVE)
    assert not follower.is_done and follower.remaining == approx(0.5)
    assert follower.update(Pose(10.4, 10.0, 0.0), DT)[0] > 0.0 and not follower.is_done
    assert follower.update(Pose(10.5, 10.0, 0.0), DT) == (0.0, 0.0)
    assert follower.is_done and follower.remaining == 0.0 and follower.rest() is None


def test_a_route_of_one_and_the_same_place_is_done_at_once():
    follower = Follower(route([(10.0, 10.0), (10.0, 10.0), (10.0, 10.0)]), DRIVE)
    assert follower.update(Pose(10.0, 10.0, 1.0), DT) == (0.0, 0.0)
    assert follower.is_done and not follower.is_lost and follower.remaining == 0.0 and follower.rest() is None


def test_a_robot_that_is_put_elsewhere_is_lost_and_one_that_is_pushed_is_not():
    for shift, is_lost in ((1.0, True), (-0.4, True), (0.3, False)):
        follower = Follower(route([(10.0, 10.0), (14.0, 10.0)]), DRIVE)
        world, robot = alone(Pose(10.0, 10.0, 0.0))
        for _ in range(30):
            drive(world, robot, follower.update(robot.pose, DT), TICKS)
            assert not follower.is_lost
        world.teleport('rumba', Pose(robot.pose.x, 10.0 + shift, 0.0))
        follower.update(robot.pose, DT)
        assert follower.is_lost == is_lost


def test_a_robot_that_is_put_onto_a_later_part_of_its_route_is_lost_and_found_again_where_it_was():
    follower = Follower(route([(10.0 + 0.1 * index, 10.0) for index in range(41)]), DRIVE)
    follower.update(Pose(10.0, 10.0, 0.0), DT)
    before = follower.remaining
    follower.update(Pose(13.0, 10.0, 0.0), DT)
    assert follower.is_lost and before - follower.remaining < 0.5
    follower.update(Pose(10.5, 10.1, 0.0), DT)
    assert not follower.is_lost and follower.remaining == approx(3.5)


def test_a_route_that_crosses_itself_is_driven_in_its_order():
    places = [(10.0, 10.0), (11.5, 11.5), (11.5, 10.0), (10.0, 11.5)]
    run = follow(places)
    seen = [int(np.argmin(np.hypot(*(run.poses[:, :2] - place).T))) for place in places]
    assert seen == sorted(seen) and max(nearest(run, place) for place in places) < 0.05
    assert run.time > length(places) / 0.3


# --- turns on the spot ---------------------------------------------------------------------------------------------

@pytest.mark.parametrize('angle', [0.05, -0.3, 1.2, -2.2, 3.1])
@pytest.mark.parametrize('ticks', [1, 5, 10])
def test_a_turn_ends_at_rest_at_its_heading_without_a_swing_and_in_good_time(angle, ticks):
    world, robot = alone(Pose(10.0, 10.0, 0.4))
    turn, most = Turn(wrap_angle(0.4 + angle), DRIVE), 0.0
    while not turn.is_done:
        rate = turn.update(robot.pose, ticks / 50.0)
        for pose in drive(world, robot, (0.0, rate), ticks):
            most = max(most, math.copysign(1.0, angle) * wrap_angle(pose.theta - 0.4 - angle))
        assert world.time < abs(angle) / DRIVE.max_turn_rate + 2.0 and abs(rate) <= DRIVE.max_turn_rate
    before = robot.pose
    after = drive(world, robot, (0.0, 0.0), 50)[-1]
    assert most <= 0.05 and abs(wrap_angle(after.theta - 0.4 - angle)) <= 0.03
    assert abs(wrap_angle(after.theta - before.theta)) < 0.01 and after[:2] == (10.0, 10.0)


def test_a_turn_is_done_once_the_robot_rests_at_the_heading_and_not_when_it_swings_by():
    turn = Turn(1.0, DRIVE)
    for theta, is_done in ((0.9, False), (0.99, False), (1.005, False), (1.006, True), (1.2, False), (1.01, False),
                           (1.01, True)):
        rate = turn.update(Pose(0.0, 0.0, theta), DT)
        assert turn.is_done == is_done and (rate == 0.0) == (abs(theta - 1.0) < 0.02), theta


@pytest.mark.parametrize('angle', [0.1, -1.2, 3.0])
def test_the_rate_of_a_turn_leads_to_its_angle_without_a_swing(angle):
    world, robot = alone(Pose(10.0, 10.0, 0.4))
    left = angle
    while abs(left) > 0.03:
        drive(world, robot, (0.0, turn_rate(left, DT, DRIVE)), TICKS)
        left = wrap_angle(0.4 + angle - robot.pose.theta)
        assert world.time < abs(angle) / DRIVE.max_turn_rate + 1.5 and left * angle > -0.05 * abs(angle)
    drive(world, robot, (0.0, 0.0), 50)
    assert abs(wrap_angle(robot.pose.theta - 0.4 - angle)) <= 0.05


def test_a_turn_is_never_faster_than_the_drive_nor_so_slow_that_it_stands_still():
    for angle in np.linspace(-3.1, 3.1, 63):
        for dt in (0.0, 0.02, 0.1, 1.0):
            rate = turn_rate(angle, dt, DRIVE)
            assert rate * angle >= 0.0 and abs(rate) <= DRIVE.max_turn_rate
            assert abs(rate) * 0.5 * DRIVE.wheel_base > DRIVE.dead_band
    assert turn_rate(3.0, DT, DRIVE) == DRIVE.max_turn_rate


@pytest.mark.parametrize('way, dt', [(0.5, 0.1), (0.02, 0.1), (0.02, 0.5), (3.0, 0.02), (1.0, 0.0)])
def test_at_the_fastest_speed_one_can_go_on_for_a_while_and_still_stop_in_time(way, dt):
    speed = fastest(way, dt, 0.9)
    assert speed * dt + speed ** 2 / (2.0 * TENDERNESS * 0.9) == approx(way)
