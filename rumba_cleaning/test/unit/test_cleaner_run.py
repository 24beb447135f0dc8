"""A goal of the cleaner from its first reading to its result: commands, a person who drives, and how it ends."""

import math
import sys

import numpy as np
import pytest
import rospy
from scripted_goal import AHEAD, Robot, ahead, arrive, divide

from rumba_cleaning.behaviour import STOP, Command
from rumba_cleaning.mission.stages import State
from rumba_cleaning.outcome import Outcome
from rumba_cleaning.ros.cleaner.goals import run as module
from rumba_msg.msg import CleaningStatus


def test_a_goal_drives_and_is_answered_once_the_robot_is_at_rest(monkeypatch):
    robot = Robot(monkeypatch, ahead, ahead, arrive)
    assert robot.reads() == [(0.2, 0.5), 'down', 'feedback']
    assert robot.reads() == [(0.2, 0.5), 'down']
    assert robot.status == (State.CLEANING, 'zigzag', '')
    assert robot.reads() == ['rest']
    assert robot.reads(moved=0.02) == []
    assert not robot.run.is_closed
    assert robot.reads(moved=0.0) == ['done after 0 s: there', ('succeeded', Outcome.SUCCEEDED, 'there')]
    assert robot.status == (State.IDLE, '', 'there')
    assert robot.behaviour.ends == 1


def test_a_cleaning_that_misses_its_target_is_aborted_with_a_code_of_its_own(monkeypatch):
    robot = Robot(monkeypatch, lambda behaviour: behaviour.fail('what can be reached is swept', Outcome.INCOMPLETE))
    robot.reads(moved=0.0)
    robot.reads(moved=0.0)
    assert robot.reads(moved=0.0)[0] == 'given up after 0 s: what can be reached is swept'
    assert robot.answer == ('aborted', Outcome.INCOMPLETE, 'what can be reached is swept')


def test_feedback_comes_once_a_second_of_the_robots_time(monkeypatch):
    robot = Robot(monkeypatch, ahead)
    assert ['feedback' in robot.reads(0.25) for _ in range(9)] == [
        True, False, False, True, False, False, False, True, False]


def test_figures_of_the_end_are_awaited_if_the_result_needs_them(monkeypatch):
    robot = Robot(monkeypatch, arrive)
    robot.run.activity.needs_figures = True
    for _ in range(5):
        robot.reads(moved=0.0)
        assert not robot.run.is_closed
    robot.senses.cleaning = CleaningStatus()
    robot.senses.cleaning.header.stamp = robot.senses.stamp
    robot.reads(moved=0.0)
    assert robot.answer[0] == 'succeeded'


@pytest.mark.parametrize('readings', [21, 0])
def test_a_robot_that_does_not_come_to_rest_is_not_waited_for_without_end(monkeypatch, readings):
    robot = Robot(monkeypatch, arrive)
    robot.reads()
    for _ in range(readings):
        assert not robot.run.is_closed
        robot.reads()
    if not readings:
        assert robot.waits(4.9) == []
        robot.waits(0.2)
    assert robot.answer[0] == 'succeeded'


# --- a person drives --------------------------------------------------------------------------------------------------

def test_while_a_person_drives_nothing_is_commanded_and_then_the_goal_goes_on(monkeypatch):
    robot = Robot(monkeypatch, ahead)
    robot.reads()
    robot.teleop.is_driving = True
    for _ in range(3):
        assert robot.reads(moved=0.5) == ['forget']
        assert robot.status == (State.YIELDING, 'zigzag', 'a person drives')
    assert robot.behaviour.watched == pytest.approx([0.51, 1.01, 1.51])
    robot.teleop.is_driving = False
    assert robot.reads() == [(0.2, 0.5), 'down']
    assert robot.status[0] is State.CLEANING
    assert robot.behaviour.ends == 0


def test_feedback_goes_on_while_a_person_drives(monkeypatch):
    robot = Robot(monkeypatch, ahead)
    robot.reads()
    robot.teleop.is_driving = True
    assert sum('feedback' in robot.reads() for _ in range(30)) == 3


def test_the_time_in_which_a_person_drives_counts_for_the_time_limit(monkeypatch):
    robot = Robot(monkeypatch, ahead, time_limit=5.0)
    robot.reads()
    robot.teleop.is_driving = True
    for _ in range(60):
        robot.reads()
    robot.teleop.is_driving = False
    assert robot.reads() == ['rest']
    robot.reads(moved=0.0)
    robot.reads(moved=0.0)
    assert robot.answer[:2] == ('aborted', Outcome.TIMED_OUT)


# --- ends that nobody planned -----------------------------------------------------------------------------------------

