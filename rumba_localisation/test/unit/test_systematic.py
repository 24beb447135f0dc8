"""The systematic error of a laser, by the bends of walls; rooms and pillars are seen in closed form."""

import math

import numpy as np
import pytest
from rooms import room
from scans import RADIUS, error

from rumba_localisation.localiser import Localiser
from rumba_localisation.mapping.believed_plan import believed_plan
from rumba_localisation.mapping.mapper import Mapper
from rumba_localisation.scan import Scan, scan_of
from rumba_localisation.systematic import FEWEST, Systematic, lengthened
from rumba_sim.model.common.config import updated
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.maps.floor_plan import OCCUPIED
from rumba_sim.model.settings.mounting import Mounting
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation.world import World

STEP = math.radians(0.5)
WIDTH, HEIGHT = 4.0, 3.0  # [m] of the room
BIASES = pytest.mark.parametrize('bias', [-0.06, -0.03, 0.03, 0.06])


def to_walls(x, y, angles):
    """Distances from a point in the room to its walls [m]."""
    cos, sin = np.cos(angles), np.sin(angles)
    with np.errstate(divide='ignore'):
        return np.minimum(np.where(cos > 0.0, (WIDTH - x) / cos, -x / cos),
                          np.where(sin > 0.0, (HEIGHT - y) / sin, -y / sin))


def learnt(bias=0.0, relative=0.0, noise=0.02, clockwise=False, mounting=Mounting(0.1, -0.05, 2.0), seen=to_walls):
    """What is known of a laser after scans from places all over the room."""
    systematic, random = Systematic(), np.random.default_rng(3)
    angles = (-STEP if clockwise else STEP) * np.arange(720)
    for _ in range(200):
        x, y, turn = random.uniform((0.5, 0.5, -3.0), (WIDTH - 0.5, HEIGHT - 0.5, 3.0))
        ranges = seen(x, y, angles + turn) * (1.0 + relative) + bias + noise * random.standard_normal(720)
        systematic.follow(scan_of(ranges, 0.0, angles[1], 12.0, 0.05, mounting))
    return systematic


@BIASES
@pytest.mark.parametrize('clockwise', [False, True])
def test_an_error_that_all_ranges_share_is_found_by_the_walls(bias, clockwise):
    assert learnt(bias, clockwise=clockwise).error == pytest.approx(bias, abs=0.006)


@pytest.mark.parametrize('noise, relative', [(0.005, 0.0), (0.02, 0.0), (0.03, 0.0), (0.01, 0.03), (0.01, -0.03)])
def test_a_laser_without_such_an_error_is_left_as_it_is_even_if_it_errs_in_proportion(noise, relative):
    assert learnt(0.0, relative, noise).error == 0.0


def to_round_pillars(x, y, angles):
    """As `to_walls`, in a room whose walls are beside half round pillars of 0.2 to 0.6 m, which bend as they please."""
    nearest = to_walls(x, y, angles)
    for number, along in enumerate(np.arange(0.4, WIDTH, 0.5)):
        radius = 0.2 + 0.1 * (number % 5)
        for across in (0.0, HEIGHT):
            by_x, by_y = along - x, across - y
            middle = by_x * np.cos(angles) + by_y * np.sin(angles)
            square = radius ** 2 - (by_x ** 2 + by_y ** 2 - middle ** 2)
            met = (square > 0.0) & (middle > 0.0)
            nearest[met] = np.minimum(nearest[met], np.maximum(middle[met] - np.sqrt(square[met]), 0.05))
    return nearest


def test_walls_that_are_bent_themselves_do_not_agree_on_an_error():
    assert learnt(seen=to_round_pillars).error == 0.0


def test_few_walls_tell_nothing():
    systematic, angles = Systematic(), STEP * np.arange(720)
    for _ in range(FEWEST // 5):  # four walls at most of each scan that is looked at
        systematic.follow(scan_of(to_walls(2.0, 1.0, angles) + 0.05, 0.0, STEP, 12.0))
    assert systematic.error == 0.0


def test_beams_are_longer_in_their_own_direction_and_never_end_behind_the_laser():
    scan = Scan(np.array([[1.1, 0.0], [0.1, -2.0], [0.12, 0.0]]), np.array([[0.1, 3.0]]), (0.1, 0.0))
    long, short = lengthened(scan, 0.05), lengthened(scan, -0.05)
    assert long.points == pytest.approx(np.array([[1.15, 0.0], [0.1, -2.05], [0.17, 0.0]]))
    assert short.points == pytest.approx(np.array([[1.05, 0.0], [0.1, -1.95], [0.1, 0.0]]))
    assert long.beyond == pytest.approx(np.array([[0.1, 3.05]])) and long.laser == scan.laser


def driven(bias, observe, seconds=60.0):
    """Drive in circles through a room by a laser of which all ranges err by the same; calls observe(odometry, scan)."""
    config = updated(RobotConfig(), {'laser': {'noise': 0.01}}, 'test')
    world = World(room(WIDTH, HEIGHT, 0.05), config, 50, 1)
    robot = world.spawn('rumba', Pose(1.0, 1.0, 0.0))
    for step in range(round(10 * seconds)):
        robot.command(0.3, 0.5 if step % 100 < 70 else -0.2, world.tick)
        world.step(5)
        ranges = world.scan('rumba')
        yield observe(robot.odometry, scan_of(ranges + bias, -math.pi, 2.0 * math.pi / len(ranges), 8.0)), robot


@BIASES
def test_a_map_is_as_wide_as_the_room_although_the_laser_errs(bias):
    mapper = Mapper(Pose(1.0, 1.0, 0.0))
    for _, robot in driven(bias, mapper.observe):
        pass
    plan = believed_plan(mapper.grid, 'map')
    rows, columns = np.nonzero(plan.occupancy == OCCUPIED)
    middle = abs(plan.origin[1] + (rows + 0.5) * plan.resolution - 0.5 * HEIGHT) < 0.5
    x = np.sort(plan.origin[0] + (columns[middle] + 0.5) * plan.resolution)
    left, right = np.median(x[x < 2.0]), np.median(x[x > 2.0])
    assert right - left == pytest.approx(WIDTH, abs=0.045)  # and off by twice the bias without
    assert error(mapper.pose(robot.odometry), robot.pose)[0] < 0.03


@BIASES
def test_a_robot_knows_its_place_on_a_map_although_the_laser_errs(bias):
    localiser = Localiser(room(WIDTH, HEIGHT, 0.05), RADIUS, 8.0)
    localiser.start_at(Pose(1.0, 1.0, 0.0))
    squares = [error(localiser.pose(robot.odometry), robot.pose)[0] ** 2
               for _, robot in driven(bias, localiser.observe)]
    assert localiser.systematic.error == pytest.approx(bias, abs=0.008)
    assert math.sqrt(np.mean(squares[300:])) < 0.015
