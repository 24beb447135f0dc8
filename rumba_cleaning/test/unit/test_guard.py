"""Robots do not fall: over stairs that the map shows, and over those that it does not, whatever is commanded."""

import itertools
import math
import re

import numpy as np
import pytest
from drivers import Always, context_of, guarded, run, with_cliffs
from rooms import RADIUS, quiet, room

from rumba_cleaning.behaviour import Command
from rumba_cleaning.behaviours.bounded import Bounded
from rumba_cleaning.behaviours.travel import Travel
from rumba_cleaning.control import CONTROL_DT, observe, steps
from rumba_cleaning.edges.cliff_map import CELL, SEEN
from rumba_cleaning.edges.guard import FOUND_SPEED, SWIFT_SPEED, Guard, why_it_creeps
from rumba_cleaning.mission.mission import Mission
from rumba_cleaning.outcome import Outcome
from rumba_cleaning.route import Route
from rumba_sim.model.common.config import updated
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.maps.floor_plan import FloorPlan
from rumba_sim.model.simulation.world import World

STAIRS = (2.0, 0.0, 3.0, 2.0)
ISLANDS = ((0.8, 0.7, 1.1, 1.0), (1.9, 0.6, 2.4, 0.9), (1.3, 1.6, 1.6, 2.1))


def commanded(v, w, pose, is_shown, seconds=20.0):
    """The robot after one command was given all the time, in a room with stairs."""
    plan = room(3.0, 2.0, 0.02, start=Pose(0.5, 0.5, 0.0))
    truth = with_cliffs(plan, STAIRS)
    world = World(truth, quiet())
    robot = world.spawn('rumba', pose)
    run(Bounded(Always(v, w), 1000.0, context_of(truth if is_shown else plan, world)), world, seconds=seconds)
    return robot


@pytest.mark.parametrize('is_shown', [True, False])
@pytest.mark.parametrize('heading', [0.0, 0.4, -0.9, 1.3])
@pytest.mark.parametrize('v, w', [(0.3, 0.0), (0.45, 0.0), (0.5, 0.3), (0.3, -0.5)])
def test_a_robot_that_is_driven_at_stairs_stops_before_them(v, w, heading, is_shown):
    assert not commanded(v, w, Pose(1.0, 1.0, heading), is_shown).has_fallen


def with_corner(plan, apex, heading):
    """The plan with a cliff that has a corner of 90 degrees at a point [m], and widens from there in a direction."""
    row, column = np.mgrid[0:plan.rows, 0:plan.columns] + 0.5
    left, bottom = plan.origin
    away = np.arctan2(row * plan.resolution + bottom - apex[1], column * plan.resolution + left - apex[0]) - heading
    cliff = np.cos(away) >= math.cos(0.25 * math.pi)
    return FloorPlan(plan.name, plan.occupancy, plan.resolution, plan.origin, cliff=cliff, dock=plan.dock)


@pytest.mark.thorough(except_for=['60', '300'])
@pytest.mark.parametrize('degrees', range(0, 360, 15))
def test_a_robot_that_passes_a_corner_that_no_map_shows_does_not_fall(degrees):
    plan = room(1.3, 0.8, 0.005)
    for aside, ahead in itertools.product([0.1, 0.115], np.arange(0.0, 0.03, 0.005)):
        truth = with_corner(plan, (0.8 + ahead, 0.4 + aside), math.radians(degrees))
        if truth.safe_clearance_at(0.3, 0.4) < RADIUS:
            continue  # the robot would begin there
        world = World(truth, quiet())
        robot = world.spawn('rumba', Pose(0.3, 0.4, 0.0))
        run(Bounded(Always(0.3, 0.0), 1000.0, context_of(plan, world)), world, seconds=2.5)
        assert not robot.has_fallen, f'{aside} m aside, {ahead} m ahead'


@pytest.mark.parametrize('ahead', [0.0, 0.01, 0.02])
def test_an_edge_lies_half_way_between_the_readings_of_the_sensor_that_found_it(ahead):
    plan = room(3.0, 2.0, 0.01)
    world = World(with_cliffs(plan, STAIRS), quiet())
    world.spawn('rumba', Pose(1.0 + ahead, 1.0, 0.0))
    context = context_of(plan, world)
    run(Bounded(Always(0.3, 0.0), 1000.0, context), world, seconds=5.0)
    assert context.cliff_map.seen[0][0] == pytest.approx(STAIRS[0], abs=SEEN + 0.001)


