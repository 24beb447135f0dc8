"""A robot finds out where it is: told, anywhere, carried away, without a laser, in a room that looks the same twice."""

import math

import numpy as np
import pytest
from rooms import RADIUS, crooked, room
from scans import BLIND, drive, error, localiser_of, scanned, world_of

from rumba_localisation.localiser import START
from rumba_localisation.localiser_config import LocaliserConfig
from rumba_localisation.scan import thinned
from rumba_sim.model.common.errors import ConfigError
from rumba_sim.model.common.geometry import Pose, compose
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation.obstacle import Obstacle
from rumba_sim.model.simulation.world import World

NOBODY = Pose(0.0, 0.0, 0.0)


def under_way(seconds=5.0):
    """A world, and a localiser that was told where its robot is, which has driven for some time since."""
    world = world_of()
    localiser = localiser_of(world.plan)
    localiser.start_at(world.robots['rumba'].pose)
    list(drive(world, localiser, 0.2, 0.3, seconds))
    return world, localiser


def test_few_points_remain_and_are_spread():
    assert thinned(np.arange(20).reshape(10, 2), 4)[:, 0].tolist() == [0, 6, 12, 18]


@pytest.mark.parametrize('seed', range(5))
def test_a_start_that_is_told_roughly_becomes_exact(seed):
    world = world_of(seed=seed)
    localiser = localiser_of(world.plan, seed=seed)
    localiser.start_at(Pose(2.2, 1.1, 0.5))
    errors = list(drive(world, localiser, 0.2, 0.4, 10.0))
    assert max(distance for distance, _ in errors[1:]) < 0.05 and max(turn for _, turn in errors[1:]) < 0.03
    assert localiser.estimate.is_sure


@pytest.mark.parametrize('seed', range(5))
def test_a_robot_that_was_told_nothing_looks_anywhere(seed):
    poses = (Pose(0.3, 0.4, 2.0), Pose(3.6, 2.6, -1.0), Pose(2.0, 1.3, 0.0), Pose(0.4, 2.6, -2.8), Pose(3.3, 0.5, 1.0))
    world = world_of(pose=poses[seed])
    localiser = localiser_of(world.plan, seed=seed)
    assert localiser.estimate is None
    localiser.observe(world.robots['rumba'].odometry, scanned(world))
    assert max(error(localiser.pose(world.robots['rumba'].odometry), poses[seed])) < 0.03
    assert localiser.estimate.is_sure


def test_a_scan_is_used_only_after_a_movement():
    world = world_of()
    localiser = localiser_of(world.plan)
    assert localiser.observe(NOBODY, scanned(world))
    assert not localiser.observe(Pose(0.09, 0.0, 0.09), scanned(world))
    assert localiser.observe(Pose(0.09, 0.0, 0.09), scanned(world), is_forced=True)
    assert localiser.observe(Pose(0.09, 0.0, 0.2), scanned(world))
    assert localiser.observe(Pose(0.2, 0.0, 0.2), scanned(world))


def test_a_robot_that_was_carried_away_notices_and_finds_itself_again():
    world, localiser = under_way()
    world.teleport('rumba', Pose(0.5, 1.2, -2.0))
    errors, sure = [], []
    for each in drive(world, localiser, 0.12, 0.6, 15.0):
        errors.append(each[0])
        sure.append(localiser.estimate.is_sure)
    assert errors[3] > 1.0 and not all(sure)
    assert max(errors[-50:]) < 0.05 and all(sure[-50:])


@pytest.mark.parametrize('turn', [-0.4, -0.2, 0.2, 0.4])
def test_a_robot_that_was_turned_finds_its_heading_at_the_next_scan(turn):
    """As by wheels that slip at an obstacle; scans are used from a movement to the next."""
    world, localiser = under_way()
    here = world.robots['rumba'].pose
    world.teleport('rumba', here._replace(theta=here.theta + turn))
    errors = list(drive(world, localiser, 0.2, 0.3, 5.0))
    assert max(turned for _, turned in errors[5:]) < 0.05 and max(away for away, _ in errors[5:]) < 0.1  # used by then


def among_obstacles(seed):
    """A world in which boxes hide most of the walls, and a localiser that is told where its robot is."""
    plan = room(4.0, 3.0, 0.02, [(1.98, 0.0, 2.02, 1.9)])
    world = World(plan, RobotConfig(), 50, seed, [
        Obstacle(f'box_{number}', Pose(x, y, 0.3 * number), 0.3, length=0.5, width=0.3)
        for number, (x, y) in enumerate([(0.4, 1.2), (1.5, 1.4), (0.9, 2.5), (0.4, 2.0)])])
    world.spawn('rumba', Pose(0.8, 0.6, 0.0))
    localiser = localiser_of(plan, seed=seed)
    localiser.start_at(world.robots['rumba'].pose)
    return world, localiser


def farthest_particle(world, localiser):
    """Distance from the robot [m]."""
    pose = world.robots['rumba'].pose
    return np.hypot(*(localiser.particles[:, :2] - pose[:2]).T).max()


