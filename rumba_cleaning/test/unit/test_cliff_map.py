"""What a robot knows of the floor and its edges by its wheels and its cliff sensors."""

import math

import numpy as np
import pytest
from rooms import quiet, room

from rumba_cleaning.edges.cliff_map import LAG, SEEN, CliffMap
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.settings.robot_config import RobotConfig

ROBOT = RobotConfig()
NONE = (False,) * 4
STEP = 0.01  # [m] from one reading to the next


def at(x):
    """The robot, which drives along the x axis."""
    return Pose(x, 1.0, 0.0)


def passed(readings, start=0.5):
    """A cliff map after so many readings (cliffs), and where the robot is then."""
    cliff_map = CliffMap(room(4.0, 2.0, 0.02), ROBOT)
    cliff_map.note(at(start), NONE, False)
    for number, cliffs in enumerate(readings, 1):
        cliff_map.note(at(start + number * STEP), cliffs, False)
    return cliff_map, start + len(readings) * STEP


def is_known(cliff_map, x, y):
    """Whether there is floor for sure at a point that is so far ahead, and to the left, of the axis of the wheels."""
    return cliff_map.are_known(np.array([(x, 1.0 + y)]), 0)


def between(first):
    """The middle between two neighbouring sensors, as x and y from the middle of the robot [m]."""
    places = [(ROBOT.cliff.distance * math.cos(angle), ROBOT.cliff.distance * math.sin(angle))
              for angle in ROBOT.cliff.angles[first:first + 2]]
    return tuple(np.mean(places, axis=0))


@pytest.mark.parametrize('first', [0, 1, 2])
def test_floor_between_two_sensors_is_known_once_they_are_so_far_on_that_a_corner_would_be_under_one(first):
    ahead, aside = between(first)
    count = 20
    cliff_map, x = passed([NONE] * count)
    assert not is_known(cliff_map, x + ahead - 0.5 * LAG, aside)
    assert is_known(cliff_map, x + ahead - 1.5 * LAG, aside)


@pytest.mark.parametrize('first', [0, 1, 2])
@pytest.mark.parametrize('turn, is_seen', [(0.4, False), (0.8, True)])
def test_if_it_turns_there_it_is_known_once_one_of_them_came_to_where_the_other_was(first, turn, is_seen):
    left, right = ROBOT.cliff.angles[first:first + 2]
    angle = left - 0.1
    away = ROBOT.cliff.distance * math.cos(0.5 * (left - right)) / math.cos(angle - 0.5 * (left + right))
    cliff_map, x = passed([NONE] * 20)
    for theta in np.arange(0.0, turn, 0.04):
        cliff_map.note(at(x)._replace(theta=theta), NONE, False)
    assert is_known(cliff_map, x + away * math.cos(angle), away * math.sin(angle)) is is_seen


def test_sensors_may_all_be_at_one_place():
    robot = quiet(cliff={'inner_angle': 0.0, 'outer_angle': 0.0})
    cliff_map = CliffMap(room(4.0, 2.0, 0.02), robot)
    for theta in (0.0, 0.1, 0.2):
        cliff_map.note(at(2.0)._replace(theta=theta), NONE, False)
    assert cliff_map.are_known(np.array([(2.0, 1.0)]), 0)


def test_floor_between_two_sensors_is_not_known_if_one_of_them_then_sees_a_cliff():
    ahead, aside = between(0)
    cliff_map, x = passed([NONE] * 20)
    spot = x + ahead - 0.5 * LAG
    for number in range(1, 15):
        cliff_map.note(at(x + number * STEP), (True, False, False, False), False)
    assert not is_known(cliff_map, spot, aside)
    assert is_known(cliff_map, spot, -aside)


def test_a_robot_that_passes_an_edge_between_its_wheels_knows_no_floor_there():
    cliff_map, x = passed([(False, True, True, False)] * 60)
    half = 0.5 * ROBOT.drive.wheel_base
    assert is_known(cliff_map, x, half) and is_known(cliff_map, x, -half)
    assert not is_known(cliff_map, x, 0.0)


def test_beside_floor_that_only_a_wheel_was_on_a_wary_robot_knows_none():
    cliff_map, x = passed([(False, True, True, False)] * 60)
    beside = np.array([(x, 1.0 + 0.5 * ROBOT.drive.wheel_base + 0.02)])
    assert cliff_map.are_known(beside, 2) and not cliff_map.are_known(beside, 2, True)
    cliff_map, x = passed([NONE] * 60)
    assert cliff_map.are_known(beside, 2, True)


@pytest.mark.parametrize('hole, is_open, is_closed', [
    (0.03, False, True), (0.06, False, False), (0.03, True, False)])  # [m]; a way of unknown floor leads out of it
def test_small_holes_in_the_floor_that_sensors_saw_are_closed(hole, is_open, is_closed):
    cliff_map = CliffMap(room(4.0, 2.0, 0.02), ROBOT)
    x, y = np.mgrid[-0.15:0.15:0.005, -0.15:0.15:0.005]
    is_seen = (np.hypot(x, y) > hole) & ~(is_open & (abs(y) < 0.015) & (x > 0.0))
    cliff_map._stamp(np.stack([x[is_seen], y[is_seen]], axis=-1), Pose(1.0, 1.0, 0.0))
    middle = np.array([(1.0, 1.0)])
    assert not cliff_map.are_known(middle, 0)
    cliff_map.close_holes(1.1, 1.05)
    assert cliff_map.are_known(middle, 0, True) == is_closed
    assert not cliff_map.are_known(middle + (0.2, 0.0), 0)


def test_holes_are_closed_at_the_rim_of_the_map_too():
    cliff_map = CliffMap(room(4.0, 2.0, 0.02), ROBOT)
    for x, y in ((0.0, 0.0), (4.0, 2.0)):
        cliff_map.close_holes(x, y)
        assert not cliff_map.are_known(np.array([(x, y)]), 0)


def test_an_edge_beside_one_that_was_seen_is_no_edge_that_is_known_already():
    cliff_map, x = passed([NONE] * 20)
    reach, angle = ROBOT.cliff.distance, ROBOT.cliff.angles[0]
    outer = reach * math.cos(angle), reach * math.sin(angle)
    for number, is_over in enumerate([True, False, False, True], 1):  # the last one 0.03 m farther
        cliff_map.note(at(x + number * STEP), (is_over, False, False, False), False)
    first, last = (x + outer[0] + (number - 0.5) * STEP for number in (1, 4))
    assert [place for place, _ in cliff_map.seen] == pytest.approx([first, last])
    assert cliff_map.clearance_at(last, 1.0 + outer[1]) < 0.5 * SEEN


@pytest.mark.parametrize('before, is_new', [(0.04, False), (0.07, True)])
def test_a_sensor_that_has_come_far_over_an_edge_of_the_map_has_found_no_other_edge(before, is_new):
    """The edge of the map is 2 mm before where the sensor is at last, or beyond that."""
    edge, way = 3.0, 0.05
    cliff_map = CliffMap(room(4.0, 2.0, 0.01, cliff=(edge, 0.0, 4.0, 2.0)), ROBOT)
    x = edge + 0.042 - before - ROBOT.cliff.distance * math.cos(ROBOT.cliff.angles[1])
    cliff_map.note(at(x - way), NONE, False)
    cliff_map.note(at(x), (False, True, False, False), False)
    assert bool(cliff_map.seen) == is_new
