"""The world: adding and removing robots, and repeatability, bit for bit."""

import math

import numpy as np
import pytest
from pytest import approx
from rooms import RADIUS, alone, crooked, drive, drove, hall, quiet, room

from rumba_sim.model.common.config import updated
from rumba_sim.model.common.errors import ConfigError, MapError, WorldError
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.floors.constants import constants
from rumba_sim.model.settings.robot_config import OdometryConfig, RobotConfig
from rumba_sim.model.simulation.world import World

DOCK = Pose(3.8, 1.0, 0.0)
PLAN = crooked(dock=DOCK)


def noisy(seed=1, **starts):
    """A world of robots with errors of wheels and laser."""
    world = World(PLAN, RobotConfig(), seed=seed)
    for name, start in starts.items():
        world.spawn(name, start)
    return world


def wander(world, ticks=300):
    """Drive all robots around; returns their sensor readings."""
    rng = np.random.default_rng(3)
    seen = []
    for _ in range(ticks // 10):
        for name, robot in world.robots.items():
            robot.command(rng.uniform(0.0, 0.4), rng.uniform(-1.5, 1.5), world.tick)
            seen.append((world.scan(name).tobytes(), world.infrared(name), robot.bumper))
        world.step(10)
    return seen


A, B, C = Pose(0.5, 0.5, 0.3), Pose(2.0, 1.3, 2.0), Pose(3.4, 2.5, -1.0)


# --- repeatability ------------------------------------------------------------------------------------------------

def test_the_same_seed_gives_the_same_world_and_another_seed_another():
    worlds = [noisy(seed, a=A, b=B) for seed in (1, 1, 2)]
    seen = [wander(world) for world in worlds]
    assert seen[0] == seen[1] and worlds[0].digest() == worlds[1].digest()
    assert seen[0] != seen[2] and worlds[0].digest() != worlds[2].digest()


@pytest.mark.parametrize('steps', [[700], [1] * 700, [255, 1, 1, 443], [256, 256, 188], [3, 697]])
def test_many_ticks_at_once_equal_as_many_single_ticks(steps):
    worlds = [noisy(a=A, b=B), noisy(a=A, b=B)]
    for world, ticks in zip(worlds, ([50] * 14, steps)):
        world.config = RobotConfig(drive=type(world.config.drive)(command_timeout=60.0))
        for robot, w in zip(world.robots.values(), (0.4, -0.7)):
            robot.command(0.25, w, world.tick)
        for number in ticks:
            world.step(number)
    assert worlds[0].tick == worlds[1].tick == 700 and worlds[0].time == approx(14.0)
    assert worlds[0].digest() == worlds[1].digest()


def test_a_reset_world_equals_a_new_world_bit_for_bit():
    world = noisy(a=A, b=B)
    wander(world)
    world.teleport('a', C)
    world.robots['a'].brushes_up = True
    wander(world, 40)
    world.reset()
    new = noisy(a=A, b=B)
    assert world.digest() == new.digest() and world.tick == 0 and world.time == 0.0
    assert wander(world) == wander(new) and world.digest() == new.digest()


def test_a_reset_after_a_kill_gives_a_world_without_the_killed_robot():
    world = noisy(a=A, b=B, c=C)
    wander(world, 50)
    world.kill('b')
    world.reset()
    new = noisy(a=A, c=C)
    assert wander(world) == wander(new) and world.digest() == new.digest()


def test_a_reset_gives_each_battery_its_first_charge():
    world = World(PLAN, quiet(battery={'drain': 100.0}))
    world.spawn('a', A, 0.5)
    world.step(500)
    assert world.robots['a'].battery.state_of_charge < 0.5
    world.reset()
    assert world.robots['a'].battery.state_of_charge == 0.5


def test_a_reset_keeps_all_robots_even_if_two_began_at_the_same_position():
    world, first = alone(A, PLAN)
    drove(world, 0.4, 0.0, 150)
    world.spawn('second', A)
    world.reset()
    assert list(world.robots) == ['rumba', 'second'] and world.robots['rumba'].pose == approx(A)
    second = world.robots['second'].pose
    assert math.hypot(second.x - A.x, second.y - A.y) >= 2.0 * RADIUS


@pytest.mark.parametrize('others', [[], [B], [B, C]])
def test_what_a_robot_sees_and_counts_does_not_depend_on_how_many_others_there_are(others):
    world = World(hall(), RobotConfig(), seed=9)
    robot = world.spawn('rumba', Pose(3.0, 3.0, 0.5))
    for number, _ in enumerate(others):
        world.spawn(str(number), Pose(15.0, 5.0 + 8.0 * number, 0.0))
        world.scan(str(number))
    drove(world, 0.3, 0.4, 600)
    alike = World(hall(), RobotConfig(), seed=9)
    same = alike.spawn('other name', Pose(3.0, 3.0, 0.5))
    drove(alike, 0.3, 0.4, 600, 'other name')
    assert (robot.ticks, robot.odometry, robot.pose) == (same.ticks, same.odometry, same.pose)
    assert (world.scan('rumba')[:20] == alike.scan('other name')[:20]).all()


def test_robots_have_different_errors():
    world = noisy(a=A, b=B)
    states = [robot.state for robot in world.robots.values()]
    scales = {float(state[side]) for state in states for side in ('left_scale', 'right_scale')}
    assert len(scales) == 4 and 1.0 not in scales


def test_a_robot_keeps_its_noise_if_an_earlier_robot_is_removed():
    ticks = []
    for is_killed in (True, False):
        world = World(hall(), RobotConfig(odometry=OdometryConfig(noise=0.1)), seed=9)
        world.spawn('first', Pose(15.0, 15.0, 0.0))
        robot = world.spawn('second', Pose(3.0, 3.0, 0.5))
        drove(world, 0.3, 0.4, 100, 'second')
        if is_killed:
            world.kill('first')
        drove(world, 0.3, 0.4, 300, 'second')
        ticks.append(robot.ticks)
    assert ticks[0] == ticks[1]


# --- adding, removing and moving robots ---------------------------------------------------------------------------

def test_robots_keep_their_state_if_others_are_added_and_removed():
    world = World(PLAN, quiet())
    poses = {'a': A, 'b': B, 'c': C}
    robots = {name: world.spawn(name, pose) for name, pose in poses.items()}
    world.kill('b')
    drove(world, 0.2, 0.0, 50, 'c')
    assert robots['a'].pose == approx(A) and robots['c'].pose.x > C.x + 0.05
    b = world.spawn('b', B, 0.25)
    assert list(world.robots) == ['a', 'c', 'b'] and b.pose == approx(B) and b.battery.percentage == 25
    b.command(0.2, 0.0, world.tick)
    world.step(10)
    assert b.distance > 0.0 and robots['a'].pose == approx(A) and robots['a'].distance == 0.0
    assert world.robots['b'] is b


def test_without_a_pose_the_first_robot_begins_at_the_start_and_others_beside_it():
    world = World(crooked(dock=DOCK), quiet())
    robots = [world.spawn(str(number)) for number in range(5)]
    assert robots[0].pose == DOCK
    for one in robots:
        for other in robots:
            assert one is other or math.hypot(one.pose.x - other.pose.x, one.pose.y - other.pose.y) >= 2.0 * RADIUS
    assert World(crooked(dock=DOCK, start=B), quiet()).spawn('rumba').pose == approx(B)


def test_a_robot_for_which_there_is_no_free_position_is_refused():
    world = World(room(0.4, 0.4), quiet())
    world.spawn('a')
    with pytest.raises(WorldError, match='^room: no room for another robot$'):
        world.spawn('b')
    assert list(world.robots) == ['a']


@pytest.mark.parametrize('act, message', [
    (lambda world: world.spawn('a', C), r"^'a' is taken: robots are a, b$"),
    (lambda world: world.spawn('c', Pose(-5.0, 0.0, 0.0)), r'^room: pose at \(-5\.00, 0\.00\) m lies outside the map'),
    (lambda world: world.spawn('c', Pose(0.1, 0.5, 0.0)),
     r'^room: pose at \(0\.10, 0\.50\) m is 0\.100 m from the nearest wall: a robot of radius 0\.175 m does not fit$'),
    (lambda world: world.spawn('c', Pose(0.5, math.nan, 0.0)), r'^pose \(0\.5, nan, 0\.0\): must be finite numbers$'),
    (lambda world: world.spawn('c', Pose(0.5, 0.5, math.inf)), r'^pose \(0\.5, 0\.5, inf\): must be finite numbers$'),
    (lambda world: world.spawn('c', Pose(0.7, 0.5, 0.0)), r"^\(0\.70, 0\.50\) m: 'a' stands there$"),
    (lambda world: world.spawn('c', C, 1.01), r'^state of charge is 1\.01: must be 0 to 1$'),
    (lambda world: world.spawn('c', C, math.nan), r'^state of charge is nan: must be 0 to 1$'),
    (lambda world: world.kill('z'), r"^there is no robot 'z': robots are a, b$"),
    (lambda world: world.teleport('z', C), r"^there is no robot 'z': robots are a, b$"),
    (lambda world: world.teleport('a', Pose(1.3, 0.6, 0.0)), r'is 0\.000 m from the nearest wall'),
    (lambda world: world.teleport('a', Pose(2.1, 1.3, 0.0)), r"^\(2\.10, 1\.30\) m: 'b' stands there$"),
    (lambda world: world.teleport('a', Pose(math.inf, 0.0, 0.0)), r'must be finite numbers$'),
    (lambda world: world.scan('z'), r"^there is no robot 'z': robots are a, b$"),
    (lambda world: world.infrared('z'), r"^there is no robot 'z'"),
])
def test_an_impossible_request_is_refused_and_does_not_change_the_world(act, message):
    world, unharmed = noisy(a=A, b=B), noisy(a=A, b=B)
    with pytest.raises(WorldError, match=message):
        act(world)
    assert world.digest() == unharmed.digest()
    assert wander(world) == wander(unharmed) and world.digest() == unharmed.digest()


def test_the_error_in_an_empty_world_names_no_robots():
    with pytest.raises(WorldError, match="^there is no robot 'a': robots are none$"):
        World(PLAN).kill('a')


def test_a_teleported_robot_rests_with_its_heading_wrapped_and_drops_its_command():
    world, robot = alone(A, PLAN)
    drove(world, 0.3, 0.0, 20)
    charge = robot.battery.charge
    world.teleport('rumba', Pose(C.x, C.y, 7.0))
    world.step(20)
    assert robot.pose == approx((C.x, C.y, 7.0 - 2.0 * math.pi)) and robot.twist == (0.0, 0.0)
    assert 0.0 < charge - robot.battery.charge < 0.001


def test_a_robot_does_not_collide_with_itself_in_a_teleport():
    world, robot = alone(A, PLAN)
    world.teleport('rumba', Pose(A.x + 0.05, A.y, 1.0))
    assert robot.pose == approx((A.x + 0.05, A.y, 1.0))


# --- configuration ------------------------------------------------------------------------------------------------

def test_settings_can_change_while_robots_drive():
    world, robot = alone(A, PLAN)
    drove(world, 0.4, 0.0, 50)
    world.config = quiet(drive={'max_speed': 0.1}, battery={'drain': 50.0})
    assert robot.config.drive.max_speed == 0.1 and robot.battery.config.drain == 50.0
    drove(world, 0.4, 0.0, 50)
    assert robot.twist.v == approx(0.1)


def test_the_radius_of_robots_cannot_change():
    world, robot = alone(A, PLAN)
    with pytest.raises(ConfigError, match=r'^drive/radius is 0\.2: must stay 0\.17425 \[m\]$'):
        world.config = quiet(drive={'radius': 0.2})
    assert world.config == quiet() == robot.config


def test_a_speed_of_more_than_a_radius_per_tick_and_cells_that_are_too_large_are_refused():
    with pytest.raises(ConfigError, match=r'^drive/max_speed is 2: at 10 ticks a second must be at most 1\.7425 \[m/s\]'
                                          r', a radius in a tick$'):
        World(PLAN, quiet(drive={'max_speed': 2.0}), 10)
    with pytest.raises(MapError, match=r'^room: cells of 0\.2 m are too coarse for a robot of radius 0\.17425 m$'):
        constants(RobotConfig(), room(4.0, 4.0, 0.2), 50)
    assert World(room(4.0, 4.0, 0.2)).terrain.resolution == 0.025


def test_a_start_where_no_robot_fits_is_refused():
    with pytest.raises(MapError, match=r'^room: start at \(1\.30, 0\.50\) m is 0\.000 m from the nearest wall'):
        World(crooked(start=Pose(1.3, 0.5, 0.0)))
    with pytest.raises(MapError, match=r'^room: start at .* does not fit$'):
        World(room(0.3, 0.3))


def test_two_seconds_of_driving_end_at_the_same_pose_at_any_step_rate():
    ends = []
    for step_rate in (10, 20, 50, 100):
        world, _ = alone(step_rate=step_rate, drive={'acceleration': 1000.0})
        ends.append(list(drive(world, 0.3, 0.4, 2 * step_rate))[-1])
        assert world.time == 2.0
    for end in ends:
        assert end == approx(ends[0])


def test_a_reset_restores_the_first_charge_and_brushes():
    world = World(crooked())
    world.spawn('rumba', state_of_charge=0.4, brushes_up=True)
    world.robots['rumba'].brushes_up = False
    world.step(1000)
    world.reset()
    assert world.robots['rumba'].brushes_up and world.robots['rumba'].battery.percentage == 40


def test_a_further_robot_begins_at_the_nearest_place_to_which_it_could_drive():
    world = World(room(3.0, 2.0, 0.05, [(0.0, 1.0, 3.0, 1.05)], start=Pose(1.0, 1.24, 0.0)))  # no door to below
    poses = [world.spawn(name).pose for name in ('rumba', 'rumba2', 'rumba3', 'rumba4')]
    assert poses[0][:2] == (1.0, 1.24) and all(pose.y > 1.05 for pose in poses)
    assert math.hypot(poses[1].x - 1.0, poses[1].y - 1.24) == approx(2.5 * RADIUS, abs=0.02)


def test_a_battery_of_less_capacity_is_full_at_once():
    world, robot = alone()
    world.config = updated(world.config, {'battery': {'capacity': 1.0}}, 'test')
    assert robot.battery.state_of_charge == 1.0 and robot.battery.percentage == 100


def test_robots_do_not_overlap_if_they_become_faster_while_they_drive():
    world = World(room(20.0, 2.0, 0.1), quiet(drive={'max_speed': 0.1, 'acceleration': 1000.0}))
    left, right = world.spawn('rumba', Pose(2.0, 1.0, 0.0)), world.spawn('rumba2', Pose(12.0, 1.0, math.pi))
    world.step(10)
    world.config = updated(world.config, {'drive': {'max_speed': 5.0}}, 'test')
    for _ in range(100):
        left.command(5.0, 0.0, world.tick)
        right.command(5.0, 0.0, world.tick)
        world.step()
        assert math.hypot(left.pose.x - right.pose.x, left.pose.y - right.pose.y) >= 2.0 * RADIUS
    assert left.bumper == (True, True)