@pytest.mark.parametrize('seed', range(4))
def test_obstacles_that_hide_most_walls_do_not_carry_a_robot_away(seed):
    """It knows where it is, and no beam would have to pass through a wall there, as it would elsewhere."""
    world, localiser = among_obstacles(seed)
    list(drive(world, localiser, 0.0, 0.8, 4.0))
    for number in range(4):
        angle = world.robots['rumba'].pose.theta + number * math.pi / 2.0
        x, y = world.robots['rumba'].pose[:2]
        there = Pose(x + 0.32 * math.cos(angle), y + 0.32 * math.sin(angle), angle)
        world.add_obstacle(Obstacle(f'leg_{number}', there, 0.3, length=0.06, width=0.2))
    for away, _ in drive(world, localiser, 0.0, 0.5, 12.0):
        assert away < 0.1 and localiser.estimate.is_sure and farthest_particle(world, localiser) < 1.0
    assert localiser.estimate.fit < 0.5


def test_headings_that_were_wound_up_by_whole_turns_do_not_grow():
    world, localiser = among_obstacles(1)
    list(drive(world, localiser, 0.0, 0.8, 1.0))
    localiser.particles[::2, 2] += 8.0 * math.pi
    errors = list(drive(world, localiser, 0.0, 0.8, 10.0))
    assert np.abs(localiser.particles[:, 2]).max() < 16.0 * math.pi
    assert max(away for away, _ in errors) < 0.1 and localiser.estimate.is_sure


@pytest.mark.parametrize('slipped', [0.1, 0.2, 0.3])
def test_wheels_that_slip_for_a_second_do_not_lose_the_robot(slipped):
    """The wheels count a way that the robot does not drive: for the localiser, it was pushed back."""
    world, localiser = under_way(4.0)
    pose = world.robots['rumba'].pose
    world.teleport('rumba', Pose(pose.x - slipped * math.cos(pose.theta), pose.y - slipped * math.sin(pose.theta),
                                 pose.theta))
    errors = list(drive(world, localiser, 0.2, 0.3, 6.0))
    assert max(map(max, errors[-30:])) < 0.05 and localiser.estimate.is_sure


@pytest.mark.parametrize('v, w', [(0.25, 0.0), (0.0, 1.5), (0.0, -1.5)])
@pytest.mark.parametrize('pose', [Pose(0.5, 0.5, 0.3), Pose(2.0, 1.3, 2.0), Pose(0.8, 2.4, 1.0), Pose(3.5, 2.5, -2.5)])
def test_a_robot_that_slides_for_a_second_stays_near_where_it_is(pose, v, w):
    """Its wheels stand meanwhile, so that the odometry tells of no movement."""
    world = world_of(pose=pose)
    localiser, robot = localiser_of(world.plan), world.robots['rumba']
    localiser.start_at(robot.pose)
    list(drive(world, localiser, 0.1, 0.3, 3.0))
    counted = robot.odometry
    for _ in range(10):
        robot.command(v, w, world.tick)
        world.step(5)
        robot.state['odom_x'], robot.state['odom_y'], robot.state['odom_theta'] = counted
        localiser.observe(counted, scanned(world))
        away, turned = error(localiser.pose(counted), robot.pose)
        assert away < 0.15 and turned < 0.25
    assert max(map(max, drive(world, localiser, 0.1, 0.3, 3.0))) < 0.1 and localiser.estimate.is_sure


def test_wheels_that_slip_in_place_are_noticed_within_seconds():
    """As those of a robot that drives against an obstacle, and moves less than what a scan is used after."""
    world, localiser = under_way()
    robot = world.robots['rumba']
    slipped = compose(robot.odometry, Pose(0.04, 0.0, 0.0))
    errors = []
    for _ in range(30):
        localiser.observe(slipped, scanned(world))
        errors.append(error(localiser.pose(slipped), robot.pose)[0])
    assert errors[0] > 0.02 and max(errors[20:]) < 0.01
    assert not any([localiser.observe(slipped, scanned(world)) for _ in range(50)])  # it stands


def silenced():
    """A world, and a localiser of many particles that knows its place, and looks along the x axis."""
    world = world_of(pose=Pose(0.5, 0.6, 0.0))
    localiser = localiser_of(world.plan, config=LocaliserConfig(min_particles=4000, max_particles=4000))
    localiser.start_at(world.robots['rumba'].pose, np.diag([1e-6, 1e-6, 1e-6]))
    assert localiser.observe(NOBODY, scanned(world))
    return world, localiser


@pytest.mark.parametrize('steps', [8, 4])
def test_while_the_laser_is_silent_the_covariance_grows_as_the_motion_model_says(steps):
    """After a way straight ahead of d: a3 d^2 along it, a2 d^2 of the heading, whatever its parts are."""
    _, localiser = silenced()
    config, known, before = localiser.config, np.cov(localiser.particles.T), localiser.estimate.pose
    for step in range(1, steps + 1):
        assert localiser.observe(Pose(step / steps, 0.0, 0.0), None)
    found, pose = localiser.estimate.covariance - known, localiser.estimate.pose
    assert found[0, 0] == pytest.approx(config.odom_alpha3, rel=0.15)
    assert found[2, 2] == pytest.approx(config.odom_alpha2, rel=0.1)
    assert found[1, 1] > 0.2 * found[2, 2] and localiser.estimate.is_sure
    assert pose == pytest.approx(compose(before, Pose(1.0, 0.0, 0.0)))


