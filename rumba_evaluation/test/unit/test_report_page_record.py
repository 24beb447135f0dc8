"""Figures and events are calculated from the record."""

import numpy as np
import pytest
from mission_bags import record
from pytest import approx

from rumba_cleaning.mission.stages import State
from rumba_evaluation.report.mission_events import events
from rumba_evaluation.report.mission_record import MissionState, Series, charging_spans, clock, rises, series, spans
from rumba_evaluation.report.mission_summary import summary


def test_a_jump_is_no_driven_distance():
    jumping = record(path=series([0, 2, 2.1, 5], [[0.0, 0.0], [1.0, 0.0], [3.0, 0.0], [3.0, 1.0]]))
    told = summary(jumping)
    assert (told.jumps, told.distance, told.driving_time) == (1, approx(2.0), approx(4.9))
    assert [(event.time, event.text) for event in events(jumping) if event.kind == 'jump'] == [
        (2.1, 'Moved without driving: from (1.00, 0.00) m to (3.00, 0.00) m.')]


def test_neither_sparse_poses_nor_short_distances_are_jumps():
    told = summary(record(path=series([0, 2, 2.1], [[0.0, 0.0], [1.0, 0.0], [1.45, 0.0]])))
    assert (told.jumps, told.distance) == (0, approx(1.45))


def test_samples_are_sorted_and_must_be_finite():
    found = series([3.0, 1.0, 2.0, np.nan], [[1, 2], [3, 4], [5, np.inf], [7, 8]])
    assert found.times.tolist() == [1.0, 3.0] and found.values.tolist() == [[3, 4], [1, 2]]
    assert series([1.0], [np.nan]).times.tolist() == []
    assert found.at(np.array([0.0, 1.0, 2.9, 3.0, 9.0]))[:, 0].tolist() == [3, 3, 3, 1, 1]


def test_short_interruptions_are_ignored():
    flags = series([0, 1, 2, 3, 4, 5, 10, 11], [0, 1, 0, 0, 1, 0, 1, 1])
    assert spans(flags) == [(1.0, 5.0), (10.0, 11.0)]
    assert rises(flags).tolist() == [1.0, 4.0, 10.0]
    assert rises(series([0, 1, 2], [1, 1, 0])).tolist() == [] == spans(series([], []))


def test_without_other_topics_the_battery_is_charged_while_its_charge_rises():
    bare = dict(charging=series([], []), docked=series([], []))
    charge = series([0, 1, 2, 3, 4, 5, 6, 7], [50, 49, 49, 60, 60, 70, 69, 80])
    assert charging_spans(record(charge=charge, **bare)) == [(2.0, 5.0), (6.0, 7.0)]
    assert charging_spans(record(charge=series([0, 1], [50, 40]), **bare)) == []


def test_a_full_battery_is_not_charged_while_docked():
    docked = series([0, 1, 2, 3, 4, 10], [0, 1, 1, 1, 1, 0])
    charge = series([0, 2.5], [90, 100])
    assert charging_spans(record(charge=charge, docked=docked, charging=series([], []))) == [(1.0, 3.0)]


def test_a_low_battery_is_one_event_until_it_has_recovered():
    charge = series(range(9), [50, 9, 11, 9, 12, 9, 5, 13, 13])
    assert [event.time for event in events(record(charge=charge)) if event.kind == 'battery'] == [1.0, 5.0]


def test_many_bumps_of_one_state_are_one_event():
    times = np.arange(100.0)
    states = [MissionState(0.0, State.CLEANING, '', ''), MissionState(60.0, State.RETURNING, '', ''),
              MissionState(66.0, State.IDLE, '', '')]
    bumpy = record(pressed=Series(times, times % 2), states=states)
    found = [event.text for event in events(bumpy) if event.kind == 'bump']
    assert [text[:37] for text in found] == ['The first of 30 bumps until 0:00:59, '] + [
        'Bump at (4.00, 1.00) m.'] * 3 + ['The first of 17 bumps until 0:01:39, ']


def test_a_stay_on_the_dock_is_one_event_at_each_end():
    docked = series([0, 10, 50, 90], [0, 1, 0, 0])
    charging = series([0, 11, 49, 90], [0, 1, 0, 0])
    states = [MissionState(time, state, '', '') for time, state in (
        (0.0, State.CLEANING), (4.0, State.RETURNING), (7.0, State.DOCKING), (10.0, State.CHARGING),
        (48.0, State.UNDOCKING), (52.0, State.CLEANING))]
    found = events(record(docked=docked, charging=charging, states=states, pressed=series([], [])))
    assert [event.text for event in found[1:-1]] == [
        'Mission: cleaning', 'Mission: returning', 'Docked and charging, battery 100 %.',
        'Left the dock after 0:00:38 of charging, battery 100 %.', 'Mission: cleaning']