def test_it_is_wary_near_a_cliff_that_no_map_shows_and_only_there():
    plan = room(6.0, 2.0, 0.02, start=Pose(0.5, 1.0, 0.0))
    world = World(with_cliffs(plan, (5.0, 0.0, 6.0, 2.0)), quiet())
    robot = world.spawn('rumba')
    context = context_of(plan, world)
    run(Bounded(Always(0.3, 0.0), 1000.0, context), world, seconds=20.0)
    assert context.cliff_map.seen
    for x, fastest in ((4.75, 0.25), (2.0, 0.3)):
        world.teleport('rumba', Pose(x, 1.0, math.pi))
        run(Bounded(Always(0.3, 0.0), 1000.0, context), world, seconds=1.0)
        assert robot.twist.v == pytest.approx(fastest, abs=1e-3)


@pytest.mark.parametrize('heading', [math.pi, 2.7, -2.5])
def test_a_robot_does_not_back_over_an_edge_that_it_knows(heading):
    robot = commanded(-0.2, 0.0, Pose(1.5, 1.0, heading), True)
    assert not robot.has_fallen and robot.distance > 0.1


@pytest.mark.parametrize('v, w', [(-0.2, 0.0), (-0.3, 0.2)])
def test_a_wheel_goes_back_only_slowly_over_floor_that_no_sensor_has_seen(v, w):
    """The sensors are under the front."""
    plan = room(6.0, 6.0, 0.02, start=Pose(3.0, 3.0, 0.0))
    world = World(plan, quiet())
    robot = world.spawn('rumba')
    run(Bounded(Always(v, w), 1000.0, context_of(plan, world)), world, seconds=6.0)
    assert robot.distance < 0.8 * abs(v) * 6.0


def test_far_from_edges_commands_are_not_changed():
    plan = with_cliffs(room(6.0, 2.0, 0.02, start=Pose(0.5, 1.0, 0.0)), (5.0, 0.0, 6.0, 2.0))
    world = World(plan, quiet())
    world.spawn('rumba')
    behaviour = Bounded(Always(0.3, 0.05), 1000.0, context_of(plan, world))
    assert all(command == Command(0.3, 0.05) for _, command in steps(behaviour, world, seconds=5.0))


def test_it_is_faster_than_the_sensors_allow_only_over_floor_that_it_has_seen():
    plan = room(6.0, 2.0, 0.02, start=Pose(1.0, 1.0, 0.0))
    world = World(plan, quiet())
    robot = world.spawn('rumba')
    context = context_of(plan, world)
    there = [command.v for _, command in steps(Bounded(Always(0.45, 0.0), 1e3, context), world, seconds=6.0)]
    world.teleport('rumba', Pose(robot.pose.x - 1.5, robot.pose.y, 0.0))
    again = [command.v for _, command in steps(Bounded(Always(0.45, 0.0), 1e3, context), world, seconds=1.5)]
    assert max(there[5:]) < 0.36 and max(again) == 0.45


def test_in_a_tight_bend_the_outer_wheel_is_slow_over_floor_that_no_sensor_has_seen():
    plan = room(6.0, 2.0, 0.02, start=Pose(3.0, 1.0, 0.0))
    world = World(plan, quiet())
    world.spawn('rumba')
    half = 0.5 * world.config.drive.wheel_base
    bend = Bounded(Always(0.3, 1.9), 1e3, context_of(plan, world))
    outer = [command.v + half * command.w for _, command in steps(bend, world, seconds=8.0)]
    assert min(outer[5:25]) == pytest.approx(SWIFT_SPEED) == np.median(outer[5:25])  # some of it is known
    assert outer[-20:] == pytest.approx([0.3 + 1.9 * half] * 20)  # all of it


@pytest.mark.parametrize('v, w', [(0.45, 0.0), (0.3, 1.9), (0.4, 0.6)])
def test_where_one_cliff_was_found_wheels_are_slow_over_floor_that_no_sensor_has_seen(v, w):
    plan = room(6.0, 2.0, 0.02, start=Pose(3.0, 1.0, 0.0))
    world = World(plan, quiet())
    world.spawn('rumba')
    half, context = 0.5 * world.config.drive.wheel_base, context_of(plan, world)
    context.cliff_map._see(0.5, 0.5)
    given = [command for _, command in steps(Bounded(Always(v, w), 1e3, context), world, seconds=2.0)]
    outer = [command.v + half * command.w for command in given]
    assert min(outer[5:]) == pytest.approx(FOUND_SPEED) == np.median(outer[5:])  # some of it is known


