"""The mapper on floors of which it knows nothing, and where dead reckoning fails."""

import math

import numpy as np
import pytest
from rooms import crooked, room
from scans import error
from scipy.spatial import cKDTree

from rumba_localisation.mapping.believed_plan import believed_plan
from rumba_localisation.mapping.key_frames import KeyFrames
from rumba_localisation.mapping.mapper import Mapper
from rumba_localisation.mapping.mapper_config import MapperConfig
from rumba_localisation.mapping.tracker import DRIFT, Tracker
from rumba_localisation.scan import scan_of
from rumba_sim.model.common.config import updated
from rumba_sim.model.common.geometry import Pose, compose, wrap_angle
from rumba_sim.model.maps.floor_plan import OCCUPIED
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation.world import World

BAD = updated(RobotConfig(), {'odometry': {'scale_error': 0.03}}, 'wheels that err more than those of a Rumba')


def scan(world):
    """What the laser of the robot tells."""
    ranges = world.scan('rumba')
    return scan_of(ranges, -math.pi, 2.0 * math.pi / len(ranges), world.config.laser.range_max)


def world_of(plan, start, seed=1):
    """A world with a robot whose wheels err."""
    world = World(plan, BAD, 50, seed)
    world.spawn('rumba', start)
    return world


def drive(world, mapper, corners, speed=0.4):
    """Drive straight from corner to corner, by the true pose; scans ten times a second. Yields after each scan."""
    robot = world.robots['rumba']
    for x, y in corners:
        while math.hypot(x - robot.pose.x, y - robot.pose.y) > 0.15:
            off = wrap_angle(math.atan2(y - robot.pose.y, x - robot.pose.x) - robot.pose.theta)
            robot.command(0.0 if abs(off) > 0.3 else speed, max(min(3.0 * off, 1.5), -1.5), world.tick)
            world.step(5)
            mapper.observe(robot.odometry, scan(world))
            yield


def reckoned(world, start):
    """Where the robot would believe to be by its wheels alone."""
    return compose(start, world.robots['rumba'].odometry)


def walls(plan):
    """Centres of the occupied cells of a plan: float64 (any, 2) [m]."""
    return (np.argwhere(plan.occupancy == OCCUPIED)[:, ::-1] + 0.5) * plan.resolution + plan.origin


def off_walls(mapper, plan):
    """Distance from each wall cell of the map to the nearest true wall [m]: float64 (any)."""
    return cKDTree(walls(plan)).query(walls(believed_plan(mapper.grid, 'map')))[0]


def test_the_start_defines_the_map_frame():
    start = Pose(2.0, 1.3, 0.7)
    world, mapper = world_of(crooked(), Pose(1.9, 1.3, 0.5)), Mapper(start)
    assert mapper.estimate is None
    assert mapper.observe(world.robots['rumba'].odometry, scan(world))
    assert mapper.estimate.pose == start
    assert mapper.pose(world.robots['rumba'].odometry) == pytest.approx(start)


def test_a_robot_that_stands_still_learns_nothing_new():
    world, mapper = world_of(crooked(), Pose(2.0, 1.3, 0.7)), Mapper()
    mapper.observe(world.robots['rumba'].odometry, scan(world))
    assert not mapper.observe(world.robots['rumba'].odometry, scan(world))
    assert mapper.version == 1


def test_a_map_does_not_grow_while_a_robot_drives_where_it_was_before():
    start = Pose(0.6, 1.2, 0.0)
    world, mapper = world_of(crooked(), start), Mapper(start)
    around = [(2.0, 1.3), (2.2, 2.2), (1.0, 1.4)]
    for _ in drive(world, mapper, around * 4):
        pass
    before, size = mapper.version, mapper.grid.odds.size
    for _ in drive(world, mapper, around * 4):
        pass
    assert mapper.version < 1.15 * before
    assert mapper.grid.odds.size == size


def test_the_map_of_a_room_is_exact_and_so_is_the_pose():
    start = Pose(0.6, 1.2, 0.0)
    world, mapper = world_of(crooked(0.02), start), Mapper(start)
    errors = [error(mapper.pose(world.robots['rumba'].odometry), world.robots['rumba'].pose)
              for _ in drive(world, mapper, [(2.0, 1.3), (2.2, 2.6), (1.0, 2.6), (0.6, 1.2), (2.0, 1.2), (3.4, 1.2)])]
    assert np.sqrt(np.mean(np.square(errors), axis=0)) == pytest.approx([0.0, 0.0], abs=0.02)
    off = off_walls(mapper, crooked(0.02))
    assert np.mean(off <= 0.03) > 0.99 and off.max() <= 0.06