def test_an_exception_ends_the_goal_with_a_line_that_says_which(monkeypatch):
    robot = Robot(monkeypatch, ahead, divide)
    robot.reads()
    assert robot.reads() == ['rest']
    robot.reads(moved=0.0)
    robot.reads(moved=0.0)
    assert robot.answer == ('aborted', Outcome.ERROR, "strategy 'zigzag': ZeroDivisionError: division by zero")
    assert robot.behaviour.ends == 1
    assert robot.status[0] is State.IDLE


@pytest.mark.parametrize('command, shown', [
    (Command('0.1', 0), "Command(v='0.1', w=0, brushes_up=False, seeks_dock=False)"),
    (None, 'None'), ((0.1, 0.0), '(0.1, 0.0)'),
    (Command(math.nan, 0.0), 'Command(v=nan, w=0.0, brushes_up=False, seeks_dock=False)'),
    (math.pi, '3.141592653589793'),
    (Command(0.1, -math.inf), 'Command(v=0.1, w=-inf, brushes_up=False, seeks_dock=False)'),
    (Command(0.1, None), 'Command(v=0.1, w=None, brushes_up=False, seeks_dock=False)'),
    (Command(0.1, 10 ** 400), 'Command(v=0.1, w=1000'),
    (Command(1j, 0.0), 'Command(v=1j, w=0.0, brushes_up=False, seeks_dock=False)'),
    (Command(0.1, 0.0, 'up'), "Command(v=0.1, w=0.0, brushes_up='up', seeks_dock=False)")])
def test_a_strategy_that_answers_nonsense_ends_the_goal_with_its_name_and_the_value(monkeypatch, command, shown):
    robot = Robot(monkeypatch, ahead, lambda _: command)
    robot.reads()
    assert robot.reads() == ['rest']
    robot.reads(moved=0.0)
    robot.reads(moved=0.0)
    how, code, message = robot.answer
    assert (how, code) == ('aborted', Outcome.ERROR)
    assert message.startswith(f"strategy 'zigzag': Scripted.update returned {shown}")
    assert message.endswith(': must be a Command of finite numbers')


def test_numbers_of_numpy_are_numbers(monkeypatch):
    robot = Robot(monkeypatch, lambda _: Command(np.float32(0.25), np.int64(1), np.bool_(False)))
    assert robot.reads() == [(0.25, 1), 'down', 'feedback']


def leave(_):
    """End the process."""
    sys.exit('good bye')


def mumble(behaviour):
    """Say something that is no text."""
    behaviour.message = 5
    return AHEAD


@pytest.mark.parametrize('decide, code, message', [
    (leave, Outcome.ERROR, "strategy 'zigzag': SystemExit: good bye"),
    (mumble, Outcome.ERROR, "strategy 'zigzag': TypeError: object of type 'int' has no len()"),
    (lambda behaviour: behaviour.succeed(None), Outcome.SUCCEEDED, 'None'),
    (lambda behaviour: behaviour.succeed('a\nb'), Outcome.SUCCEEDED, 'a\\nb'),
    (lambda behaviour: behaviour.fail('x', 'bad'), Outcome.ERROR, "x (its outcome is 'bad': must be an Outcome)"),
    (lambda behaviour: behaviour.succeed('x', Outcome.UNKNOWN), Outcome.ERROR,
     'x (its outcome is <Outcome.UNKNOWN: 0>: must be an Outcome)')])
def test_whatever_a_strategy_does_its_goal_ends(monkeypatch, decide, code, message):
    robot = Robot(monkeypatch, ahead, decide)
    for _ in range(5):
        robot.reads(moved=0.0)
        if robot.run.is_closed:
            break
    assert robot.answer[1] == code
    assert robot.answer[2] == message


def test_a_world_that_is_reset_has_the_goal_begin_again_even_after_its_end(monkeypatch):
    robot = Robot(monkeypatch, ahead, arrive, ahead, arrive)
    for _ in range(2):
        robot.reads()
    assert robot.behaviour.ends == 1
    robot.told.clear()
    robot.run.begin_again()
    assert robot.told == ['forget', 'the simulator was reset: begins again']
    assert not robot.run.is_closed
    assert robot.reads()[:2] == [(0.2, 0.5), 'down']
    assert robot.reads() == ['rest']
    for _ in range(2):
        robot.reads(moved=0.0)
    assert robot.answer[0] == 'succeeded'
    assert robot.behaviour.ends == 2


def test_an_answer_is_given_although_it_cannot_be_announced(monkeypatch):
    robot = Robot(monkeypatch, ahead)
    robot.reads()
    monkeypatch.setattr(robot.run.activity, 'report', lambda *_: 1 / 0)
    robot.run.interrupt(Outcome.CANCELLED, 'cancelled')
    assert robot.answer[0] == 'canceled'


