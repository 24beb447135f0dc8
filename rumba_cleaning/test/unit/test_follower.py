"""A robot in the world along routes: how near it keeps to them, how fast, and where it turns and ends."""

import math
from typing import NamedTuple

import numpy as np
import pytest
from floors import length, off
from pytest import approx
from rooms import alone, quiet

from rumba_cleaning.behaviours.follower import Follower
from rumba_cleaning.route import Route
from rumba_sim.model.common.geometry import Pose

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


def route(points, speeds=0.3):
    points = np.array(points, float)
    return Route(points, np.full(len(points) - 1, speeds) if np.isscalar(speeds) else np.array(speeds))


def follow(points, speeds=0.3, theta=None, shift=0.0, limit=120.0):
    """Drive along a route from its beginning, or beside it, heading along it if `theta` is None."""
    path = route(points, speeds)
    (x, y), ahead = path.waypoints[0], path.waypoints[1] - path.waypoints[0]
    world, robot = alone(Pose(x, y + shift, math.atan2(ahead[1], ahead[0]) if theta is None else theta))
    follower = Follower(path, DRIVE)
    poses, commands, remaining = [robot.pose], [], []
    while not follower.is_done:
        assert world.time < limit, f'{follower.remaining} m are left'
        commands.append(follower.velocity(robot.pose, DT))
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


def nearest(run, point):
    """How near the robot came to a point [m]."""
    return min(np.hypot(*(run.poses[:, :2] - point).T))


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
def test_a_robot_that_looks_in_the_other_direction_turns_before_it_drives(theta):
    run = follow([(10.0, 10.0), (12.0, 10.0)], theta=theta)
    turning = abs(run.poses[:, 2]) > 0.6
    assert turning.any() and max(np.hypot(*(run.poses[turning, :2] - 10.0).T)) < 1e-9
    assert math.hypot(*(run.poses[-1, :2] - (12.0, 10.0))) < 0.02
    assert run.time < 2.0 / 0.3 + abs(theta) / DRIVE.max_turn_rate + 2.0


def test_a_robot_drives_each_part_at_its_own_speed():
    run = follow([(10.0, 10.0), (11.0, 10.0), (12.0, 10.0), (13.0, 10.0)], [0.1, 0.4, 0.2])
    x = run.poses[:-1, 0]
    speed = np.hypot(*np.diff(run.poses[:, :2], axis=0).T) * 50.0
    for low, high, expected in [(10.1, 10.95, 0.1), (11.3, 11.75, 0.4), (12.3, 12.9, 0.2)]:
        assert speed[(x > low) & (x < high)] == approx(expected, abs=0.005)
    assert run.time == approx(10.0 + 2.5 + 5.0, abs=1.0)


def test_no_limit_of_the_drive_nor_speed_of_a_part_is_exceeded():
    points = [(10.0, 10.0), (11.0, 10.0), (11.0, 11.0), (10.9, 11.0), (10.9, 10.2), (10.0, 10.0), (11.0, 10.4)]
    for speed in (0.2, DRIVE.max_speed):
        run = follow(points, speed, theta=2.0)
        assert run.commands[:, 0].min() >= 0.0 and run.commands[:, 0].max() == approx(speed)
        assert abs(run.commands[:, 1]).max() <= DRIVE.max_turn_rate + 1e-9
        assert math.hypot(*(run.poses[-1, :2] - points[-1])) < 0.02
    run = follow([(10.0, 10.0), (13.0, 10.0)], 2.0)
    assert run.commands[:, 0].max() == DRIVE.max_speed and math.hypot(*(run.poses[-1, :2] - (13.0, 10.0))) < 0.02


def test_a_robot_that_is_turned_around_on_its_route_turns_back_before_it_drives_on():
    world, robot = alone(Pose(10.0, 10.0, 0.0))
    follower = Follower(route([(10.0, 10.0), (12.0, 10.0)]), DRIVE)
    poses = []
    while not follower.is_done:
        if world.tick == 100:
            world.teleport('rumba', robot.pose._replace(theta=3.0))
        poses += drive(world, robot, follower.velocity(robot.pose, DT), TICKS)
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
    assert max(away) < 0.16 * speed and nearest(run, (12.0, 10.0)) < 0.05
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
    points = [(10.0 + 0.6 * (index % 2), 10.0 + 0.03 * index) for index in range(6)]
    run = follow(points)
    for point in points[1:]:
        assert nearest(run, point) < 0.02
    assert run.remaining[0] == approx(length(points))


@BOTH_SPEEDS
def test_a_closed_loop_does_not_end_where_it_begins(speed):
    loop = [(10.0, 10.0), (11.0, 10.0), (11.0, 11.0), (10.0, 11.0), (10.0, 10.0)]
    run = follow(loop, speed)
    for point in loop:
        assert nearest(run, point) < 0.05
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
    for _ in range(20):
        lengths = generator.choice([0.02, 0.03, 0.05, 0.1, 0.3], 5)
        headings = np.cumsum(generator.uniform(-3.0, 3.0, 5))
        legs = lengths[:, np.newaxis] * np.stack([np.cos(headings), np.sin(headings)], axis=1)
        follow(np.concatenate([[[10.0, 10.0]], 10.0 + np.cumsum(legs, axis=0)]), limit=30.0)


# --- what is left --------------------------------------------------------------------------------------------------

