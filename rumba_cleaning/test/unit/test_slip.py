"""A robot that slides along what it touches, beside an edge, does not fall."""

import math

import numpy as np
import pytest
from drivers import Always, context_of, guarded, run, with_cliffs
from rooms import RADIUS, quiet, room

from rumba_cleaning.behaviour import Observation
from rumba_cleaning.behaviours.bounded import Bounded
from rumba_cleaning.behaviours.travel import Going, Travel
from rumba_cleaning.control import CONTROL_DT
from rumba_cleaning.edges.guard import Guard
from rumba_cleaning.edges.slip import NO_SLIP, Alignment, Slip, slipped
from rumba_cleaning.pose_source import DeadReckoning, scan_of_robot
from rumba_cleaning.route import Route
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.simulation.obstacle import Obstacle
from rumba_sim.model.simulation.world import World


@pytest.mark.parametrize('v', [0.1, 0.3, 0.45])
@pytest.mark.parametrize('aside', [0.1, 0.14, 0.18, 0.22, 0.25])
@pytest.mark.parametrize('gap', [0.178, 0.19, 0.21])
def test_a_robot_that_slides_along_an_obstacle_beside_an_edge_does_not_fall(gap, aside, v):
    """The obstacle turns it towards the edge, `gap` [m] to its left."""
    plan = with_cliffs(room(4.0, 2.0, 0.02, start=Pose(0.5, 0.5, 0.0)), (0.0, 1.4, 4.0, 2.0))
    y = 1.4 - gap
    world = World(plan, quiet(), obstacles=[Obstacle('post', Pose(2.0, y - aside, 0.0), 0.05, 0.09)])
    robot = world.spawn('rumba', Pose(1.2, y, 0.0))
    run(Bounded(Always(v, 0.0), 1000.0, context_of(plan, world)), world, seconds=12.0)
    assert robot.bumps >= 1 and not robot.has_fallen


class SometimesRight(DeadReckoning):
    """Counts the turns of its wheels, also while they slip, and finds its true place every second."""

    def __init__(self, has_laser):
        super().__init__()
        self._has_laser = has_laser
        self._looks = 0

    def __call__(self, world, name):
        if self._looks % 10 == 0:
            self._corrections.clear()
        self._looks += 1
        return super().__call__(world, name)._replace(scan=scan_of_robot(world, name) if self._has_laser else None)


@pytest.mark.parametrize('has_laser', [False, True])
@pytest.mark.parametrize('off_back', [0.2, 0.3, 0.4, 0.5])
@pytest.mark.parametrize('heading', [0.2, 0.3, 0.4])
def test_a_robot_that_backs_off_against_something_beside_an_edge_does_not_slide_over_it(heading, off_back, has_laser):
    """A sensor sees the edge on its left; of what somebody puts behind it, more to the right, it knows nothing."""
    plan = with_cliffs(room(4.0, 2.0, 0.02, start=Pose(0.5, 0.5, 0.0)), (0.0, 1.4, 4.0, 2.0))
    world = World(plan, quiet())
    robot = world.spawn('rumba', Pose(1.5, 1.2, heading))
    while not any(world.cliffs('rumba')):
        robot.command(0.05, 0.0, world.tick)
        world.step()
    pose, away, direction = robot.pose, RADIUS + 0.135, heading + math.pi + off_back
    world.add_obstacle(Obstacle('post', Pose(pose.x + away * math.cos(direction), pose.y + away * math.sin(direction),
                                             0.0), 0.3, 0.128))
    run(Bounded(Always(-0.1, 0.0), 1000.0, context_of(plan, world)), world, seconds=20.0,
        source=SometimesRight(has_laser))
    assert not robot.has_fallen
    if has_laser:  # it does not even push
        assert math.dist(robot.pose[:2], pose[:2]) < 0.02


def test_a_contact_beside_an_edge_is_one_with_something_unknown():
    plan = with_cliffs(room(4.0, 2.0, 0.02, start=Pose(0.5, 0.5, 0.0)), (0.0, 1.4, 4.0, 2.0))
    world = World(plan, quiet(), obstacles=[Obstacle('post', Pose(2.0, 1.06, 0.0), 0.05, 0.09)])
    robot = world.spawn('rumba', Pose(1.2, 1.22, 0.0))
    context = context_of(plan, world)
    travel = Travel(context, Route(np.array([[1.2, 1.22], [3.5, 1.22]]), np.array([0.3])))
    farthest = 0.0
    for _ in guarded(Guard(context), world, lambda observation: travel.command(observation, True)):
        if travel.going is not Going.ON:
            break
        farthest = max(farthest, robot.pose.x)
    assert travel.going is Going.BLOCKED and robot.pose.y == pytest.approx(1.22, abs=0.05) and not robot.has_fallen
    assert robot.pose.x < farthest - 0.02  # it backed off, although the contact and the edge are still near


@pytest.mark.parametrize('theta', [math.pi - 0.02, -math.pi + 0.02])
def test_a_robot_that_slides_to_its_left_does_so_too_while_its_heading_goes_past_a_half_turn(theta):
    last, here = Pose(1.5, 1.0, theta), Pose(1.5 - 0.3 * CONTROL_DT, 1.0 - 0.05 * CONTROL_DT, -theta)
    assert slipped(last, Observation(CONTROL_DT, here), 0.3) == pytest.approx((0.05, 1.0), abs=1e-6)


@pytest.mark.parametrize('aside, turn', [(0.08, 0.28), (-0.08, -0.28), (0.02, 0.0)])
def test_a_robot_that_slides_askew_is_to_turn_until_it_is_along_the_wall(aside, turn):
    alignment = Alignment()
    assert alignment.turn(Pose(0.97, 1.0, 3.0), Slip(aside, 0.95), 0.3) == 0.0
    assert alignment.turn(Pose(1.0, 1.0, 3.0), Slip(aside, 0.95), 0.3) == pytest.approx(turn, abs=0.01)
    assert alignment.turn(Pose(1.0, 1.0, 3.0 + 0.5 * turn), NO_SLIP, 0.0) == pytest.approx(0.5 * turn, abs=0.01)
    for theta in (3.0 + 0.9 * turn, 3.0):  # once it is along the wall, it is not to turn back
        assert alignment.turn(Pose(1.0, 1.0, theta), NO_SLIP, 0.0) == 0.0


@pytest.mark.parametrize('before, after', [(NO_SLIP, NO_SLIP), (Slip(-0.08, 1.0), Slip(-0.08, 1.0))])
def test_a_robot_whose_pose_jumps_aside_once_is_not_to_turn_that_way(before, after):
    alignment = Alignment()
    for slip in (before, Slip(0.08, 1.0), after):
        assert alignment.turn(Pose(1.0, 1.0, 0.0), slip, 0.3) == 0.0


def test_a_robot_that_stands_and_is_pushed_aside_by_the_noise_of_its_pose_is_not_to_turn():
    alignment = Alignment()
    for _ in range(2):
        assert alignment.turn(Pose(1.0, 1.0, 0.0), Slip(0.002, 1.0), 0.0) == 0.0