def test_a_behaviour_that_an_edge_stops_sees_it_as_a_cliff():
    plan = with_cliffs(room(3.0, 2.0, 0.02, start=Pose(1.0, 1.0, 0.0)), STAIRS)
    world = World(plan, quiet())
    world.spawn('rumba')
    seen = []

    def decide(observation):
        seen.append(any(observation.cliffs) and observation.is_held)
        return Command(0.3, 0.0)

    list(guarded(Guard(context_of(plan, world)), world, decide, seconds=10.0))
    assert seen[-1] and not seen[0]


@pytest.mark.thorough(except_for=['0-boustrophedon', '3-spiral'])
@pytest.mark.parametrize('strategy', ['boustrophedon', 'bounce', 'spiral', 'wall_follow'])
@pytest.mark.parametrize('shown', [0, 1, 3])
def test_no_mission_among_islands_of_cliffs_falls(strategy, shown):
    plan = room(3.0, 2.6, 0.02, dock=Pose(3.0 - RADIUS - 0.01, 2.2, 0.0))
    truth = with_cliffs(plan, *ISLANDS)
    known = with_cliffs(plan, *ISLANDS[:shown]) if shown else plan
    for start in (None, Pose(0.4, 2.2, -1.0)):
        world = World(truth, quiet(), seed=shown)
        robot = world.spawn('rumba', start, brushes_up=True)
        run(Mission(context_of(known, world), strategy, 0.99), world, seconds=250.0)
        assert not robot.has_fallen


def test_a_wary_robot_does_not_creep_over_an_edge_inside_its_bend_that_no_sensor_passes_over():
    """Around a pit, its inner wheel is on a circle of 3 cm, and the sensor before that on one of 10 cm."""
    pit_x, pit_y = 1.5, 1.2
    plan = room(3.0, 2.4, 0.01)
    world = World(with_cliffs(plan, (pit_x - 0.04, pit_y + 0.02, pit_x + 0.04, pit_y + 0.05)), quiet())
    robot = world.spawn('rumba', Pose(0.6, pit_y - 0.15, 0.0))
    context = context_of(plan, world)
    context.cliff_map._see(pit_x + 0.3, pit_y - 0.3)
    given = list(guarded(Guard(context), world, lambda observation: Command(
        0.06, 0.4 if observation.pose.x > pit_x else 0.0), seconds=30.0))
    assert not robot.has_fallen
    assert any(command.v == 0.0 and command.w > 0.0 for command in given)  # so that it can go straight on


def test_a_robot_that_edges_hold_looks_for_a_way_out_itself():
    plan = room(3.0, 2.0, 0.01)
    world = World(plan, quiet())
    half = 0.5 * world.config.drive.wheel_base
    robot = world.spawn('rumba', Pose(1.5, 0.5 + half + 0.022, 0.0))
    context = context_of(with_cliffs(plan, (0.5, 0.2, 2.5, 0.5)), world)
    away = [context.cliff_map.clearance_at(robot.pose.x + half * math.sin(robot.pose.theta),
                                           robot.pose.y - half * math.cos(robot.pose.theta))
            for _ in steps(Bounded(Always(0.1, -0.3), 1000.0, context), world, seconds=10.0)]
    assert max(away[:15]) < 0.03 and max(away) > 0.1


def test_a_small_hole_in_the_floor_that_was_seen_does_not_hold_a_robot_for_long():
    plan = room(3.0, 2.0, 0.01)
    world = World(plan, quiet())
    robot = world.spawn('rumba', Pose(1.5, 1.0, 0.0))
    context = context_of(plan, world)
    cliff_map, guard = context.cliff_map, Guard(context)
    cliff_map._see(1.9, 1.0)
    context.sense(observe(world, 'rumba', CONTROL_DT))
    aside = 0.5 * world.config.drive.wheel_base / math.sqrt(2.0)
    row, column = int((1.0 + aside - cliff_map._origin[1]) / CELL), int((1.5 - aside - cliff_map._origin[0]) / CELL)
    cliff_map._floor[row - 1:row + 2, column - 1:column + 2] = 0  # on the way of the left wheel
    for _ in guarded(guard, world, lambda observation: Command(0.0, 1.0), seconds=3.0):
        pass
    assert robot.pose.theta > 2.0


