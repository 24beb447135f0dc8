"""A robot that something else moves: the model notices what it must, and says how the robot would drive."""

import math

import pytest
from rooms import room

from rumba_sim.model.geometry import Pose
from rumba_sim.model.guided_world import GuidedWorld
from rumba_sim.model.robot_config import OdometryConfig, RobotConfig
from rumba_sim.model.world import World

RATE = 62.5  # [Hz]
EXACT = RobotConfig(odometry=OdometryConfig(scale_error=0.0, noise=0.0, floor_traction=1.0))
BEGIN = Pose(1.0, 1.5, 0.0)


def guided(state_of_charge=1.0, brushes_up=False, plan=None, config=EXACT):
    """A robot in a room of 8 x 3 m."""
    return GuidedWorld(plan or room(8.0, 3.0, start=BEGIN), config, RATE, state_of_charge=state_of_charge,
                       brushes_up=brushes_up)


def drive(world, way, seconds):
    """Have the robot driven straight on; returns its pose at the end."""
    begin, ticks = world.robot.pose, round(seconds * RATE)
    for tick in range(1, ticks + 1):
        world.follow(Pose(begin.x + way * tick / ticks, begin.y, begin.theta))
    return world.robot.pose


def test_what_a_way_costs_and_cleans_is_that_of_a_robot_that_drives_it():
    """4.8 m at 0.2 m/s: 24 s of 0.19 + 0.5 + 0.3 + 0.7 * 0.2 / 0.3 A, and a strip as wide as the brush."""
    world = guided()
    assert drive(world, 4.8, 24.0) == pytest.approx((5.8, 1.5, 0.0))
    robot = world.robot
    current = 0.19 + 0.5 + 0.3 + 0.7 * 0.2 / 0.3
    assert robot.battery.current == pytest.approx(-current)
    assert robot.battery.charge == pytest.approx(2.7 - current * 24.0 / 3600.0, rel=1e-9)
    assert robot.distance == pytest.approx(4.8)
    assert robot.brush_time == pytest.approx(24.0)
    assert robot.twist == pytest.approx((0.2, 0.0))
    assert robot.odometry.x == pytest.approx(4.8, abs=0.001)
    assert world.floor.cleaned_area == pytest.approx(4.8 * 0.17, rel=0.2)


def test_a_robot_that_is_led_along_the_way_of_another_has_the_same_battery_floor_and_odometry():
    plan = room(8.0, 3.0, start=BEGIN)
    free, led = World(plan, RobotConfig(), seed=3), GuidedWorld(plan, RobotConfig(), seed=3)
    robot = free.spawn('rumba', BEGIN)
    for tick in range(1000):
        robot.command(0.25, 0.5 * math.cos(0.01 * tick), free.tick)
        free.step()
        led.follow(robot.pose)
    assert led.robot.battery.charge == pytest.approx(robot.battery.charge, rel=1e-6)
    assert led.floor.coverage == pytest.approx(free.floor.coverage, rel=1e-3)
    assert led.robot.odometry == pytest.approx(robot.odometry, abs=2e-3)
    assert led.robot.odometry != pytest.approx(robot.pose, abs=2e-3)
    assert led.robot.distance == pytest.approx(robot.distance, rel=1e-4)


def test_with_the_brushes_up_nothing_is_swept():
    world = guided(brushes_up=True)
    drive(world, 4.8, 24.0)
    assert (world.floor.coverage, world.robot.brush_time) == (0.0, 0.0)
    assert world.robot.battery.current == pytest.approx(-(0.19 + 0.3 + 0.7 * 0.2 / 0.3))


def test_an_empty_battery_sweeps_nothing():
    world = guided(state_of_charge=0.0)
    drive(world, 4.8, 24.0)
    assert world.floor.coverage == 0.0


def test_what_is_carried_drives_no_way_sweeps_nothing_and_its_odometry_does_not_notice():
    world = guided()
    drive(world, 1.0, 8.0)
    before, swept = world.robot.odometry, world.floor.cleaned_area
    world.robot.command(0.3, 0.0, world.tick)
    world.jump(Pose(6.0, 2.0, 2.0))
    robot = world.robot
    assert robot.pose == (6.0, 2.0, 2.0)
    assert robot.distance == pytest.approx(1.0)
    assert robot.odometry == before
    assert world.floor.cleaned_area == swept
    assert robot.twist == (0.0, 0.0)
    assert world.wish() == (0.0, 0.0)  # the command was for another place
    world.follow(Pose(6.0, 2.0, 2.0))
    assert (robot.distance, robot.odometry) == (pytest.approx(1.0), before)


def test_a_command_is_followed_as_fast_as_the_wheels_can_and_forgotten_in_time():
    """0.9 m/s^2 at 62.5 Hz are 0.0144 m/s a tick; more than 0.5 m/s is cut; 0.5 s are 31 ticks."""
    world = guided()
    wishes = []
    world.robot.command(0.9, 0.0, world.tick)
    for _ in range(80):
        wishes.append(world.wish().v)
        world.follow(world.robot.pose)
    assert wishes[:3] == pytest.approx([0.0144, 0.0288, 0.0432])
    assert max(wishes) == pytest.approx(0.0144 * 31)
    assert wishes[-1] == 0.0


def test_a_turn_is_cut_and_comes_with_its_sign():
    world = guided()
    for _ in range(80):
        world.robot.command(0.0, -5.0, world.tick)
        wish = world.wish()
        world.follow(world.robot.pose)
    assert wish == pytest.approx((0.0, -1.9))


def test_with_an_empty_battery_it_would_stand_still():
    world = guided(state_of_charge=0.0)
    world.robot.command(0.3, 0.5, world.tick)
    assert world.wish() == (0.0, 0.0)


@pytest.mark.parametrize('sign, theta', [(1.0, 0.0), (-1.0, math.pi)])
def test_it_stops_at_a_wall_feels_it_in_front_and_gets_away(sign, theta):
    world = guided()
    world.jump(Pose(7.5, 1.5, theta))
    x = 7.5
    for _ in range(150):
        world.robot.command(sign * 0.3, 0.0, world.tick)
        x += world.wish().v * math.cos(theta) / RATE
        world.follow(Pose(x, 1.5, theta))
    assert x == pytest.approx(8.0 - 0.17425, abs=0.002)
    assert world.robot.bumper == ((True, True) if sign > 0.0 else (False, False))
    for _ in range(60):
        world.robot.command(sign * -0.3, 0.0, world.tick)
        wish = world.wish()
        world.follow(world.robot.pose)
    assert sign * wish.v == pytest.approx(-0.3)


def test_at_the_dock_it_charges():
    world = guided(0.5, plan=room(8.0, 3.0, start=BEGIN, dock=Pose(7.8, 1.5, 0.0)))
    world.jump(Pose(7.79, 1.5, 0.05))
    assert world.robot.is_docked
    assert world.robot.battery.current == pytest.approx(1.25)


def test_after_a_reset_it_is_led_on():
    world = guided(0.5)
    drive(world, 4.8, 24.0)
    world.reset()
    assert (world.floor.coverage, world.robot.battery.state_of_charge) == (0.0, 0.5)
    world.jump(Pose(6.0, 1.5, 0.0))
    drive(world, -1.0, 8.0)
    assert world.robot.distance == pytest.approx(1.0)
