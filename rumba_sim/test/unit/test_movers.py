"""Movers and doors: where they are when, that they wait for robots, and that a world with them repeats."""

import math

import numpy as np
import pytest
from pytest import approx
from rooms import RADIUS, crooked, drive, drove, quiet, room
from things import LOW, box, disc, gaps, walker

from rumba_sim.model.common.config import updated
from rumba_sim.model.common.errors import WorldError
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation.obstacle import Obstacle, door, walk
from rumba_sim.model.simulation.world import World

HALL = room(6.0, 5.0)
GAP = 0.0006  # [m] at most between two that touch


def track(obstacle, seconds, seed=0, step_rate=50):
    """Where a mover is after each tick without robots, as (x, y, theta) [m, rad]."""
    world = World(HALL, quiet(), step_rate, seed, [obstacle])
    poses = []
    for _ in range(round(seconds * step_rate)):
        world.step()
        poses.append(tuple(next(world.obstacles.poses())[1]))
    return np.array(poses)


def test_a_mover_goes_back_and_forth_at_its_speed():
    poses = track(walker('cat', [(1.0, 1.0), (3.0, 1.0), (3.0, 2.0)], 0.5), 12.0)
    for seconds, place in ((2.0, (2.0, 1.0)), (4.0, (3.0, 1.0)), (5.0, (3.0, 1.5)), (6.0, (3.0, 2.0)),
                           (7.0, (3.0, 1.5)), (10.0, (2.0, 1.0)), (12.0, (1.0, 1.0))):
        assert tuple(poses[round(50 * seconds) - 1][:2]) == approx(place, abs=1e-9), seconds


def test_a_mover_in_a_loop_goes_from_the_last_waypoint_to_the_first():
    poses = track(walker('cat', [(1.0, 1.0), (3.0, 1.0), (3.0, 2.5)], 0.5, is_loop=True), 12.0)
    assert tuple(poses[round(50 * 7.0) - 1][:2]) == approx((3.0, 2.5), abs=1e-9)
    assert tuple(poses[round(50 * 9.5) - 1][:2]) == approx((2.0, 1.75), abs=1e-9)
    assert tuple(poses[599][:2]) == approx((1.0, 1.0), abs=1e-9)


@pytest.mark.parametrize('speed, step_rate', [(0.37, 50), (1.6, 10), (0.013, 100)])
def test_no_step_of_a_mover_is_longer_than_its_speed_allows(speed, step_rate):
    poses = track(walker('cat', [(1.0, 1.0), (1.7, 1.3), (1.2, 2.0)], speed), 30.0, step_rate=step_rate)
    assert np.hypot(*np.diff(poses[:, :2], axis=0).T).max() * step_rate <= speed * (1.0 + 1e-9)


def test_a_turning_box_takes_the_shorter_way_round():
    poses = track(walker('crate', [(1.0, 1.0, 3.0), (2.0, 1.0, -3.0)], 0.5, size=(0.4, 0.1)), 2.0)
    assert poses[49, 2] == approx(math.pi, abs=1e-6) or poses[49, 2] == approx(-math.pi, abs=1e-6)
    assert poses[99, 2] == approx(-3.0)


def pauses(seed, name='cat'):
    """How long a mover stands at each of its first stops [s]."""
    moving = np.hypot(*np.diff(track(walker(name, [(1.0, 1.0), (1.5, 1.0)], 0.5, pause=(0.5, 3.0)), 60.0, seed)[
        :, :2], axis=0).T) > 1e-9
    ends = np.flatnonzero(np.diff(moving.astype(int)))
    return [(end - begin) / 50.0 for begin, end in zip(ends[1::2], ends[2::2])]


def test_pauses_are_drawn_from_the_seed_and_the_name_within_their_limits():
    first = pauses(1)
    assert len(first) > 10 and 0.4 < min(first) < 1.3 and 2.2 < max(first) < 3.1
    assert first == pauses(1) and first != pauses(2) and first != pauses(1, 'dog')


def test_a_door_opens_and_closes_by_its_schedule():
    shut, wide = Pose(3.0, 1.0, 0.0), Pose(3.4, 1.4, math.pi / 2.0)
    poses = track(Obstacle('door', shut, 2.0, length=0.8, width=0.04, stops=door(shut, wide, 4.0, 3.0, 2.0)), 22.0)
    for seconds, pose in ((4.0, shut), (5.0, (3.2, 1.2, math.pi / 4.0)), (6.0, wide), (9.0, wide), (10.0, (
            3.2, 1.2, math.pi / 4.0)), (11.0, shut), (15.0, shut), (16.0, (3.2, 1.2, math.pi / 4.0)), (17.0, wide)):
        assert tuple(poses[round(50 * seconds) - 1]) == approx(tuple(pose), abs=1e-6), seconds


