"""A robot that something else moves: what its world notices, and how the robot would drive."""

import math

import pytest
from rooms import DENT, PLANS, RADIUS, distances, room

from rumba_sim.model.common.errors import WorldError
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.settings.robot_config import OdometryConfig, RobotConfig
from rumba_sim.model.simulation.guided_world import GuidedWorld
from rumba_sim.model.simulation.world import World

RATE = 62.5  # [Hz]
EXACT = RobotConfig(odometry=OdometryConfig(scale_error=0.0, noise=0.0, floor_traction=1.0))
BEGIN = Pose(1.0, 1.5, 0.0)


def guided_world(state_of_charge=1.0, brushes_up=False, plan=None):
    """A robot in a room of 8 x 3 m."""
    return GuidedWorld(plan or room(8.0, 3.0, start=BEGIN), EXACT, RATE, state_of_charge=state_of_charge,
                       brushes_up=brushes_up)


def drive(guided, distance, seconds):
    """Have the robot driven straight on; returns its pose at the end."""
    begin, ticks = guided.robot.pose, round(seconds * RATE)
    for tick in range(1, ticks + 1):
        guided.follow(Pose(begin.x + distance * tick / ticks, begin.y, begin.theta))
    return guided.robot.pose


def test_a_guided_robot_uses_charge_and_sweeps_like_one_that_drives():
    """4.8 m at 0.2 m/s: 24 s of 0.19 + 0.5 + 0.3 + 0.7 * 0.2 / 0.3 A, and a strip as wide as the brush."""
    guided = guided_world()
    assert drive(guided, 4.8, 24.0) == pytest.approx((5.8, 1.5, 0.0))
    robot = guided.robot
    current = 0.19 + 0.5 + 0.3 + 0.7 * 0.2 / 0.3
    assert robot.battery.current == pytest.approx(-current)
    assert robot.battery.charge == pytest.approx(2.7 - current * 24.0 / 3600.0, rel=1e-9)
    assert robot.distance == pytest.approx(4.8)
    assert robot.brush_time == pytest.approx(24.0)
    assert robot.twist == pytest.approx((0.2, 0.0))
    assert robot.odometry.x == pytest.approx(4.8, abs=0.001)
    assert guided.world.floor.cleaned_area == pytest.approx(4.8 * 0.17, rel=0.2)


def test_a_robot_guided_along_the_path_of_another_has_the_same_battery_floor_and_odometry():
    plan = room(8.0, 3.0, start=BEGIN)
    world, guided = World(plan, RobotConfig(), seed=3), GuidedWorld(plan, RobotConfig(), seed=3)
    robot = world.spawn('rumba', BEGIN)
    for tick in range(1000):
        robot.command(0.25, 0.5 * math.cos(0.01 * tick), world.tick)
        world.step()
        guided.follow(robot.pose)
    assert guided.robot.battery.charge == pytest.approx(robot.battery.charge, rel=1e-6)
    assert guided.world.floor.coverage == pytest.approx(world.floor.coverage, rel=1e-3)
    assert guided.robot.odometry == pytest.approx(robot.odometry, abs=2e-3)
    assert guided.robot.odometry != pytest.approx(robot.pose, abs=2e-3)
    assert guided.robot.distance == pytest.approx(robot.distance, rel=1e-4)


def test_with_the_brushes_up_nothing_is_swept():
    guided = guided_world(brushes_up=True)
    drive(guided, 4.8, 24.0)
    assert (guided.world.floor.coverage, guided.robot.brush_time) == (0.0, 0.0)
    assert guided.robot.battery.current == pytest.approx(-(0.19 + 0.3 + 0.7 * 0.2 / 0.3))


def test_with_an_empty_battery_nothing_is_swept():
    guided = guided_world(state_of_charge=0.0)
    drive(guided, 4.8, 24.0)
    assert guided.world.floor.coverage == 0.0


def test_a_jump_changes_neither_distance_nor_floor_nor_odometry_and_ends_the_command():
    guided = guided_world()
    drive(guided, 1.0, 8.0)
    before, swept = guided.robot.odometry, guided.world.floor.cleaned_area
    guided.robot.command(0.3, 0.0, guided.world.tick)
    guided.jump(Pose(6.0, 2.0, 2.0))
    robot = guided.robot
    assert robot.pose == (6.0, 2.0, 2.0)
    assert robot.distance == pytest.approx(1.0)
    assert robot.odometry == before
    assert guided.world.floor.cleaned_area == swept
    assert robot.twist == (0.0, 0.0)
    assert guided.wish() == (0.0, 0.0)
    guided.follow(Pose(6.0, 2.0, 2.0))
    assert (robot.distance, robot.odometry) == (pytest.approx(1.0), before)


def wishes(guided, v, ticks):
    """The forward speeds of a robot that gets one command and stays where it is."""
    guided.robot.command(v, 0.0, guided.world.tick)
    for _ in range(ticks):
        yield guided.wish().v
        guided.follow(guided.robot.pose)


