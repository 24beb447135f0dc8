"""The dock: its contacts, and the beams that lead to it."""

import itertools
import math

import pytest
from rooms import alone, crooked, drive, drove, quiet, room

from rumba_sim.model.common.errors import MapError
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.kernel.sensors.dock import FORCE_FIELD, GREEN_BUOY, NO_BEAM, RED_BUOY
from rumba_sim.model.simulation.robot import Infrared
from rumba_sim.model.simulation.world import World

AT_ONCE = {'acceleration': 1000.0}
BOTH = RED_BUOY | GREEN_BUOY
# Docks at the four walls of a room of 5 m x 4 m, 0.2 m from the wall that they face.
DOCKS = [Pose(4.8, 1.5, 0.0), Pose(1.2, 3.8, math.pi / 2.0), Pose(0.2, 2.5, math.pi), Pose(3.0, 0.2, -math.pi / 2.0)]


def heard(dock, ahead, left, turn, boxes=()):
    """What a robot gets that stands `ahead` [m] before the dock, `left` [m] of its axis, turned from facing it."""
    cos, sin = math.cos(dock.theta), math.sin(dock.theta)
    world = World(room(5.0, 4.0, boxes=boxes, dock=dock), quiet())
    world.spawn('rumba', Pose(dock.x - ahead * cos - left * sin, dock.y - ahead * sin + left * cos, dock.theta + turn))
    return world.infrared('rumba')


@pytest.mark.parametrize('dock', DOCKS)
@pytest.mark.parametrize('ahead, left, beams', [
    (1.5, 0.0, BOTH),
    (1.5, 0.05, BOTH), (1.5, -0.05, BOTH),
    (1.5, 0.2, RED_BUOY), (1.5, -0.2, GREEN_BUOY),
    (1.5, 0.7, RED_BUOY), (1.5, -0.7, GREEN_BUOY),
    (1.5, 0.85, NO_BEAM), (1.5, -0.85, NO_BEAM),
    (2.7, 0.0, BOTH), (2.85, 0.0, NO_BEAM),
    (0.42, 0.0, BOTH | FORCE_FIELD), (0.43, 0.0, BOTH),
    (0.2, 0.1, RED_BUOY | FORCE_FIELD), (0.2, -0.1, GREEN_BUOY | FORCE_FIELD),
    (0.2, 0.4, FORCE_FIELD), (0.2, -0.4, FORCE_FIELD),
    (0.0, 0.0, BOTH | FORCE_FIELD),
])
def test_who_faces_the_dock_sees_red_on_the_left_green_on_the_right_both_at_the_axis(dock, ahead, left, beams):
    assert heard(dock, ahead, left, 0.0).omni == beams


@pytest.mark.parametrize('dock', DOCKS)
@pytest.mark.parametrize('turn, left, right', [
    (0.0, True, True), (0.2, True, True), (-0.2, True, True),
    (0.3, False, True), (1.5, False, True), (1.6, False, False),
    (-0.3, True, False), (-1.5, True, False), (-1.6, False, False), (math.pi, False, False)])
def test_the_front_receivers_look_to_their_side_and_the_upper_one_all_around(dock, turn, left, right):
    assert heard(dock, 1.0, 0.0, turn) == Infrared(BOTH, BOTH if left else NO_BEAM, BOTH if right else NO_BEAM)


@pytest.mark.parametrize('dock', DOCKS)
def test_beside_the_dock_only_the_receiver_on_its_side_hears_it(dock):
    assert heard(dock, 0.2, 0.3, 0.0) == Infrared(FORCE_FIELD, NO_BEAM, FORCE_FIELD)
    assert heard(dock, 0.2, -0.3, 0.0) == Infrared(FORCE_FIELD, FORCE_FIELD, NO_BEAM)
    assert heard(dock, 1.5, 0.7, 0.0) == Infrared(RED_BUOY, NO_BEAM, RED_BUOY)
    assert heard(dock, 1.5, -0.7, 0.0) == Infrared(GREEN_BUOY, GREEN_BUOY, NO_BEAM)


def test_nothing_gets_through_a_wall():
    assert heard(DOCKS[0], 1.5, 0.0, 0.0, [(3.9, 1.0, 4.0, 2.0)]) == Infrared(NO_BEAM, NO_BEAM, NO_BEAM)
    assert heard(DOCKS[0], 1.5, 0.0, 0.0, [(3.9, 1.7, 4.0, 2.0)]) == Infrared(BOTH, BOTH, BOTH)


def test_without_a_dock_there_are_no_beams_and_no_contacts():
    world, robot = alone(Pose(1.0, 2.7, 0.0), crooked())
    world.step(10)
    assert world.infrared('rumba') == Infrared(NO_BEAM, NO_BEAM, NO_BEAM) and not robot.is_docked