def test_a_long_corridor_that_dead_reckoning_bends_is_straight():
    plan, start = room(20.0, 1.6, boxes=[(6.0, 0.0, 6.3, 0.2), (13.0, 1.4, 13.4, 1.6)]), Pose(0.5, 0.8, 0.0)
    world, mapper = world_of(plan, start, seed=3), Mapper(start)
    for _ in drive(world, mapper, [(19.3, 0.8), (0.7, 0.8)]):
        pass
    robot = world.robots['rumba']
    off, turned = error(mapper.pose(robot.odometry), robot.pose)
    assert error(reckoned(world, start), robot.pose)[0] > 1.0
    assert off < 0.1 and turned < 0.02
    # Its length is what the wheels say, which are wrong by 3 %, where the laser sees no end and nothing at the sides.
    assert off_walls(mapper, plan).max() < 0.2


@pytest.mark.thorough
def test_along_a_bare_corridor_it_is_less_and_less_sure_how_far_it_has_come_until_it_sees_the_end():
    plan, start = room(30.0, 1.2, boxes=[(1.5, 0.0, 1.8, 0.2), (28.0, 1.0, 28.4, 1.2)]), Pose(1.0, 0.6, 0.0)
    world, mapper = world_of(plan, start), Mapper(start)
    for _ in drive(world, mapper, [(28.8, 0.6), (15.0, 0.6)]):
        pass
    middle = np.sqrt(np.diag(mapper.estimate.covariance))
    for _ in drive(world, mapper, [(1.2, 0.6)]):
        pass
    end = np.sqrt(np.diag(mapper.estimate.covariance))
    assert 0.025 < middle[0] < 0.12 and middle[1] < 0.01 and end[0] < 0.01


@pytest.mark.parametrize('seed', [1, 3])
def test_a_map_does_not_bend_the_way_that_the_wheels_err(seed):
    plan, start = room(20.0, 1.6, boxes=[(6.0, 0.0, 6.3, 0.2), (13.0, 1.4, 13.4, 1.6)]), Pose(0.5, 0.8, 0.0)
    world, mapper = world_of(plan, start, seed), Mapper(start)
    for _ in drive(world, mapper, [(19.3, 0.8)]):
        pass
    robot = world.robots['rumba']
    assert error(reckoned(world, start), robot.pose)[0] > 5.0
    assert mapper.pose(robot.odometry).y == pytest.approx(robot.pose.y, abs=0.03)


def test_a_loop_that_dead_reckoning_leaves_open_closes():
    plan, start = room(10.0, 8.0, boxes=[(1.6, 1.6, 8.4, 6.4)]), Pose(0.8, 0.8, 0.0)
    world, mapper = world_of(plan, start, seed=3), Mapper(start)
    for _ in drive(world, mapper, [(9.2, 0.8), (9.2, 7.2), (0.8, 7.2), (0.8, 0.8), (3.0, 0.8)]):
        pass
    robot = world.robots['rumba']
    off, turned = error(mapper.pose(robot.odometry), robot.pose)
    assert error(reckoned(world, start), robot.pose)[0] > 0.5
    assert off < 0.1 and turned < 0.02
    assert np.mean(off_walls(mapper, plan) <= 0.1) > 0.98


def test_wheels_that_slip_do_not_move_the_robot():
    start = Pose(0.6, 1.2, 0.0)
    world, mapper = world_of(crooked(0.02), start), Mapper(start)
    robot = world.robots['rumba']
    for _ in range(100):
        robot.command(0.4, 0.0, world.tick)  # against the wall on the right, after 3 m
        world.step(5)
        mapper.observe(robot.odometry, scan(world))
    assert error(reckoned(world, start), robot.pose)[0] > 0.5
    assert error(mapper.estimate.pose, robot.pose)[0] < 0.02