# --- movers and robots --------------------------------------------------------------------------------------------

@pytest.mark.parametrize('theta, pressed', [(0.0, (True, True)), (0.6, (False, True)), (-0.6, (True, False)),
                                            (math.pi, (False, False))])
@pytest.mark.parametrize('height', [0.5, LOW])
def test_a_mover_that_meets_a_robot_presses_its_bumper_and_waits(theta, pressed, height):
    world = World(HALL, quiet(), obstacles=[walker('cat', [(4.0, 2.0), (1.0, 2.0)], 0.5, 0.15, height=height)])
    robot = world.spawn('rumba', Pose(2.0, 2.0, theta))
    world.step(300)
    assert robot.pose == Pose(2.0, 2.0, theta)
    assert 0.0 <= gaps(world)[0] < GAP and robot.bumper == pressed and robot.bumps == int(any(pressed))
    assert robot.contact_angle == approx(-theta if theta < 3.0 else math.pi, abs=1e-9)


def test_a_mover_that_would_crush_a_robot_against_a_wall_waits_and_goes_on_when_the_robot_has_left():
    crate = walker('crate', [(2.0, 2.5, -0.3), (0.2, 2.5, -0.3)], 0.8, size=(0.3, 1.0))
    world = World(HALL, quiet(), obstacles=[crate])
    robot = world.spawn('rumba', Pose(RADIUS + 0.01, 2.5, math.pi / 2.0))
    world.step(200)
    assert robot.pose == Pose(RADIUS + 0.01, 2.5, math.pi / 2.0) and 0.0 <= gaps(world)[0] < GAP
    least = min(next(world.obstacles.poses())[1].x for _ in drive(world, 0.3, 0.0, 200))
    assert robot.pose.y > 3.0 and least == approx(0.2)


def test_a_door_waits_for_a_robot_that_stands_in_it():
    shut, wide = Pose(3.0, 2.5, math.pi / 2.0), Pose(3.0, 3.5, math.pi / 2.0)
    leaf = Obstacle('door', wide, 2.0, length=0.9, width=0.04, stops=door(wide, shut, 1.0, 1.0, 2.0))
    world = World(HALL, quiet(), obstacles=[leaf])
    robot = world.spawn('rumba', Pose(3.0, 2.4, 0.0))
    world.step(250)
    assert robot.pose == Pose(3.0, 2.4, 0.0) and 0.0 <= gaps(world)[0] < GAP
    drove(world, 0.4, 0.0, 120)
    assert robot.pose.x > 3.5 and next(world.obstacles.poses())[1].y == approx(2.5)


def test_a_mover_that_has_waited_for_five_seconds_turns_back_pauses_and_tries_again():
    world = World(HALL, quiet(), obstacles=[walker('cat', [(4.0, 2.0), (1.0, 2.0)], 0.5, 0.15, pause=(1.0, 1.0))])
    robot = world.spawn('rumba', Pose(2.0, 2.0, 0.0))
    places = []
    for _ in range(1000):
        world.step()
        places.append(next(world.obstacles.poses())[1].x)
    contact = 2.0 + RADIUS + 0.15
    meets = 1.0 + (4.0 - contact) / 0.5  # [s]
    for seconds, place in ((meets, contact), (meets + 4.9, contact), (meets + 6.0, contact + 0.5),
                           (2.0 * meets + 4.0, 4.0), (2.0 * meets + 5.0, 4.0), (2.0 * meets + 6.0, 3.5),
                           (3.0 * meets + 5.0, contact)):
        assert places[round(50 * seconds)] == approx(place, abs=0.03), seconds
    assert robot.pose == Pose(2.0, 2.0, 0.0) and robot.bumps == 2