def test_contacts_open_later_than_they_close():
    world, robot = alone(DOCKS[0], room(5.0, 4.0, dock=DOCKS[0]), drive=AT_ONCE)
    world.step()
    for v, seconds in ((-0.05, 3.0), (0.05, 3.0), (-0.05, 1.8), (0.05, 1.8)):
        was = robot.is_docked
        changes = []
        for pose in drive(world, v, 0.0, round(seconds * 50)):
            if robot.is_docked != was:
                changes.append(4.8 - pose.x)
                was = robot.is_docked
        if seconds == 1.8:
            assert changes == [] and robot.is_docked
        else:
            assert changes == [pytest.approx(0.1 if v < 0.0 else 0.075, abs=0.0021)]


def test_contacts_open_by_turning_too():
    world, robot = alone(DOCKS[0], room(5.0, 4.0, dock=DOCKS[0]), drive=AT_ONCE)
    world.step()
    closed = [(round(pose.theta, 6), robot.is_docked) for w in (0.2, -0.2, -0.2)
              for pose in drive(world, 0.0, w, 60)]
    assert {angle for angle, docked in closed if docked} == {
        angle for angle, docked in closed if docked and abs(angle) <= 0.157}
    changes = [after[0] for before, after in zip(closed, closed[1:]) if before[1] != after[1]]
    assert changes == pytest.approx([0.160, 0.104, -0.160], abs=0.0045)


def test_contacts_do_not_flicker_while_a_robot_trembles_at_their_limit():
    world, robot = alone(DOCKS[0], room(5.0, 4.0, dock=DOCKS[0]), drive=AT_ONCE)
    drove(world, -0.05, 0.0, 75)
    states = []
    for v in itertools.islice(itertools.cycle((0.05, 0.05, -0.05, -0.05)), 200):
        drove(world, v, 0.0, 3)
        states.append(robot.is_docked)
    assert states == [True] * 200


def test_a_robot_that_drives_against_the_dock_comes_to_its_contacts_and_stays():
    dock = DOCKS[0]
    world, robot = alone(Pose(3.5, 1.52, 0.0), room(5.0, 4.0, dock=dock))
    states = [robot.is_docked for _ in drive(world, 0.2, 0.0, 500)]
    assert states.index(True) < 400 and all(states[states.index(True):])
    world.teleport('rumba', Pose(3.5, 1.5, 0.0))
    assert not robot.is_docked


def test_a_dock_where_no_robot_fits_is_refused():
    with pytest.raises(MapError, match=r'^room: dock at \(4\.90, 1\.50\) m is 0\.100 m from the nearest wall'):
        World(room(5.0, 4.0, dock=Pose(4.9, 1.5, 0.0)))


# --- several docks ------------------------------------------------------------------------------------------------

@pytest.mark.parametrize('number', range(len(DOCKS)))
def test_a_robot_charges_at_each_dock(number):
    world = World(room(5.0, 4.0, dock=DOCKS[0], further_docks=DOCKS[1:]), quiet())
    robot = world.spawn('rumba', DOCKS[number])
    world.step()
    assert robot.is_docked


def test_robots_begin_at_docks_and_then_near_the_first():
    world = World(room(5.0, 4.0, dock=DOCKS[0], further_docks=DOCKS[1:3]), quiet())
    begins = [world.spawn(name).pose for name in 'abcd']
    assert begins[:3] == DOCKS[:3]
    assert math.hypot(begins[3].x - DOCKS[0].x, begins[3].y - DOCKS[0].y) < 0.7


def test_on_a_map_with_a_start_further_robots_begin_beside_it():
    world = World(room(5.0, 4.0, dock=DOCKS[0], further_docks=DOCKS[1:3], start=Pose(2.5, 2.0, 0.0)), quiet())
    begins = [world.spawn(name).pose for name in 'ab']
    assert begins[0] == Pose(2.5, 2.0, 0.0) and math.hypot(begins[1].x - 2.5, begins[1].y - 2.0) < 0.7


@pytest.mark.parametrize('pose', [Pose(1.5, 2.0, 0.4), Pose(3.5, 1.5, 0.0), Pose(4.5, 1.5, 0.2), Pose(1.2, 3.0, 1.5)])
def test_what_is_heard_of_several_docks_is_the_sum_of_what_is_heard_of_each(pose):
    def beams(*docks):
        world = World(room(5.0, 4.0, dock=docks[0], further_docks=docks[1:]), quiet())
        world.spawn('rumba', pose)
        return world.infrared('rumba')
    each = [beams(dock) for dock in DOCKS]
    assert beams(*DOCKS) == Infrared(*(first | second | third | fourth for first, second, third, fourth in zip(*each)))
    assert any(any(seen) for seen in each)


def test_each_dock_must_leave_room_for_a_robot():
    with pytest.raises(MapError, match=r'dock at \(4\.95, 2\.00\) m is 0\.050 m from the nearest wall'):
        World(room(5.0, 4.0, dock=DOCKS[0], further_docks=[Pose(4.95, 2.0, 0.0)]))
