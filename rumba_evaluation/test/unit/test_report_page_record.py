"""Figures and events are calculated from the record."""

import numpy as np
import pytest
from mission_bags import record
from pytest import approx

from rumba_cleaning.mission.mission import State
from rumba_evaluation.report.mission_events import events
from rumba_evaluation.report.mission_record import (MissionState, Series, charging_spans, clock, rises, series, spans,
                                                    summary)


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


def test_many_bumps_are_counted():
    times = np.arange(40.0)
    found = [event.text for event in events(record(pressed=Series(times, times % 2))) if event.kind == 'bump']
    assert len(found) == 1 and found[0].startswith('The first of 20 bumps, at (0.00, 0.00) m')


@pytest.mark.parametrize('states, told', [
    ([], ''), ([(State.IDLE, '')], 'idle'),
    ([(State.CLEANING, 'working')], 'not ended when the recording ended, cleaning: working'),
    ([(State.CLEANING, 'working'), (State.IDLE, 'done')], 'ended: done'),
    ([(State.CLEANING, 'working'), (State.STRANDED, 'stuck')], 'stranded: stuck'),
    ([(State.GOING_TO, '')], 'not ended when the recording ended, going to'),
    ([(len(State), '')], f'not ended when the recording ended, state {len(State)}')])
def test_outcomes(states, told):
    said = [MissionState(float(time), state, '', message) for time, (state, message) in enumerate(states)]
    assert summary(record(states=said)).outcome == told


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