def test_a_turn_on_the_spot_that_is_too_slow_for_the_drive_does_not_stand_for_what_edges_forbid():
    """Its wheels would stand still for ever, and nobody would know that edges hold it."""
    plan = room(3.0, 2.0, 0.01)
    world = World(plan, quiet())
    robot = world.spawn('rumba', Pose(1.5, 1.0, 0.0))
    context = context_of(plan, world)
    context.cliff_map._see(1.9, 1.0)
    guard = Guard(context)
    w = 0.9 * world.config.drive.dead_band / (0.5 * world.config.drive.wheel_base)
    for _ in guarded(guard, world, lambda observation: Command(0.2, w), seconds=2.9):
        pass
    assert robot.twist == (0.0, 0.0) and guard.held_time > 0.5


@pytest.mark.parametrize('heading', [-0.3, 0.0, 0.3])
def test_where_a_tight_bend_would_come_too_near_to_an_edge_it_turns_on_the_spot(heading):
    plan = with_cliffs(room(3.0, 2.0, 0.02), STAIRS)
    world = World(plan, quiet())
    robot = world.spawn('rumba', Pose(1.82, 1.0, heading))
    given = list(guarded(Guard(context_of(plan, world)), world, lambda observation: Command(0.2, 1.9), seconds=1.5))
    assert any(command.v == 0.0 and command.w > 0.0 for command in given)
    assert robot.pose.theta - heading > 1.8 and all(command.w > 0.0 for command in given)


@pytest.mark.parametrize('cliff_y, least, most', [(0.6, -0.15, 0.05), (1.9, -0.26, -0.24)])
def test_near_a_cliff_that_no_map_shows_a_robot_that_slides_turns_along_the_wall(cliff_y, least, most):
    plan = room(3.0, 2.0, 0.01)
    world = World(plan, quiet())
    robot = world.spawn('rumba', Pose(0.4, RADIUS + 0.005, -0.25))
    context = context_of(plan, world)
    context.cliff_map._see(1.6, cliff_y)
    for _ in guarded(Guard(context), world, lambda observation: Command(0.2, 0.0), seconds=7.0):
        pass
    assert least < robot.pose.theta < most and robot.pose.x > 1.2


def test_a_robot_that_cannot_move_for_edges_ends_its_mission_and_says_so():
    plan = room(3.0, 2.6, 0.02)
    known = with_cliffs(plan, (0.5, 1.0, 2.5, 1.19), (0.5, 1.41, 2.5, 1.6))  # nobody can turn between them
    world = World(plan, quiet())
    robot = world.spawn('rumba', Pose(1.5, 1.3, 0.5 * math.pi))
    mission = Mission(context_of(known, world), 'boustrophedon', 0.99)
    run(mission, world, seconds=200.0)
    assert mission.outcome is Outcome.BLOCKED and 'edges' in mission.message
    assert robot.pose.y == pytest.approx(1.3, abs=0.02) and 60.0 < world.time < 180.0


def test_of_a_robot_whose_sensors_look_beside_no_wheel_the_guard_tells_what_would_do():
    wide = quiet(drive={'wheel_base': 0.7, 'radius': 0.5})
    line = why_it_creeps(wide)
    distance = float(re.search(r'; cliff/distance of (\S+) m would do$', line).group(1))
    assert line.startswith('drive/wheel_base is 0.7 m and cliff/distance 0.165 m: ')
    assert why_it_creeps(updated(wide, {'cliff': {'distance': distance}}, 'wide')) == why_it_creeps(quiet()) == ''
    assert why_it_creeps(quiet(cliff={'outer_angle': 0.05})).endswith('; a larger cliff/outer_angle would do')


@pytest.mark.parametrize('speed, brushes_up', [(0.3, False), (0.45, True)])
def test_the_brushes_are_up_where_a_route_is_faster_than_the_cleaning_speed(speed, brushes_up):
    plan = room(4.0, 2.0, start=Pose(0.5, 1.0, 0.0))
    world = World(plan, quiet())
    world.spawn('rumba')
    travel = Travel(context_of(plan, world), Route(np.array([[0.5, 1.0], [3.0, 1.0]]), np.array([speed])))
    assert travel.command(observe(world, 'rumba', 0.0), brushes_up=False).brushes_up == brushes_up
