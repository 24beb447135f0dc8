"""Near an edge that no map shows, a robot backs off along the way that it came by."""

import itertools
import math

import pytest
from drivers import context_of, guarded, with_cliffs
from rooms import RADIUS, quiet, room

from rumba_cleaning.behaviour import Command
from rumba_cleaning.control import CONTROL_DT, observe
from rumba_cleaning.edges.cliff_map import SEEN
from rumba_cleaning.edges.guard import Guard
from rumba_cleaning.pose_source import seeing, truth
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.simulation.obstacle import Obstacle
from rumba_sim.model.simulation.world import World

BACK = (-0.1, 0.0)


def world_with(pits, start):
    """A world with pits in boxes [m] that the context does not know, and both."""
    plan = room(3.0, 2.0, 0.01, start=Pose(0.5, 0.5, 0.0))
    world = World(with_cliffs(plan, *pits), quiet())
    world.spawn('rumba', start)
    return world, context_of(plan, world)


def poses(world, guard, command, seconds, until=lambda observation: False):
    """Where the robot is while the guard is asked for one command, until something is so."""
    for _ in guarded(guard, world, lambda _: Command(*command), seconds, seeing(truth)):
        yield world.robots['rumba'].pose
        if until(observe(world, 'rumba', CONTROL_DT)):
            return


def sees_edge(observation):
    """Whether a cliff sensor does."""
    return any(observation.cliffs)


@pytest.mark.parametrize('turned', [0.5, 0.8, 1.1])
def test_after_a_bend_it_goes_back_by_the_bend_and_comes_no_nearer_to_a_pit_beside_its_way(turned):
    """The outer sensor passes the pit on its left 5 mm off, and so never sees it; ahead, it sees another one."""
    start = Pose(1.139, 0.5, 0.5 * math.pi)
    world, context = world_with([(0.3, 0.75, 1.0, 1.4), (1.0, 1.3, 2.5, 1.6)], start)
    guard, robot = Guard(context), world.robots['rumba']
    list(poses(world, guard, (0.2, 0.0), 2.0))
    list(poses(world, guard, (0.15, -1.0), turned))
    list(poses(world, guard, (0.15, 0.0), 4.0, sees_edge))
    way = list(poses(world, guard, BACK, 6.0))
    list(poses(world, guard, (0.0, 1.9), 2.0))
    assert context.cliff_map.seen and not robot.has_fallen
    assert way[-1].theta == pytest.approx(start.theta, abs=0.03) and min(pose.x for pose in way) > start.x - 0.01


@pytest.mark.parametrize('turned', [0.5, 0.8])
def test_a_wall_along_its_way_does_not_keep_it_from_going_back(turned):
    """It has turned from the wall, which is behind it at a slant then, and very near."""
    y = 2.0 - RADIUS - 0.015
    world, context = world_with([(1.5, 0.5, 2.5, 2.0)], Pose(0.6, y, 0.0))
    guard, robot = Guard(context), world.robots['rumba']
    list(poses(world, guard, (0.2, 0.0), 8.0, sees_edge))
    list(poses(world, guard, (0.0, -1.0), turned))
    start = robot.pose
    way = list(poses(world, guard, BACK, 4.0))
    assert sees_edge(observe(world, 'rumba', CONTROL_DT)) is False
    assert start.x - robot.pose.x > 0.15 and max(abs(pose.y - y) for pose in way) < 0.01 and not robot.has_fallen


def test_a_wall_right_behind_it_does_not_keep_it_from_turning_back():
    """Nearly on the spot: its middle comes back by no more than a centimetre, along the wall."""
    y = RADIUS + 0.015
    world, context = world_with([(1.5, 0.0, 2.5, 1.0)], Pose(0.6, y, 0.0))
    guard, robot = Guard(context), world.robots['rumba']
    list(poses(world, guard, (0.2, 0.0), 8.0, sees_edge))
    list(poses(world, guard, BACK, 0.8))
    list(poses(world, guard, (0.01, 1.0), 1.5))
    turned = robot.pose
    list(poses(world, guard, BACK, 1.0))
    assert turned.theta > 1.2 and robot.pose.theta < turned.theta - 0.3
    assert math.dist(turned[:2], robot.pose[:2]) < 0.015


