"""A robot that edges hold turns either way round and drives away, if what is nearer does not help."""

import math

import numpy as np
import pytest
from drivers import context_of, with_cliffs
from rooms import RADIUS, quiet, room

from rumba_cleaning.behaviour import STOP, Command
from rumba_cleaning.control import CONTROL_DT, CONTROL_TICKS
from rumba_cleaning.edges.cliff_map import SPARE
from rumba_cleaning.edges.departure import LENGTH, Departure, Search
from rumba_cleaning.edges.preview import Preview
from rumba_cleaning.edges.release import PATIENCE, Release
from rumba_cleaning.edges.slip import NO_SLIP
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation.world import World

HALF = 0.5 * RobotConfig().drive.wheel_base
PLACE = Pose(3.0 - RADIUS - 0.01, 1.0, 0.0)  # a wall is right before it
RESERVE = 0.01  # [m]


def knowing(pose, *pits):
    """What a robot at a pose knows of a room with pits in boxes [m], and its world, in which it can stand there."""
    plan = room(4.0, 2.0, 0.01, [(3.0, 0.0, 4.0, 2.0)])
    world = World(plan, quiet())
    world.spawn('rumba', pose)
    return context_of(with_cliffs(plan, *pits) if pits else plan, world), world


def pit_behind(side):
    """A pit behind one wheel of a robot at the place, as a box [m]."""
    x, y = PLACE.x - 0.083, PLACE.y + side * 0.083
    return x - 0.04, y - 0.04, x + 0.04, y + 0.04


def search(context):
    """A search by what a robot knows."""
    return Search(context.cliff_map, RobotConfig().drive)


def distance(point, box):
    """Of a point to a box [m], 0 inside."""
    left, bottom, right, top = box
    return math.hypot(max(left - point[0], 0.0, point[0] - right), max(bottom - point[1], 0.0, point[1] - top))


def wheels(pose):
    """The points under them [m]."""
    aside = -HALF * math.sin(pose.theta), HALF * math.cos(pose.theta)
    return [(pose.x + side * aside[0], pose.y + side * aside[1]) for side in (1, -1)]


@pytest.mark.parametrize('side', [1, -1])
def test_where_a_pit_closes_one_way_round_it_turns_the_other_way_and_keeps_its_wheels_off_the_pit(side):
    box = pit_behind(side)
    found = search(knowing(PLACE, box)[0]).find(PLACE, RESERVE, HALF + SPARE, 0)
    assert found.side == -side
    turn = (-side * (found.heading - PLACE.theta)) % (2.0 * math.pi)
    turns = [PLACE._replace(theta=-side * angle) for angle in np.linspace(0.0, turn, 50)]
    lines = [Pose(PLACE.x + way * math.cos(found.heading), PLACE.y + way * math.sin(found.heading), found.heading)
             for way in found.way * np.linspace(0.0, LENGTH, 50)]
    assert min(distance(wheel, box) for pose in turns + lines for wheel in wheels(pose)) > RESERVE - 0.005
    assert lines[-1].x < 3.0 - RADIUS and distance(lines[-1][:2], box) > HALF


def test_the_command_of_a_departure_turns_first_and_turns_back_if_it_has_turned_too_far():
    found = search(knowing(PLACE, pit_behind(1))[0]).find(PLACE, RESERVE, HALF + SPARE, 0)
    assert found.command(PLACE).v == 0.0 and found.command(PLACE).w < 0.0
    too_far = PLACE._replace(theta=found.heading - 0.1)
    assert found.command(too_far).v == 0.0 and found.command(too_far).w > 0.0
    there = PLACE._replace(theta=found.heading)
    assert found.command(there).v * found.way > 0.0 and found.command(there).w == 0.0


@pytest.mark.parametrize('side', [1, -1])
@pytest.mark.parametrize('turn', [0.5, 3.0, 5.5])
def test_it_turns_the_way_that_is_open_however_far(side, turn):
    assert Departure(PLACE.theta + side * turn, side, 1).command(PLACE).w * side > 0.0