def test_a_robot_that_is_carried_away_finds_its_place_on_its_own_map():
    start = Pose(0.6, 1.2, 0.0)
    world, mapper = world_of(crooked(0.02), start), Mapper(start)
    robot = world.robots['rumba']
    around = [(2.0, 1.3), (2.2, 2.6), (1.0, 2.6), (0.6, 1.2), (3.4, 1.2)]
    for _ in drive(world, mapper, around):
        pass
    before = mapper.grid.odds.copy()
    world.teleport('rumba', Pose(1.0, 2.5, 2.0))
    is_sure = [mapper.estimate.is_sure for _ in drive(world, mapper, [(2.2, 2.6), (1.0, 2.6), (2.2, 2.6)])]
    assert not all(is_sure) and is_sure[-1]
    assert error(mapper.pose(robot.odometry), robot.pose)[0] < 0.05
    is_wall = before > 1.0
    assert np.mean(mapper.grid.odds[is_wall] > 0.0) > 0.97  # it did not draw the map over at the wrong place


def test_a_robot_that_was_moved_by_less_than_a_metre_is_found_at_once_and_without_doubt():
    plan, start = crooked(), Pose(1.0, 1.0, 0.3)
    world, mapper = world_of(plan, start), Mapper(start)
    for _ in drive(world, mapper, [(2.0, 1.3), (1.0, 1.0)]):
        pass
    robot = world.robots['rumba']
    world.teleport('rumba', robot.pose._replace(x=robot.pose.x + 0.5, y=robot.pose.y + 0.3))
    for number, _ in enumerate(drive(world, mapper, [(2.0, 1.3)])):
        assert mapper.estimate.is_sure
        assert number < 3 or error(mapper.pose(robot.odometry), robot.pose)[0] < 0.03


def contradictions(change):
    """Whether the mapper finds that scans contradict the wheels, in a bend, if the scans are changed."""
    start = Pose(0.6, 1.2, 0.0)
    world, mapper = world_of(crooked(0.02), start), Mapper(start)
    robot = world.robots['rumba']
    found = []
    for _ in range(100):
        robot.command(0.2, 0.5, world.tick)
        world.step(5)
        seen = scan(world)
        mapper.observe(robot.odometry, seen._replace(points=change(seen.points)))
        found.append(mapper.is_contradicted)
    return found


@pytest.mark.parametrize('sigma, side', [(0.01, 0.02), (0.026, 0.05), (0.2, 0.05)])
def test_the_cells_of_a_map_grow_with_the_noise_of_the_laser_to_five_centimetres_at_most(sigma, side):
    world, mapper = world_of(crooked(), Pose(1.9, 1.3, 0.5)), Mapper(config=MapperConfig(sigma=sigma))
    for _ in drive(world, mapper, [(2.6, 1.3)]):
        pass
    assert mapper.grid.resolution == side


def test_a_mirrored_laser_contradicts_the_odometry():
    assert contradictions(lambda points: points * (1.0, -1.0))[-1]
    assert not any(contradictions(lambda points: points))


def test_scans_without_an_echo_leave_all_of_the_error_of_the_wheels_between_key_frames(monkeypatch):
    movements, shares, spread = [], [], Tracker._spread

    def link(_, one, other, pose, covariance):
        shares.append(covariance[0, 0] / sum(each[0, 0] + DRIFT[0, 0] for each in movements))
        movements.clear()

    monkeypatch.setattr(Tracker, '_spread', lambda *told: movements.append(spread(*told)) or movements[-1])
    monkeypatch.setattr(KeyFrames, 'link', link)
    mapper = Mapper()
    for number in range(20):
        mapper.observe(Pose(0.15 * number, 0.0, 0.0), scan_of(np.full(360, np.inf), -math.pi, math.pi / 180.0, 8.0))
    assert shares == pytest.approx([1.0] * 19)


def test_scans_without_an_echo_leave_the_pose_to_the_odometry():
    mapper = Mapper()
    nothing = scan_of(np.full(360, np.inf), -math.pi, math.pi / 180.0, 2.0)
    mapper.observe(Pose(0.0, 0.0, 0.0), nothing)
    mapper.observe(Pose(0.5, 0.0, 0.1), nothing)
    assert mapper.estimate.pose == pytest.approx(Pose(0.5, 0.0, 0.1))
    assert not len(walls(believed_plan(mapper.grid, 'a field')))
