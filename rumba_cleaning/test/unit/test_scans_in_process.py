"""Scans of robots in process: when they come, and in which frame."""

import dataclasses
import math

import numpy as np
import pytest
from pytest import approx
from rooms import crooked

from rumba_cleaning.pose_source import Localised, Mapped, due_scan, scan_of_robot, seeing, truth
from rumba_sim.model.common.config import from_mapping
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.settings.laser_config import LaserConfig
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation.world import World

POSE = Pose(2.1, 1.3, 0.7)


def world_with(**laser):
    """A world with a robot whose laser has such settings."""
    config = dataclasses.replace(RobotConfig(), laser=from_mapping(LaserConfig, laser, 'test'))
    world = World(crooked(0.05, dock=Pose(3.7, 1.2, 0.0)), config, 50, seed=3)
    world.spawn('rumba', POSE)
    world.step()
    return world


@pytest.mark.parametrize('mounting', [
    {'yaw': 2.0}, {'yaw': -math.pi, 'upside_down': True}, {'clockwise': True}, {'first_angle': 1.0}])
def test_what_a_turned_laser_sees_is_where_one_that_looks_ahead_sees_it(mounting):
    straight, turned = (scan_of_robot(world_with(beams=180, noise=0.0, **settings), 'rumba').points
                        for settings in ({}, mounting))
    assert len(turned) == 180
    for point in turned:  # its beams lie between the others
        nearest = np.sort(np.hypot(*(straight - point).T))[:2]
        assert nearest[0] < 0.08, point


@pytest.mark.parametrize('mounting', [{}, {'x': 0.15, 'y': -0.1}, {'x': -0.1, 'yaw': 1.0, 'upside_down': True}])
def test_points_lie_on_walls_wherever_the_laser_is_mounted(mounting):
    world = world_with(noise=0.0, **mounting)
    points = scan_of_robot(world, 'rumba').points
    robot = world.robots['rumba'].pose
    cos, sin = math.cos(robot.theta), math.sin(robot.theta)
    x, y = robot.x + cos * points[:, 0] - sin * points[:, 1], robot.y + sin * points[:, 0] + cos * points[:, 1]
    assert max(world.plan.clearance_at(*point) for point in zip(x.tolist(), y.tolist())) < 0.03


@pytest.mark.parametrize('nothing', ['zero', 'nan', 'inf', 'rep117'])
def test_only_ranges_become_points(nothing):
    scan = scan_of_robot(world_with(nothing=nothing, range_min=0.5, range_max=1.5, dropouts=0.2), 'rumba')
    away = np.hypot(*scan.points.T)
    assert 50 < len(away) < 300 and away.min() > 0.49 and away.max() < 1.51
    assert (len(scan.beyond) > 0) == (nothing in ('inf', 'rep117'))
    assert np.hypot(*scan.beyond.T) == approx(1.5)


def test_scans_come_as_often_as_the_laser_turns():
    slow, fast = world_with(model='lds01'), world_with()
    came = []
    for _ in range(8):
        came.append((due_scan(slow, 'rumba') is not None, due_scan(fast, 'rumba') is not None))
        slow.step(5)
        fast.step(5)
    assert came == [(True, True), (False, True)] * 4


def test_sources_go_on_between_two_scans():
    world = world_with(model='urg04lx', rate=5.0)
    sources = Localised(world.plan, world, 'rumba'), Mapped(world, 'rumba'), seeing(truth)
    for step in range(4):
        for source in sources:
            belief = source(world, 'rumba')
            assert (belief.scan is not None) == (step % 2 == 0)
            assert math.hypot(belief.pose.x - POSE.x, belief.pose.y - POSE.y) < 0.02
        world.step(5)


def test_between_two_scans_of_a_slow_laser_the_localiser_believes_what_it_did():
    world = world_with(model='rplidar_a1', rate=1.0)
    source = Localised(world.plan, world, 'rumba')
    estimates = []
    for _ in range(21):
        source(world, 'rumba')
        estimates.append(source.localiser.estimate)
        world.robots['rumba'].command(0.3, 0.0, world.tick)
        world.step(5)
    changes = [step for step in range(1, 21) if estimates[step] is not estimates[step - 1]]
    assert changes == [10, 20]