def test_a_command_is_followed_with_the_acceleration_of_the_wheels_until_its_timeout():
    """0.9 m/s^2 at 62.5 Hz are 0.0144 m/s per tick; more than 0.5 m/s is cut; 0.5 s are 31 ticks."""
    speeds = list(wishes(guided_world(), 0.9, 80))
    assert speeds[:3] == pytest.approx([0.0144, 0.0288, 0.0432])
    assert max(speeds) == pytest.approx(0.0144 * 31)
    assert speeds[-1] == 0.0


def test_a_turn_is_cut_to_its_limit_and_keeps_its_sign():
    guided = guided_world()
    for _ in range(80):
        guided.robot.command(0.0, -5.0, guided.world.tick)
        wish = guided.wish()
        guided.follow(guided.robot.pose)
    assert wish == pytest.approx((0.0, -1.9))


def test_with_an_empty_battery_the_robot_would_stand_still():
    guided = guided_world(state_of_charge=0.0)
    guided.robot.command(0.3, 0.5, guided.world.tick)
    assert guided.wish() == (0.0, 0.0)


@pytest.mark.parametrize('sign, theta', [(1.0, 0.0), (-1.0, math.pi)])
def test_the_robot_would_stop_at_a_wall_presses_its_bumper_and_can_back_off(sign, theta):
    guided = guided_world()
    guided.jump(Pose(7.5, 1.5, theta))
    x = 7.5
    for _ in range(150):
        guided.robot.command(sign * 0.3, 0.0, guided.world.tick)
        x += guided.wish().v * math.cos(theta) / RATE
        guided.follow(Pose(x, 1.5, theta))
    assert x == pytest.approx(8.0 - 0.17425, abs=0.002)
    assert guided.robot.bumper == ((True, True) if sign > 0.0 else (False, False))
    for _ in range(60):
        guided.robot.command(sign * -0.3, 0.0, guided.world.tick)
        wish = guided.wish()
        guided.follow(guided.robot.pose)
    assert sign * wish.v == pytest.approx(-0.3)


def test_a_robot_in_a_dent_of_the_clearance_between_two_walls_would_drive_off():
    guided = guided_world(plan=PLANS[('slanted', 0.05)])
    guided.jump(DENT)
    for _ in range(60):
        guided.robot.command(-0.3, 0.0, guided.world.tick)
        x, y, theta = guided.robot.pose
        way = guided.wish().v / RATE
        guided.follow(Pose(x + way * math.cos(theta), y + way * math.sin(theta), theta))
        assert distances(guided.world.plan, [guided.robot.pose[:2]]) >= RADIUS
    assert math.hypot(guided.robot.pose.x - DENT.x, guided.robot.pose.y - DENT.y) > 0.2


def test_at_the_dock_the_robot_charges():
    guided = guided_world(0.5, plan=room(8.0, 3.0, start=BEGIN, dock=Pose(7.8, 1.5, 0.0)))
    guided.jump(Pose(7.79, 1.5, 0.05))
    assert guided.robot.is_docked
    assert guided.robot.battery.current == pytest.approx(1.25)


def test_after_a_reset_the_robot_can_be_guided_on():
    guided = guided_world(0.5)
    drive(guided, 4.8, 24.0)
    guided.reset()
    assert (guided.world.floor.coverage, guided.robot.battery.state_of_charge) == (0.0, 0.5)
    guided.jump(Pose(6.0, 1.5, 0.0))
    drive(guided, -1.0, 8.0)
    assert guided.robot.distance == pytest.approx(1.0)


def test_after_a_reset_the_robot_would_start_from_rest():
    guided = guided_world()
    assert list(wishes(guided, 0.5, 30))[-1] > 0.4
    guided.reset()
    assert guided.wish() == (0.0, 0.0)
    assert list(wishes(guided, 0.5, 2)) == pytest.approx([0.0144, 0.0288])


def test_a_pose_is_checked_against_the_walls_but_not_against_the_robot_itself():
    guided = guided_world()
    assert guided.check(Pose(1.1, 1.5, 7.0)) == pytest.approx((1.1, 1.5, 7.0 - 2.0 * math.pi))
    with pytest.raises(WorldError, match=r'^room: pose at \(0\.10, 1\.50\) m is 0\.100 m from the nearest wall'):
        guided.check(Pose(0.1, 1.5, 0.0))


def test_time_passes_in_no_other_way_than_by_follow_and_jump():
    guided = guided_world()
    guided.follow(BEGIN)
    guided.jump(BEGIN)
    assert guided.world.tick == 2
    assert not isinstance(guided, World) and not hasattr(guided, 'step')


@pytest.mark.parametrize('reset', [lambda guided: guided.reset(), lambda guided: guided.world.reset()])
def test_after_a_reset_the_wheels_begin_at_rest(reset):
    guided = guided_world()
    for _ in range(100):
        guided.robot.command(0.5, 0.0, guided.world.tick)
        guided.wish()
    reset(guided)
    guided.robot.command(0.5, 0.0, guided.world.tick)
    assert guided.wish().v == pytest.approx(0.9 / RATE)