ZIGZAG = [(10.0, 10.0), (12.0, 10.0), (12.0, 11.0), (11.99, 10.0), (10.0, 10.5), (10.0, 10.5), (11.0, 10.0)]


@BOTH_SPEEDS
def test_the_distance_that_remains_shrinks_from_its_length_to_nothing(speed):
    run = follow(ZIGZAG, speed)
    assert run.remaining[0] == approx(length(ZIGZAG)) and run.remaining[-1] == 0.0
    assert (np.diff(run.remaining) <= 1e-12).all() and max(-np.diff(run.remaining)) < 0.12


def test_the_rest_holds_the_waypoints_and_speeds_that_are_still_to_come():
    speeds = np.array([0.31, 0.32, 0.33, 0.34, 0.35, 0.36])
    follower = Follower(route(ZIGZAG, speeds), DRIVE)
    world, robot = alone(Pose(10.0, 10.0, 0.0))
    lengths = set()
    while not follower.is_done and follower.rest() is not None:
        command = follower.velocity(robot.pose, DT)
        rest = follower.rest()
        drive(world, robot, command, TICKS)
        if rest is None:
            break
        count = len(rest.waypoints)
        lengths.add(count)
        assert (rest.waypoints == np.array(ZIGZAG)[[1, 2, 3, 4, 6]][-count:]).all()
        assert rest.speeds.tolist() == speeds[[1, 2, 3, 5]][5 - count:].tolist()
        assert length(rest.waypoints) <= follower.remaining + 1e-9
        assert follower.remaining - length(rest.waypoints) == approx(
            math.hypot(*(rest.waypoints[0] - robot.pose[:2])), abs=0.15)
    assert lengths == {1, 2, 3, 4, 5}


def test_the_rest_from_here_begins_at_the_point_that_was_reached():
    speeds = np.array([0.31, 0.32, 0.33, 0.34, 0.35, 0.36])
    follower = Follower(route(ZIGZAG, speeds), DRIVE)
    world, robot = alone(Pose(10.0, 10.0, 0.0))
    while follower.rest() is not None:
        command = follower.velocity(robot.pose, DT)
        rest, from_here = follower.rest(), follower.rest_from_here()
        drive(world, robot, command, TICKS)
        if rest is None:
            break
        assert (from_here.waypoints[1:] == rest.waypoints).all() and (from_here.speeds[1:] == rest.speeds).all()
        assert length(from_here.waypoints) == approx(follower.remaining)
        assert from_here.speeds.tolist() == speeds[[0, 1, 2, 3, 5]][5 - len(rest.waypoints):].tolist()
    assert follower.rest_from_here() is None


def test_nothing_is_left_of_a_route_that_is_done():
    follower = Follower(route([(10.0, 10.0), (10.5, 10.0)]), DRIVE)
    assert not follower.is_done and follower.remaining == approx(0.5)
    assert follower.velocity(Pose(10.4, 10.0, 0.0), DT)[0] > 0.0 and not follower.is_done
    assert follower.velocity(Pose(10.5, 10.0, 0.0), DT) == (0.0, 0.0)
    assert follower.is_done and follower.remaining == 0.0 and follower.rest() is None


def test_a_route_of_one_and_the_same_point_is_done_at_once():
    follower = Follower(route([(10.0, 10.0), (10.0, 10.0), (10.0, 10.0)]), DRIVE)
    assert follower.velocity(Pose(10.0, 10.0, 1.0), DT) == (0.0, 0.0)
    assert follower.is_done and not follower.is_lost and follower.remaining == 0.0 and follower.rest() is None


def test_a_robot_that_is_put_elsewhere_is_lost_and_one_that_is_pushed_is_not():
    for shift, is_lost in ((1.0, True), (-0.4, True), (0.3, False)):
        follower = Follower(route([(10.0, 10.0), (14.0, 10.0)]), DRIVE)
        world, robot = alone(Pose(10.0, 10.0, 0.0))
        for _ in range(30):
            drive(world, robot, follower.velocity(robot.pose, DT), TICKS)
            assert not follower.is_lost
        world.teleport('rumba', Pose(robot.pose.x, 10.0 + shift, 0.0))
        follower.velocity(robot.pose, DT)
        assert follower.is_lost == is_lost


def test_a_robot_that_is_put_onto_a_later_part_of_its_route_is_lost_and_found_again_where_it_was():
    follower = Follower(route([(10.0 + 0.1 * index, 10.0) for index in range(41)]), DRIVE)
    follower.velocity(Pose(10.0, 10.0, 0.0), DT)
    before = follower.remaining
    follower.velocity(Pose(13.0, 10.0, 0.0), DT)
    assert follower.is_lost and before - follower.remaining < 0.5
    follower.velocity(Pose(10.5, 10.1, 0.0), DT)
    assert not follower.is_lost and follower.remaining == approx(3.5)


def test_a_route_that_crosses_itself_is_driven_in_its_order():
    points = [(10.0, 10.0), (11.5, 11.5), (11.5, 10.0), (10.0, 11.5)]
    run = follow(points)
    seen = [int(np.argmin(np.hypot(*(run.poses[:, :2] - point).T))) for point in points]
    assert seen == sorted(seen) and max(nearest(run, point) for point in points) < 0.05
    assert run.time > length(points) / 0.3