def test_it_does_not_turn_past_a_pit():
    """Along the wall it could go, both ways."""
    boxes = [(left - 0.05, bottom, right, top) for left, bottom, right, top in map(pit_behind, (1, -1))]
    assert search(knowing(PLACE, *boxes)[0]).find(PLACE, RESERVE, HALF + SPARE, 0) is None


def test_where_it_ends_it_can_turn():
    edge, pose = 2.0, Pose(1.6, 1.0, 0.0)
    found = search(knowing(pose, (edge, 0.0, 3.0, 2.0))[0]).find(pose, RESERVE, HALF + SPARE, 0)
    assert pose.x + found.way * LENGTH * math.cos(found.heading) < edge - HALF


def test_between_edges_that_let_it_neither_turn_nor_go_on_it_finds_nothing():
    pose = Pose(1.5, 1.0, 0.5 * math.pi)
    boxes = (1.0, 0.5, 1.36, 1.5), (1.64, 0.5, 2.0, 1.5), (1.0, 1.2, 2.0, 1.5), (1.0, 0.5, 2.0, 0.8)
    assert search(knowing(pose, *boxes)[0]).find(pose, RESERVE, HALF + SPARE, 0) is None


def test_once_it_has_met_a_cliff_that_no_map_shows_it_goes_only_where_it_knows_floor():
    context, _ = knowing(PLACE)
    assert search(context).find(PLACE, RESERVE, HALF + SPARE, 0) is not None
    context.cliff_map._see(0.5, 0.5)
    assert search(context).find(PLACE, RESERVE, HALF + SPARE, 0) is None


@pytest.mark.parametrize('may_back', [True, False])
def test_held_for_long_between_a_wall_and_a_pit_to_which_it_is_turned_again_and_again_a_robot_departs(may_back):
    """Its way out is to turn as far as it can from the pit, and then to go back along the wall."""
    place = Pose(1.5, 2.0 - RADIUS - 0.005, math.radians(-95.0))
    box = place.x + 0.107, place.y - 0.6, place.x + 0.7, place.y - 0.043
    context, world = knowing(place, box)
    release = Release(context.cliff_map, Preview(world.config.drive), HALF + SPARE, 0)
    robot, poses = world.robots['rumba'], []
    while world.time < 40.0:
        speeds = robot.twist[0] - HALF * robot.twist[1], robot.twist[0] + HALF * robot.twist[1]
        command = Command(0.0, -0.5) if distance(wheels(robot.pose)[0], box) > 0.04 else STOP
        if release.is_due(robot.pose, command == STOP and speeds == (0.0, 0.0), CONTROL_DT):
            is_along = abs(robot.pose.theta) < 0.5
            command = release.way_out(robot.pose, speeds, lambda _: [NO_SLIP], may_back and is_along) or command
        robot.command(*command[:2], world.tick)
        world.step(CONTROL_TICKS)
        poses.append(robot.pose)
    assert (max(math.dist(pose[:2], place[:2]) for pose in poses) > 0.29) == may_back
    assert min(distance(wheel, box) for pose in poses for wheel in wheels(pose)) > RESERVE - 0.005


def test_a_robot_that_gains_nothing_on_its_way_out_as_it_pushes_against_a_wall_is_left_to_its_behaviour_again():
    box = PLACE.x - 0.15, 0.95, PLACE.x + 0.03, 1.1
    context, world = knowing(PLACE, box)
    release = Release(context.cliff_map, Preview(world.config.drive), HALF + SPARE, 0)
    out, pushed = STOP, 0.0
    for _ in range(round(PATIENCE / CONTROL_DT) + 1):
        release.is_due(PLACE, True, CONTROL_DT)
    while out is not None and pushed < 60.0:
        assert release.is_due(PLACE, False, CONTROL_DT)
        out = release.way_out(PLACE, (0.0, 0.0), lambda _: [NO_SLIP], True)
        pushed += CONTROL_DT
    assert PATIENCE < pushed < PATIENCE + 1.0
    assert not release.is_due(PLACE, False, CONTROL_DT)