def test_a_robot_that_falls_gives_up_at_once_and_is_stranded(monkeypatch):
    robot = Robot(monkeypatch, ahead)
    robot.reads()
    robot.senses.has_fallen = robot.teleop.is_driving = True
    assert robot.reads() == ['rest']
    robot.reads(moved=0.0)
    robot.reads(moved=0.0)
    assert robot.answer == ('aborted', Outcome.FALLEN, 'a wheel hangs over a cliff: the robot must be put elsewhere')
    assert robot.status[0] is State.STRANDED


def test_an_empty_battery_leaves_the_robot_stranded(monkeypatch):
    robot = Robot(monkeypatch, lambda behaviour: behaviour.fail('the battery is empty', Outcome.BATTERY_EMPTY))
    for _ in range(3):
        robot.reads(moved=0.0)
    assert robot.answer == ('aborted', Outcome.BATTERY_EMPTY, 'the battery is empty')
    assert robot.status == (State.STRANDED, '', 'the battery is empty')


def test_a_sensor_that_is_silent_ends_the_goal_after_5_s(monkeypatch):
    robot = Robot(monkeypatch, ahead)
    robot.reads()
    robot.senses.is_complete = False
    for _ in range(10):
        assert robot.reads(0.5) == []
    robot.reads(0.5)
    assert robot.answer == ('aborted', Outcome.NO_READINGS, 'no reading')


def test_dock_status_without_bumper_and_cliff_ends_the_goal_once_they_had_time_to_come(monkeypatch):
    robot = Robot(monkeypatch, ahead)
    robot.reads()
    robot.senses.unread = 51
    assert robot.waits(0.1) + robot.waits(1.9) == []
    robot.waits(0.2)
    assert robot.answer[1] == Outcome.NO_READINGS


def test_that_dock_status_is_read_first_after_a_long_plan_does_not_end_the_goal(monkeypatch):
    robot = Robot(monkeypatch, ahead)
    for _ in range(3):
        robot.senses.unread = 51
        assert robot.waits(10.0) + robot.waits(1.9) == []
        robot.senses.unread = 0
        robot.reads()


@pytest.mark.parametrize('stamp, patience', [(rospy.Time(1), 2.0), (None, module.NEVER_CAME_AFTER)])
def test_a_robot_that_nobody_publishes_for_is_gone(monkeypatch, stamp, patience):
    robot = Robot(monkeypatch, ahead)
    robot.senses.stamp = stamp
    robot.senses.is_alone = True
    assert robot.waits(patience - 0.1) == []
    robot.waits(0.2)
    assert robot.answer == ('aborted', Outcome.NO_READINGS, 'the robot is gone')


def test_a_robot_whose_time_stands_still_is_waited_for(monkeypatch):
    robot = Robot(monkeypatch, ahead)
    robot.reads()
    assert robot.waits(1000.0) == []
    assert not robot.run.is_closed


# --- clients ----------------------------------------------------------------------------------------------------------

@pytest.mark.parametrize('outcome', [Outcome.CANCELLED, Outcome.PREEMPTED])
def test_an_interrupted_goal_stops_the_robot_and_is_answered_at_once(monkeypatch, outcome):
    robot = Robot(monkeypatch, ahead)
    robot.reads()
    robot.told.clear()
    robot.run.interrupt(outcome, 'for a reason')
    assert robot.told == ['rest', 'ended after 0 s: for a reason', ('canceled', outcome, 'for a reason')]
    assert robot.status == (State.IDLE, '', 'for a reason')
    assert robot.behaviour.ends == 1


def test_a_goal_that_has_ended_keeps_its_outcome_if_it_is_interrupted_before_the_robot_is_at_rest(monkeypatch):
    robot = Robot(monkeypatch, arrive)
    robot.reads()
    robot.run.interrupt(Outcome.CANCELLED, 'cancelled')
    assert robot.answer == ('succeeded', Outcome.SUCCEEDED, 'there')


def test_a_behaviour_that_goes_wrong_when_it_ends_still_gets_its_client_an_answer(monkeypatch):
    robot = Robot(monkeypatch, ahead)
    robot.reads()
    monkeypatch.setattr(robot.behaviour, 'terminate', lambda: 1 / 0)
    robot.run.interrupt(Outcome.CANCELLED, 'cancelled')
    assert robot.answer[0] == 'canceled'


def test_brushes_are_asked_again_at_the_beginning_of_each_goal(monkeypatch):
    assert Robot(monkeypatch, lambda _: STOP).told == ['forget']