def test_a_robot_without_a_laser_that_slides_along_a_wall_as_it_backs_off_stays_out_of_the_gap_beside_a_pit():
    pit = 0.33, 0.2, 0.7, 0.8
    plan = with_cliffs(room(3.0, 2.0, 0.01), pit)
    world = World(plan, quiet())
    world.spawn('rumba', Pose(RADIUS + 0.01, 0.95, 1.0))
    guard, robot = Guard(context_of(plan, world)), world.robots['rumba']
    lowest = min(robot.pose.y for _ in guarded(guard, world, lambda _: Command(*BACK), 8.0))
    assert lowest > 0.85


def test_what_moved_behind_it_meanwhile_keeps_it_from_going_back():
    world, context = world_with([(1.5, 0.5, 2.5, 1.8)], Pose(0.6, 1.0, 0.0))
    guard, robot = Guard(context), world.robots['rumba']
    list(poses(world, guard, (0.2, 0.0), 8.0, sees_edge))
    list(poses(world, guard, (0.0, 0.0), 1.0))
    world.add_obstacle(Obstacle('pet', Pose(robot.pose.x - RADIUS - 0.11, 1.0, 0.0), 0.3, 0.1))
    start = robot.pose
    list(poses(world, guard, BACK, 4.0))
    assert math.dist(start[:2], robot.pose[:2]) < 0.01


def test_far_from_edges_it_backs_off_as_it_is_told():
    world, context = world_with([(2.6, 0.1, 2.8, 0.3)], Pose(0.6, 1.0, 0.0))
    guard, robot = Guard(context), world.robots['rumba']
    list(itertools.chain(poses(world, guard, (0.1, 1.0), 1.0), poses(world, guard, (0.0, 0.0), 0.5)))
    heading = robot.pose.theta
    list(poses(world, guard, BACK, 2.0))
    assert robot.pose.theta == pytest.approx(heading, abs=1e-9)


@pytest.mark.parametrize('beside, goes', [(0.017, True), (0.012, True), (0.008, False)])
def test_an_edge_close_beside_the_way_by_which_it_came_does_not_keep_it_from_one_ahead(beside, goes):
    """On its trail a wheel has been so near to it before, if it lies where it was seen."""
    world, context = world_with([(2.6, 0.1, 2.8, 0.3)], Pose(0.6, 1.0, 0.0))
    guard, robot = Guard(context), world.robots['rumba']
    list(itertools.chain(poses(world, guard, (0.1, 0.0), 5.0), poses(world, guard, (0.0, 0.0), 1.0)))
    start, half = robot.pose, 0.5 * world.config.drive.wheel_base
    context.cliff_map._see(start.x - 0.012, start.y + half + SEEN + beside)
    context.cliff_map._see(start.x + 0.12, start.y)
    list(poses(world, guard, BACK, 3.0))
    assert start.x - robot.pose.x > 0.15 if goes else start.x - robot.pose.x < 0.012


@pytest.mark.parametrize('seconds', [0.2, 0.3])
def test_a_robot_that_turns_fast_when_it_is_to_go_back_goes_back_by_its_way_once_its_wheels_can(seconds):
    """Until these have changed their direction, it is farther off its way than a robot that was pushed."""
    world, context = world_with([(1.5, 0.5, 2.5, 1.8)], Pose(0.6, 1.0, 0.0))
    guard, robot = Guard(context), world.robots['rumba']
    list(poses(world, guard, (0.2, 0.0), 8.0, sees_edge))
    list(poses(world, guard, BACK, 1.0))
    list(poses(world, guard, (0.0, -1.9), seconds))
    turned = robot.pose
    list(poses(world, guard, BACK, 3.0))
    assert turned.theta < -0.1 and abs(robot.pose.theta) < 0.03
    assert turned.x - robot.pose.x > 0.1 and not robot.has_fallen