@pytest.mark.parametrize('states, told', [
    ([], ''), ([(State.IDLE, '')], 'The robot had no mission while this was recorded.'),
    ([(State.CLEANING, 'working')], 'The recording ends before the mission, after 0:01:40: '
                                    '90.0 % of the floor is swept, the robot is cleaning.'),
    ([(State.CLEANING, 'working'), (State.IDLE, '90.0 % swept')],
     'The robot swept 90.0 % of the floor in 0:00:01, less than the target of 99 %.'),
    ([(State.CLEANING, 'working'), (State.IDLE, '90.0 % swept: the battery is low')],
     'The robot swept 90.0 % of the floor in 0:00:01, less than the target of 99 %: the battery is low.'),
    ([(State.CLEANING, 'working'), (State.STRANDED, 'stuck')], 'The robot is stranded after 0:01:40: stuck.'),
    ([(State.STRANDED, '')], 'The robot is stranded after 0:01:40: it does not say why.'),
    ([(len(State), '')], 'The recording ends before the mission, after 0:01:40: 90.0 % of the floor is swept, '
                         f'the robot is state {len(State)}.')])
def test_outcomes(states, told):
    said = [MissionState(float(time), state, '', message) for time, (state, message) in enumerate(states)]
    assert summary(record(states=said)).outcome == told


@pytest.mark.parametrize('target, docked, told', [
    (0.9, [0, 1, 1], 'The robot swept 90.0 % of the floor in 0:00:01 and is back on its dock: the target was 90 %.'),
    (0.9004, [0, 1, 0], 'The robot swept 90.0 % of the floor in 0:00:01: the target was 90.04 %.')])
def test_a_mission_that_met_its_target(target, docked, told):
    said = [MissionState(0.0, State.CLEANING, '', ''), MissionState(1.0, State.IDLE, '', 'done')]
    assert summary(record(states=said, target=target, docked=series([0, 10, 100], docked))).outcome == told


def test_the_end_of_a_mission_without_coverage_is_told_in_its_own_words():
    said = [MissionState(0.0, State.CLEANING, '', ''), MissionState(1.0, State.IDLE, '', '9 % swept')]
    told = summary(record(states=said, coverage=series([], []))).outcome
    assert told == 'The mission ended after 0:00:01: 9 % swept.'


def test_charges_are_those_of_the_mission_and_not_its_last_return_to_the_dock():
    """A person who drives does not make two charges of one."""
    order = (State.CLEANING, State.CHARGING, State.YIELDING, State.CHARGING, State.CLEANING, State.CHARGING,
             State.CLEANING, State.DOCKING, State.IDLE)
    said = [MissionState(10.0 * number, state, '', '') for number, state in enumerate(order)]
    charging = series(range(0, 100, 5), [0, 0, 1, 1, 1, 1, 1, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 1, 1])
    assert summary(record(states=said, charging=charging)).charges == 2
    assert summary(record(states=(), charging=charging)).charges == 3


def test_the_ideal_time_is_that_of_one_brush_without_overlap():
    assert summary(record(areas=(9.0, 10.2))).ideal_time == approx(10.2 / (0.17 * 0.3))
    assert summary(record(areas=None)).ideal_time is None


def test_energy_and_speed_follow_from_power_and_path():
    told = summary(record(power=series([0, 100, 200], [-36, -36, 72])))
    assert told.energy == approx((1.5, 1.0))  # 36 W for 100 s, then falling to 0 W in 100 s; rising to 72 W
    length = 4.0 + 1.0 + 2.0 * 2.0 ** 0.5
    assert (told.distance, told.driving_time, told.mean_speed) == approx((length, 100.0, 0.01 * length))


def test_a_robot_that_stands_has_no_speed():
    told = summary(record(path=series([0, 10, 20], [[1.0, 1.0], [1.0, 1.0], [1.05, 1.0]])))
    assert (told.driving_time, told.mean_speed, told.distance) == (0.0, None, approx(0.05))


@pytest.mark.parametrize('seconds, text', [(0.0, '0:00:00'), (-0.1, '0:00:00'), (59.6, '0:01:00'), (3725.0, '1:02:05'),
                                           (90061.0, '25:01:01')])
def test_times_of_a_mission(seconds, text):
    assert clock(seconds) == text