def test_a_mover_that_meets_the_same_robot_again_goes_back_farther_each_time_until_it_has_passed():
    stops = [(5.0, 2.0), (4.0, 2.0), (3.0, 2.0), (1.0, 2.0)]
    world = World(HALL, quiet(), obstacles=[walker('cat', stops, 0.5, 0.15, pause=(1.0, 1.0))])
    robot = world.spawn('rumba', Pose(2.0, 2.0, 0.0))
    contact = 2.0 + RADIUS + 0.15
    assert turns(world, 100.0)[:8] == approx([contact, 3.0, contact, 4.0, contact, 5.0, contact, 5.0], abs=0.02)
    assert robot.pose == Pose(2.0, 2.0, 0.0)
    world.teleport('rumba', Pose(2.0, 4.0, 0.0))
    assert min(turns(world, 25.0)) == approx(1.0)
    world.teleport('rumba', Pose(2.0, 2.0, 0.0))
    assert turns(world, 40.0)[:4] == approx([contact, 3.0, contact, 4.0], abs=0.02)


def test_a_mover_that_meets_a_robot_on_the_first_part_of_its_way_pauses_at_its_end_each_time():
    stops = [(4.0, 2.0), (1.0, 2.0), (1.0, 4.0)]
    world = World(HALL, quiet(), obstacles=[walker('cat', stops, 0.5, 0.15, pause=(10.0, 10.0))])
    world.spawn('rumba', Pose(2.0, 2.0, 0.0))
    places = []
    for _ in range(50 * 100):
        world.step()
        places.append(next(world.obstacles.poses())[1].x)
    touching = np.array(places) < 2.0 + RADIUS + 0.15 + 0.01
    met = np.flatnonzero(touching[1:] & ~touching[:-1]) / 50.0  # [s]
    cycle = 2.0 * (2.0 - RADIUS - 0.15) / 0.5 + 5.0 + 10.0
    assert np.diff(met) == approx(cycle, abs=0.1) and len(met) == int((100.0 - met[0]) / cycle) + 1


def test_a_mover_in_a_loop_goes_back_by_half_of_it_at_most_so_that_it_does_not_meet_the_robot_from_behind():
    loop = [(1.0, 1.0), (4.0, 1.0), (4.0, 4.0), (1.0, 4.0)]
    world = World(HALL, quiet(), obstacles=[walker('cat', loop, 1.0, 0.15, is_loop=True)])
    robot = world.spawn('rumba', Pose(2.5, 1.0, 0.0))
    places = []
    for _ in range(50 * 120):
        world.step()
        pose = next(world.obstacles.poses())[1]
        places.append((pose.x, pose.y))
    ways = np.array(places)
    assert ways[:, 0].max() == approx(2.5 - RADIUS - 0.15, abs=0.02) and ways[:, 1].max() == approx(4.0)
    assert robot.pose == Pose(2.5, 1.0, 0.0)


def turns(world, seconds):
    """Where along x the one mover of a world turned round [m]."""
    places = [next(world.obstacles.poses())[1].x for _ in range(round(50 * seconds)) if world.step() is None]
    moves = [place for place, before in zip(places[1:], places) if place != before]
    return [here for before, here, after in zip(moves, moves[1:], moves[2:]) if (here - before) * (after - here) < 0.0]


def test_a_robot_that_drives_after_a_mover_never_touches_it_harder_than_a_wall():
    world = World(HALL, quiet(), obstacles=[walker('cat', [(1.6, 2.0), (5.0, 2.0)], 0.1, 0.15)])
    robot = world.spawn('rumba', Pose(1.0, 2.0, 0.0))
    for _ in drive(world, 0.4, 0.0, 600):
        assert gaps(world)[0] >= -1e-9
    assert robot.bumper == (True, True) and robot.pose.x == approx(next(world.obstacles.poses())[1].x - 0.15 - RADIUS,
                                                                   abs=0.003)


def test_a_mover_leaves_a_robot_that_touches_it_from_behind():
    world = World(HALL, quiet(), obstacles=[walker('cat', [(2.0, 2.0), (5.0, 2.0)], 0.3, 0.15)])
    world.spawn('rumba', Pose(2.0 - 0.15 - RADIUS - 1e-6, 2.0, 0.0))
    world.step(100)
    assert next(world.obstacles.poses())[1].x == approx(2.6)


def test_the_laser_sees_a_mover_where_it_is():
    world = World(HALL, quiet(laser={'beams': 4}), obstacles=[walker('cat', [(4.0, 2.0), (2.5, 2.0)], 0.5, 0.15)])
    world.spawn('rumba', Pose(1.0, 2.0, 0.0))
    world.step(100)
    assert world.scan('rumba')[2] == approx(3.0 - 1.0 - 0.15)


