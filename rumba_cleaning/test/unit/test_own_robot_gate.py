"""What the gate lets through to a robot that is not ours."""

import math

import pytest

from rumba_cleaning.own_robot.gate import (CLEANER, PERSON, REPEATED, SEEK_DOCK, STANDING, STOP, Gate, Moment,
                                           Velocity, limited)
from rumba_sim.model.settings.robot_config import DriveConfig

SLOW = DriveConfig(max_speed=0.3, max_turn_rate=1.0, wheel_base=0.2)
AHEAD = Velocity(0.2, 0.1)


def gate_at(now=0.0, sources=('odom', 'scan')):
    """A gate at which all sources are heard, and the cleaner commands AHEAD."""
    gate = Gate(SLOW, 0.4, ['odom', 'scan'])
    for source in sources:
        gate.hear(source, Moment(now, now))
    gate.command(CLEANER, AHEAD, Moment(now, now))
    return gate


def test_a_command_passes_while_all_is_heard():
    gate = gate_at()
    assert gate.output(Moment(0.4, 0.4)) == AHEAD
    assert gate.reason == ''


@pytest.mark.parametrize('silent', ['odom', 'scan'])
def test_without_a_source_the_robot_stands_and_the_reason_is_told(silent):
    gate = gate_at(sources=[])
    for source in {'odom', 'scan'} - {silent}:
        gate.hear(source, Moment(0.0, 0.0))
    assert gate.output(Moment(0.0, 0.0)) == STOP
    assert gate.reason == f'nothing came on {silent} for 0.4 s'


def test_a_source_that_falls_silent_stops_it_and_one_that_comes_back_lets_it_go_on():
    gate = gate_at()
    assert gate.output(Moment(0.0, 0.0)) == AHEAD
    gate.command(CLEANER, AHEAD, Moment(0.41, 0.41))
    gate.hear('odom', Moment(0.41, 0.41))
    assert gate.output(Moment(0.41, 0.41)) == STOP
    gate.hear('scan', Moment(0.45, 0.45))
    assert gate.output(Moment(0.45, 0.45)) == AHEAD


def test_when_the_cleaner_is_silent_a_stop_is_commanded_for_a_second_and_then_nothing():
    gate = gate_at()
    gate.output(Moment(0.0, 0.0))
    assert gate.output(Moment(0.41, 0.41)) == STOP
    assert gate.output(Moment(0.41 + REPEATED, 0.41 + REPEATED)) == STOP
    assert gate.output(Moment(0.5 + REPEATED, 0.5 + REPEATED)) is None


def test_before_the_first_command_it_is_silent():
    gate = Gate(SLOW, 0.4, ['odom', 'scan'])
    assert gate.output(Moment(0.0, 0.0)) is None


def test_a_clock_that_stands_still_stops_the_robot_by_the_wall_clock():
    gate = gate_at()
    assert gate.output(Moment(0.0, STANDING)) == AHEAD
    assert gate.output(Moment(0.0, STANDING + 0.1)) == STOP


def test_a_person_goes_first_and_needs_no_scan():
    gate = gate_at(sources=[])
    gate.command(PERSON, Velocity(-0.1, 0.0), Moment(0.0, 0.0))
    assert gate.output(Moment(0.3, 0.3)) == Velocity(-0.1, 0.0)


def test_a_stop_holds_for_all_until_it_is_released():
    gate = gate_at()
    gate.output(Moment(0.0, 0.0))
    gate.stop('someone says so')
    gate.command(PERSON, AHEAD, Moment(0.0, 0.0))
    assert gate.output(Moment(0.0, 0.0)) == STOP
    assert gate.reason == 'someone says so'
    gate.release()
    assert gate.output(Moment(0.1, 0.1)) == AHEAD


def test_a_robot_that_is_to_seek_its_dock_needs_its_sources_as_one_that_is_driven():
    gate = gate_at()
    gate.command(CLEANER, SEEK_DOCK, Moment(0.0, 0.0))
    assert gate.output(Moment(0.3, 0.3)) == SEEK_DOCK
    gate.command(CLEANER, SEEK_DOCK, Moment(0.5, 0.5))
    gate.hear('odom', Moment(0.5, 0.5))
    assert gate.output(Moment(0.5, 0.5)) == STOP
    assert gate.output(Moment(1.0, 1.0)) == STOP  # the cleaner is silent
    gate.command(PERSON, AHEAD, Moment(1.0, 1.0))
    assert gate.output(Moment(1.0, 1.0)) == AHEAD


@pytest.mark.parametrize('number', [math.nan, math.inf])
def test_what_is_no_number_is_a_stop(number):
    gate = gate_at()
    gate.command(CLEANER, Velocity(0.1, number), Moment(0.1, 0.1))
    assert gate.output(Moment(0.1, 0.1)) == STOP


@pytest.mark.parametrize('asked, given', [
    ((0.6, 0.0), (0.3, 0.0)), ((-0.6, 0.0), (-0.3, 0.0)), ((0.0, -4.0), (0.0, -1.0)), ((0.1, 0.5), (0.1, 0.5)),
    ((0.3, 1.0), (0.225, 0.75))])
def test_limits_keep_the_curve(asked, given):
    assert limited(Velocity(*asked), SLOW)[:2] == pytest.approx(given)
