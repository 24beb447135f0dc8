"""Cliffs: what the sensors see of them, and how a robot falls."""

import math

import pytest
from pytest import approx
from rooms import alone, drive, drove, room

from rumba_sim.model.common.errors import WorldError
from rumba_sim.model.common.geometry import Pose

HOLE = (2.0, 1.0, 3.0, 2.5)
SMALL = (1.4, 1.04, 1.42, 1.06)
AT_ONCE = {'acceleration': 1000.0}


def around(x, y):
    """A small hole around a point."""
    return x - 0.03, y - 0.03, x + 0.03, y + 0.03


@pytest.mark.parametrize('theta', [0.0, 1.0, -2.5])
@pytest.mark.parametrize('sensor, angle', enumerate((0.9, 0.26, -0.26, -0.9)))
def test_each_cliff_sensor_sees_the_floor_under_it(theta, sensor, angle):
    x, y = 2.0 + 0.165 * math.cos(theta + angle), 1.5 + 0.165 * math.sin(theta + angle)
    world, robot = alone(Pose(1.0, 1.0, theta), room(4.0, 3.0, 0.01, cliff=around(x, y)))
    assert world.cliffs('rumba') == [False] * 4
    robot.state['x'], robot.state['y'] = 2.0, 1.5  # where a teleport would be refused
    assert world.cliffs('rumba') == [index == sensor for index in range(4)]


def test_a_sensor_tells_of_a_cliff_for_as_long_as_it_holds_that():
    """A hole of 2 cm passes under a front sensor between two readings, and between the wheels."""
    world, _ = alone(Pose(1.0, 1.0, 0.0), room(4.0, 2.0, 0.01, cliff=SMALL), cliff={'hold': 0.1})
    seen, over = [], []
    for pose in drive(world, 0.4, 0.0, 70):
        x = pose.x + 0.165 * math.cos(0.32)
        seen.append(world.cliffs('rumba')[1])
        over.append(1.4 <= x < 1.42)
    assert 2 <= sum(over) <= 3  # at 8 mm a tick
    first = over.index(True)
    assert seen == [first <= tick < first + sum(over) + 4 for tick in range(70)]


def test_a_teleport_has_sensors_forget_what_they_held():
    world, _ = alone(Pose(1.6, 1.8, 0.0), room(4.0, 3.0, 0.02, cliff=HOLE), cliff={'hold': 1.0})
    drove(world, 0.3, 0.0, 80)
    assert world.cliffs('rumba')[1]
    world.teleport('rumba', Pose(1.0, 0.5, 0.0))
    world.step()
    assert world.cliffs('rumba') == [False] * 4


def test_a_sensor_without_hold_tells_of_what_it_is_over():
    world, _ = alone(Pose(1.0, 1.0, 0.0), room(4.0, 2.0, 0.01, cliff=SMALL), cliff={'hold': 0.0})
    for pose in drive(world, 0.4, 0.0, 70):
        assert world.cliffs('rumba')[1] == (1.4 <= pose.x + 0.165 * math.cos(0.32) < 1.42)


def test_front_sensors_warn_before_a_wheel_is_over_the_edge():
    world, robot = alone(Pose(1.2, 1.8, 0.0), room(4.0, 3.0, 0.02, cliff=HOLE), drive=AT_ONCE)
    first = {}
    for pose in drive(world, 0.2, 0.0, 300):
        for sensor, sees in enumerate(world.cliffs('rumba')):
            if sees:
                first.setdefault(sensor, pose.x)
        if robot.has_fallen:
            first.setdefault('fallen', pose.x)
    assert first == approx({
        1: 2.0 - 0.165 * math.cos(0.32), 2: 2.0 - 0.165 * math.cos(0.32),
        0: 2.0 - 0.165 * math.cos(0.95), 3: 2.0 - 0.165 * math.cos(0.95), 'fallen': 2.0}, abs=0.005)


def test_a_fallen_robot_comes_to_rest_and_stays_until_it_is_teleported():
    world, robot = alone(Pose(1.2, 1.8, 0.0), room(4.0, 3.0, cliff=HOLE))
    rest = drove(world, 0.3, 0.0, 300)
    assert robot.has_fallen and robot.twist == (0.0, 0.0)
    assert rest.x == approx(2.0 + 0.3 ** 2 / 0.9 / 2.0, abs=0.01)
    drove(world, -0.5, 1.0, 100)
    assert robot.has_fallen and robot.pose == rest
    world.teleport('rumba', Pose(1.0, 0.5, 0.0))
    assert not robot.has_fallen
    after = drove(world, 0.2, 0.0, 100)
    assert not robot.has_fallen and after.x > 1.3


@pytest.mark.parametrize('y, theta, falls', [
    (0.9, 0.0, True), (0.86, 0.0, False),  # the left wheel is 0.1175 m to the left of the middle
    (2.6, 0.0, True), (2.64, 0.0, False)])
def test_one_wheel_is_enough_to_fall(y, theta, falls):
    world, robot = alone(Pose(0.5, y, theta), room(5.0, 4.0, 0.02, cliff=HOLE))
    drove(world, 0.3, 0.0, 500)
    assert robot.has_fallen == falls


def test_a_fast_robot_does_not_get_across_a_narrow_ditch():
    world, robot = alone(Pose(1.0, 1.0, 0.0), room(5.0, 2.0, 0.02, cliff=(2.0, 0.0, 2.06, 2.0)))
    drove(world, 0.5, 0.0, 300)
    assert robot.has_fallen and robot.twist == (0.0, 0.0) and robot.pose.x < 2.2


def test_a_teleport_to_a_cliff_is_refused():
    world, robot = alone(Pose(1.0, 0.5, 0.0), room(4.0, 3.0, cliff=HOLE))
    with pytest.raises(WorldError, match=r'^room: pose at \(2\.50, 1\.50\) m is 0\.000 m from the nearest cliff'):
        world.teleport('rumba', Pose(2.5, 1.5, 0.0))
    assert robot.pose[:2] == (1.0, 0.5)
