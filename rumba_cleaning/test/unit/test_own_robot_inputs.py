"""Bumpers, cliff sensors and charges in the messages of other drivers."""

import math
from types import SimpleNamespace as Message

import pytest

from rumba_cleaning.own_robot.inputs import PULSE, READERS, State


def told(*messages):
    """The state after messages: topic, type and fields of each."""
    state = State()
    for topic, kind, fields in messages:
        READERS[topic][kind](state, Message(**fields))
    return state


def test_what_a_robot_does_not_have_is_calm_and_full():
    state = State()
    assert (state.bumper, state.cliffs, state.charge, state.has_fallen) == (
        (False, False), (False,) * 4, 1.0, False)


@pytest.mark.parametrize('kind', ['rumba_msg/Bumper', 'create_msgs/Bumper', 'ca_msgs/Bumper'])
def test_a_bumper_with_two_switches(kind):
    message = 'bumper', kind, {'is_left_pressed': False, 'is_right_pressed': True}
    assert told(message).bumper == (False, True)


def test_a_kobuki_tells_of_each_switch_when_it_changes():
    left, centre = ({'bumper': place, 'state': 1} for place in (0, 1))
    event = 'bumper', 'kobuki_msgs/BumperEvent'
    assert told((*event, left)).bumper == (True, False)
    assert told((*event, centre)).bumper == (True, True)
    assert told((*event, left), (*event, centre), (*event, {'bumper': 1, 'state': 0})).bumper == (True, False)


@pytest.mark.parametrize('kind', ['create_msgs/Cliff', 'ca_msgs/Cliff'])
def test_four_cliff_sensors(kind):
    fields = {'is_cliff_left': False, 'is_cliff_front_left': True, 'is_cliff_front_right': False,
              'is_cliff_right': True}
    assert told(('cliff', kind, fields)).cliffs == (False, True, False, True)


def test_our_cliff_tells_of_wheels_too():
    fields = {'is_cliff_left': True, 'is_cliff_front_left': False, 'is_cliff_front_right': False,
              'is_cliff_right': False, 'is_wheel_dropped': True}
    state = told(('cliff', 'rumba_msg/Cliff', fields))
    assert (state.cliffs, state.has_fallen) == ((True, False, False, False), True)


def test_a_kobuki_has_three_cliff_sensors_and_the_middle_one_counts_for_both_front_ones():
    event = 'cliff', 'kobuki_msgs/CliffEvent'
    assert told((*event, {'sensor': 1, 'state': 1})).cliffs == (False, True, True, False)
    assert told((*event, {'sensor': 2, 'state': 1})).cliffs == (False, False, False, True)
    assert told((*event, {'sensor': 0, 'state': 1}), (*event, {'sensor': 0, 'state': 0})).cliffs == (False,) * 4


def test_a_wheel_that_hangs_in_the_air():
    event = 'wheel_drop', 'kobuki_msgs/WheelDropEvent'
    assert told((*event, {'wheel': 0, 'state': 1}), (*event, {'wheel': 1, 'state': 0})).has_fallen
    assert not told((*event, {'wheel': 0, 'state': 1}), (*event, {'wheel': 0, 'state': 0})).has_fallen


def test_a_create_tells_of_a_wheel_again_and_again_while_it_hangs_in_the_air():
    state = told()
    state.now = 7.0
    READERS['wheel_drop']['std_msgs/Empty'](state, Message())
    state.now = 7.0 + 0.9 * PULSE
    assert state.has_fallen
    state.now = 7.0 + 1.1 * PULSE
    assert not state.has_fallen


def test_a_dock_and_its_beams():
    fields = {'is_docked': True, 'infrared_omni': 13, 'infrared_left': 4, 'infrared_right': 8}
    state = told(('dock_status', 'rumba_msg/DockStatus', fields))
    assert (state.is_docked, state.infrared) == (True, (13, 4, 8))


@pytest.mark.parametrize('charger, charge', [(0, 0.7), (2, 0.7), (3, 1.0), (4, 0.7)])
def test_a_battery_is_full_if_the_charger_says_so(charger, charge):
    assert told(('battery_state', 'std_msgs/Float32', {'data': 0.7}),
                ('charging_state', 'create_msgs/ChargingState', {'state': charger})).charge == charge


@pytest.mark.parametrize('share, charge', [(0.4, 0.4), (1.7, 1.0), (-0.1, 0.0), (math.nan, 1.0)])
def test_charges(share, charge):
    assert told(('battery_state', 'sensor_msgs/BatteryState', {'percentage': share})).charge == charge
    assert told(('battery_state', 'std_msgs/Float32', {'data': share})).charge == charge
