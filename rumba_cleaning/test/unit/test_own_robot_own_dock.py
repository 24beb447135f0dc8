"""A robot that docks by itself: whether it stands on its dock, and what its driver is told."""

import pytest

from rumba_cleaning.own_robot.gate import SEEK_DOCK, STOP, Velocity
from rumba_cleaning.own_robot.own_dock import AGAIN, DOCK, LAPSE, MOVED, UNDOCK, OwnDock
from rumba_sim.model.common.geometry import Pose

AHEAD = Velocity(0.2, 0.0)
BERTH = Pose(1.0, 2.0, 0.5)
PASSIVE, FULL = 1, 3
CHARGING, NONE = 2, 0


def away(distance):
    """A pose so far from the berth [m]."""
    return BERTH._replace(x=BERTH.x + distance)


def dock_of(is_docked=True, mode=FULL, charging=NONE):
    """A dock, and what was told of it at first."""
    dock = OwnDock(is_docked)
    dock.take_mode(mode, 0.0)
    dock.take_charging_state(charging)
    dock.take_odometry(BERTH, 0.0)
    return dock


def seeking():
    """That of a robot that seeks it."""
    dock = dock_of(is_docked=False)
    assert dock.due(SEEK_DOCK, 0.0) == DOCK
    dock.take_mode(PASSIVE, 0.2)
    return dock


def charging():
    """That of a robot that has found it."""
    dock = seeking()
    dock.take_charging_state(CHARGING)
    dock.take_odometry(BERTH, 1.0)
    return dock


# --- whether it is docked ---------------------------------------------------------------------------------------------

def test_a_robot_that_does_not_charge_in_full_mode_is_docked_until_it_has_moved():
    dock = dock_of()
    dock.take_odometry(away(0.9 * MOVED), 3600.0)
    assert dock.is_docked
    dock.take_odometry(away(1.1 * MOVED), 3600.1)
    assert not dock.is_docked
    dock.take_odometry(BERTH, 3600.2)
    assert not dock.is_docked


def test_one_that_does_not_begin_on_its_dock_is_docked_once_it_charges():
    dock = dock_of(is_docked=False)
    assert not dock.is_docked
    dock.take_charging_state(CHARGING)
    dock.take_odometry(away(0.3), 1.0)
    assert dock.is_docked


@pytest.mark.parametrize('state, is_docked', [(0, False), (1, True), (2, True), (3, True), (4, True), (5, False)])
def test_states_of_the_charger(state, is_docked):
    assert dock_of(is_docked=False, mode=PASSIVE, charging=state).is_docked is is_docked


def test_a_passive_robot_that_no_longer_charges_is_docked_only_for_a_while():
    dock = charging()
    dock.take_charging_state(NONE)
    dock.take_odometry(BERTH, 1.0 + 0.9 * LAPSE)
    assert dock.is_docked
    dock.take_odometry(BERTH, 1.0 + 1.1 * LAPSE)
    assert not dock.is_docked


def test_a_robot_that_is_told_to_charge_where_it_stands_has_the_same_while_to_begin():
    dock = dock_of()
    assert dock.due(SEEK_DOCK, 100.0) == DOCK
    dock.take_mode(PASSIVE, 100.2)
    dock.take_odometry(BERTH, 100.1 + LAPSE)
    assert dock.is_docked
    assert dock.due(SEEK_DOCK, 100.0 + 2 * AGAIN[DOCK]) == ''


@pytest.mark.parametrize('character, beams', [
    (0, 0), (160, 0), (161, 1), (164, 4), (168, 8), (172, 12), (173, 13), (162, 0), (174, 0), (255, 0)])
def test_characters_of_a_dock_and_of_others(character, beams):
    dock = OwnDock(False)
    dock.take_infrared(character)
    assert dock.infrared == beams


# --- what the driver is told ------------------------------------------------------------------------------------------

def test_it_is_told_to_dock_once_and_again_if_it_does_not_become_passive():
    dock = dock_of(is_docked=False)
    times = 0.0, 0.1, 0.9 * AGAIN[DOCK], 1.1 * AGAIN[DOCK]
    assert [dock.due(SEEK_DOCK, now) for now in times] == [DOCK, '', '', DOCK]
    dock.take_mode(PASSIVE, 6.0)
    assert dock.due(SEEK_DOCK, 100.0) == ''


@pytest.mark.parametrize('velocity', [AHEAD, STOP, None])
def test_a_robot_that_seeks_its_dock_is_stopped_by_whatever_else_is_commanded_and_by_nothing(velocity):
    dock = seeking()
    assert [dock.due(velocity, now) for now in (1.0, 1.1, 1.1 + AGAIN[UNDOCK])] == [UNDOCK, '', UNDOCK]
    dock.take_mode(FULL, 2.0)
    assert dock.due(velocity, 3.0) == ''
    assert dock.due(SEEK_DOCK, 3.1) == DOCK


@pytest.mark.parametrize('velocity', [SEEK_DOCK, STOP, None])
def test_a_robot_that_charges_goes_on_with_it(velocity):
    dock = charging()
    assert dock.due(velocity, 1.0) == ''
    dock.take_charging_state(NONE)  # its contacts bounce, or it is full
    assert dock.due(velocity, 1.1) == ''


def test_a_robot_that_charges_obeys_a_velocity():
    dock = charging()
    assert dock.due(AHEAD, 1.0) == UNDOCK
    dock.take_mode(FULL, 1.2)
    assert dock.due(AHEAD, 1.3) == ''


@pytest.mark.parametrize('velocity', [STOP, None])
def test_a_robot_that_somebody_else_made_passive_is_left_alone_until_it_is_to_drive(velocity):
    dock = dock_of(is_docked=False, mode=PASSIVE)
    assert dock.due(velocity, 0.0) == ''
    assert dock.due(AHEAD, 1.0) == UNDOCK


def test_one_that_a_person_makes_passive_after_it_was_stopped_is_left_alone():
    dock = seeking()
    dock.due(STOP, 1.0)
    dock.take_mode(FULL, 1.2)
    assert dock.due(None, 1.3) == ''
    dock.take_mode(PASSIVE, 60.0)
    assert dock.due(None, 61.0) == ''