def test_while_the_laser_is_silent_a_robot_that_stands_stays_as_certain_and_one_that_drives_far_does_not():
    _, localiser = silenced()
    known = localiser.estimate
    assert not any([localiser.observe(NOBODY, None) for _ in range(100)]) and localiser.estimate == known
    for step in range(1, 40):
        localiser.observe(Pose(0.1 * step, 0.0, 0.0), None)
    assert not localiser.estimate.is_sure and localiser.estimate.covariance[0, 0] > 0.3 ** 2


def test_the_first_scan_after_a_silence_is_used_although_the_robot_stands():
    world, localiser = under_way()
    robot = world.robots['rumba']
    for _ in range(30):
        robot.command(0.2, 0.8, world.tick)
        world.step(5)
        localiser.observe(robot.odometry, None)
    assert localiser.estimate.covariance[2, 2] > 0.01
    assert localiser.observe(robot.odometry, scanned(world))
    assert max(error(localiser.pose(robot.odometry), robot.pose)) < 0.02
    assert localiser.estimate.is_sure and localiser.estimate.covariance[2, 2] < 0.001


def test_without_echoes_the_pose_becomes_uncertain_and_is_found_again():
    world = world_of(room(4.0, 3.0, 0.05, ((1.0, 0.0, 1.3, 0.4),)), Pose(2.0, 1.5, 0.0))
    localiser = localiser_of(world.plan)
    localiser.start_at(world.robots['rumba'].pose)
    list(drive(world, localiser, 0.1, 0.5, 3.0))
    known = localiser.estimate.covariance
    list(drive(world, localiser, 0.2, 1.0, 40.0, is_blind=True))
    assert localiser.estimate.covariance[0, 0] > 20.0 * known[0, 0]
    assert max(list(drive(world, localiser, 0.2, 1.0, 10.0))[-1]) < 0.05


def test_nothing_is_known_before_the_first_echoes():
    localiser = localiser_of(crooked())
    assert not localiser.observe(NOBODY, BLIND) and localiser.estimate is None


def test_in_a_room_that_looks_the_same_twice_both_places_are_kept():
    """A rectangle looks the same after half a turn about its middle, however the robot moves."""
    world = world_of(room(4.0, 2.6, 0.05), Pose(1.2, 0.9, 0.4))
    localiser = localiser_of(world.plan)
    for _ in drive(world, localiser, 0.15, 0.5, 10.0):
        true = world.robots['rumba'].pose
        mirrored = Pose(4.0 - true.x, 2.6 - true.y, true.theta + math.pi)
        near = [np.hypot(localiser.particles[:, 0] - pose.x, localiser.particles[:, 1] - pose.y) < 0.4
                for pose in (true, mirrored)]
        assert min(part.mean() for part in near) > 0.05
    assert not localiser.estimate.is_sure
    assert localiser.estimate.covariance[0, 0] >= START[0, 0]


def test_the_same_scans_and_seed_give_the_same_belief():
    found = []
    for _ in range(2):
        world = world_of()
        localiser = localiser_of(world.plan, seed=7)
        list(drive(world, localiser, 0.2, 0.5, 5.0))
        found.append((localiser.correction, localiser.particles.tolist()))
    assert found[0] == found[1]


def test_no_place_is_tried_where_the_robot_does_not_fit():
    plan = crooked()
    positions = localiser_of(plan)._search._positions
    assert len(positions) > 100 and min(plan.clearance_at(x, y) for x, y in positions) >= RADIUS - 0.03


@pytest.mark.parametrize('away, turn', [(0.0, math.pi), (0.3, 1.5), (0.5, -2.5)])
def test_a_robot_that_slipped_is_found_around_its_place_and_farther_away_it_is_not(away, turn):
    plan, true = crooked(), Pose(2.0, 1.3, 0.7)
    seen, localiser = scanned(world_of(plan, true)), localiser_of(plan)
    localiser.observe(NOBODY, seen)
    found = localiser._matcher.slipped(Pose(true.x + away, true.y, true.theta + turn), seen)
    assert max(error(Pose(*found.pose), true)) < 0.02
    assert localiser._matcher.slipped(Pose(true.x + away + 1.0, true.y, true.theta), seen) is None


@pytest.mark.parametrize('given, message', [
    ({'max_particles': 100, 'min_particles': 200}, '^max_particles is 100: must not be below min_particles, 200$'),
    ({'recovery_alpha_fast': 0.01}, '^recovery_alpha_fast is 0.01: must not be below recovery_alpha_slow, 0.02$')])
def test_parameters_in_the_wrong_order_are_refused(given, message):
    with pytest.raises(ConfigError, match=message):
        LocaliserConfig(**given)
