"""Which of several inputs drives a robot: priorities and timeouts, with times of our own and without ROS."""

import pytest

from rumba_sim.ros.common import teleop
from rumba_sim.ros.robot.robot_node import INPUTS
from rumba_sim.ros.robot.velocity_mux import Input, VelocityMux

PERSON, PROGRAM, ESCAPE = Input('person', 100, 0.5), Input('program', 10, 0.5), Input('escape', 255, 0.2)


def mux():
    """A multiplexer of three inputs, in no order."""
    return VelocityMux([PROGRAM, ESCAPE, PERSON])


@pytest.mark.parametrize('name', ['person', 'program', 'escape'])
def test_a_single_input_always_passes(name):
    subject = mux()
    assert all(subject.passes(name, now) for now in (0.0, 0.1, 100.0))


def test_a_command_of_lower_priority_is_ignored_until_the_timeout_of_the_higher_one_is_over():
    subject = mux()
    assert subject.passes('program', 10.0)
    assert subject.passes('person', 10.1)
    assert [subject.passes('program', now) for now in (10.1, 10.59, 10.6, 10.7)] == [False, False, True, True]


def test_each_command_of_higher_priority_begins_its_timeout_again():
    subject = mux()
    for now in (10.0, 10.4, 10.8):
        assert subject.passes('person', now)
    assert [subject.passes('program', now) for now in (11.2, 11.31)] == [False, True]


def test_a_lower_priority_never_holds_up_a_higher_one():
    subject = mux()
    assert subject.passes('program', 10.0)
    assert subject.passes('person', 10.0)
    assert subject.passes('escape', 10.0)
    assert not subject.passes('person', 10.1)


def test_each_input_has_a_timeout_of_its_own():
    subject = mux()
    subject.passes('person', 10.0)
    subject.passes('escape', 10.0)
    assert not subject.passes('person', 10.19)
    assert subject.passes('person', 10.21)
    assert not subject.passes('program', 10.3)


def test_an_input_that_is_ignored_still_overrides_lower_ones_by_its_last_command():
    subject = mux()
    subject.passes('escape', 10.0)
    assert not subject.passes('person', 10.19)
    assert not subject.passes('program', 10.6)
    assert subject.passes('program', 10.7)


def test_inputs_of_one_priority_share_the_robot():
    subject = VelocityMux([Input('left', 5, 1.0), Input('right', 5, 1.0)])
    assert all(subject.passes(name, 10.0) for name in ('left', 'right', 'left'))


def test_a_person_goes_before_a_program_at_a_robot():
    assert INPUTS[0] == (teleop.TOPIC, 100, teleop.TIMEOUT) == ('teleop/cmd_vel', 100, 0.5)
    assert INPUTS[1][:2] == ('cmd_vel', 10)