# --- repeatability ------------------------------------------------------------------------------------------------

CATS = [walker('cat', [(0.9, 1.2), (3.4, 0.4), (3.3, 2.3)], 0.6, 0.1, pause=(0.0, 2.0)), disc('leg', 2.0, 1.0, 0.03),
        walker('dog', [(1.8, 2.7, 0.4), (2.2, 0.3, -1.0)], 0.4, size=(0.3, 0.2), is_loop=True, pause=(0.5, 1.0))]


def busy(seed=1, obstacles=CATS):
    """A world of robots with errors, among movers."""
    world = World(crooked(), RobotConfig(), seed=seed, obstacles=obstacles)
    world.spawn('a', Pose(0.5, 0.5, 0.3))
    world.spawn('b', Pose(3.4, 1.3, 2.0))
    return world


def wander(world, ticks=600):
    """Drive all robots around; returns digests on the way."""
    rng, seen = np.random.default_rng(3), []
    for _ in range(ticks // 10):
        for robot in world.robots.values():
            robot.command(rng.uniform(-0.1, 0.4), rng.uniform(-1.5, 1.5), world.tick)
        world.step(10)
        seen.append((world.digest(), world.scan('a').tobytes()))
    return seen


def test_the_same_seed_gives_the_same_world_and_another_seed_another():
    assert wander(busy()) == wander(busy()) != wander(busy(2))


def test_a_reset_puts_movers_back_so_that_the_world_equals_a_new_one():
    world = busy()
    wander(world)
    world.reset()
    assert world.digest() == busy().digest() and wander(world) == wander(busy())


def test_where_a_mover_is_belongs_to_the_digest():
    one, other = busy(), busy()
    other.remove_obstacle('cat')
    other.add_obstacle(CATS[0])
    assert one.digest() != other.digest()  # the order of obstacles
    one, other = busy(), busy(obstacles=[CATS[0]._replace(stops=walk(
        [stop.pose for stop in CATS[0].stops[:2]], 0.6, False, 0.0, 2.0)), *CATS[1:]])
    assert one.digest() != other.digest()


@pytest.mark.parametrize('ticks', [0, 1, 137, 400])
def test_a_restored_world_goes_on_bit_for_bit_with_its_movers(ticks):
    world = busy()
    wander(world, ticks)
    world.add_obstacle(disc('late', 0.3, 2.8, 0.1))
    again = World.restored(world.state(), world.plan, world.config, world.step_rate, world.seed, CATS)
    assert again.digest() == world.digest() and list(again.obstacles.items) == ['cat', 'leg', 'dog', 'late']
    assert list(again.obstacles.items.values()) == list(world.obstacles.items.values())
    assert wander(again) == wander(world)
    again.reset()
    world.reset()
    assert wander(again) == wander(world)


def test_a_state_does_not_fit_to_a_world_with_other_obstacles():
    world = busy()
    with pytest.raises(WorldError, match='^was saved with other obstacles at the start$'):
        World.restored(world.state(), world.plan, world.config, world.step_rate, world.seed, CATS[:1])


def test_movers_do_not_change_what_robots_count_and_measure():
    """Far from everything, so that they differ in nothing but the noise, which is their own."""
    found = []
    far = [walker('cat', [(17.0, 17.0), (18.0, 19.0)], pause=(0.0, 1.0)), box('crate', 2.0, 18.0, 0.3, 1.0, 0.3)]
    for things in ([], far):
        world = World(room(20.0, 20.0, 0.1), updated(RobotConfig(), {'laser': {'range_max': 5.0}}, 'test'), seed=9,
                      obstacles=things)
        robot = world.spawn('rumba', Pose(3.0, 3.0, 0.5))
        drove(world, 0.3, 0.4, 600)
        found.append((robot.ticks, robot.odometry, robot.pose, world.scan('rumba').tolist()))
    assert found[0] == found[1]


@pytest.mark.parametrize('steps', [[1] * 300, [300], [7, 256, 37]])
def test_many_ticks_at_once_equal_as_many_single_ticks(steps):
    worlds = [busy(), busy()]
    for world, ticks in zip(worlds, ([50] * 6, steps)):
        for robot in world.robots.values():
            robot.command(0.2, 0.4, world.tick)
        for number in ticks:
            world.step(number)
    assert worlds[0].digest() == worlds[1].digest()
