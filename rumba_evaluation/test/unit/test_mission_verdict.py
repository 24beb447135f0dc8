"""A run is judged by its messages, goal by goal and guard by guard; nothing passes without a message."""

import math

import pytest

from rumba_evaluation.verdicts.conditions import Battery, Collisions, Condition, Coverage, Docked, Reach
from rumba_evaluation.verdicts.field_conditions import Field, FieldCondition
from rumba_evaluation.verdicts.mission_requirements import Requirements
from rumba_evaluation.verdicts.mission_verdict import Judge
from rumba_sim.model.common.errors import ConfigError
from rumba_sim.model.common.geometry import Pose

LIMIT = 100.0  # [s]
ANYWHERE = math.nan


def judged(*conditions):
    """A judge of conditions."""
    return Judge(conditions, LIMIT)


def verdicts(judge):
    """Whether each condition is met, and the words of the verdict, by the name of the condition."""
    return {name: (is_met, words) for name, is_met, words, _ in judge.verdicts(lambda condition: f'/{condition.name}')}


def met(condition, *values):
    """Whether a condition is met after values."""
    for value in values:
        condition.update(value)
    return condition.is_met


# --- conditions ---------------------------------------------------------------------------------------------------

@pytest.mark.parametrize('values, is_met', [
    ([0.5], True), ([0.499], False), ([0.7, 0.2], False), ([math.nan], False), ([], False)])
def test_the_newest_coverage_counts(values, is_met):
    assert met(Coverage(0.5), *values) is is_met


@pytest.mark.parametrize('poses, is_met', [
    ([Pose(3.0, 1.1, 0.0)], True),
    ([Pose(3.0, 1.1, 0.0), Pose(9.0, 9.0, 0.0)], True),  # once is enough
    ([Pose(1.0, 3.0, 0.0)], False),
    ([Pose(3.0, 1.21, 0.0)], False)])
def test_a_waypoint_is_reached_once_within_the_distance(poses, is_met):
    assert met(Reach('reach', Pose(3.0, 1.0, ANYWHERE), 0.2, 0.1), *poses) is is_met


@pytest.mark.parametrize('theta, is_met', [(3.1, True), (-3.1, True), (3.0, False), (-2.9, False)])
def test_a_heading_is_compared_around_the_circle(theta, is_met):
    assert met(Reach('reach', Pose(3.0, 1.0, 3.14), 0.2, 0.1), Pose(3.0, 1.0, theta)) is is_met


def test_position_and_heading_must_be_right_at_the_same_time():
    condition = Reach('reach', Pose(3.0, 1.0, 1.0), 0.2, 0.1)
    assert not met(condition, Pose(0.0, 0.0, 1.0), Pose(3.0, 1.0, 1.5))
    assert condition.measured() == 'the position, with a smallest error of the heading of 0.50 rad'


def test_the_smallest_distance_to_a_waypoint_is_reported():
    condition = Reach('reach', Pose(3.0, 1.0, 1.0), 0.2, 0.1)
    assert not met(condition, Pose(3.0, 2.5, 0.0), Pose(3.0, 3.0, 0.0))
    assert condition.measured() == 'a smallest distance of 1.50 m'


@pytest.mark.parametrize('contacts, is_met, words', [
    ([True, True], False, 'on the dock, which it never left'), ([False, True], True, 'on the dock'),
    ([True, False, True], True, 'on the dock'), ([True, False, True, False], False, 'off the dock')])
def test_a_robot_that_never_left_its_dock_has_not_docked(contacts, is_met, words):
    condition = Docked()
    assert met(condition, *contacts) is is_met
    assert condition.measured() == words


@pytest.mark.parametrize('charges, is_met', [
    ([30.0, 20.0], True), ([30.0, 19.9, 50.0], False), ([30.0, math.nan], True), ([math.nan], False)])
def test_the_lowest_charge_counts(charges, is_met):
    assert met(Battery(20.0), *charges) is is_met


def test_a_bumper_that_stays_pressed_is_one_collision():
    assert met(Collisions(2), True, True, False, True, True, False)
    assert not met(Collisions(1), True, True, False, True)
    assert met(Collisions(0), False, False)


@pytest.mark.parametrize('values, is_met', [
    ([-0.3, 0.3], True), ([0.0, 0.31, 0.0], False), ([-0.31], False), ([math.nan], False), (['0.1'], False),
    ([None], False), ([True], False), ([False], True)])
def test_a_field_stays_in_its_range(values, is_met):
    assert met(Field('rumba/odom/twist/twist/linear/x', -0.3, 0.3), *values) is is_met


def test_a_value_that_is_not_a_number_is_reported():
    condition = Field('rumba/battery_status/debug_message', 0.0, 1.0)
    condition.update('17.0 V')
    condition.update(0.5)
    assert not condition.is_met
    assert condition.measured() == "'17.0 V', which is not a number"


# --- the run ------------------------------------------------------------------------------------------------------

def test_a_run_ends_when_all_goals_are_met_at_the_same_time():
    coverage, docked = Coverage(0.5), Docked()
    judge = judged(coverage, docked)
    for now, condition, value in [(10.0, docked, True), (11.0, docked, False), (12.0, docked, True),
                                  (13.0, docked, False), (14.0, coverage, 0.6)]:
        judge.update(condition, value, now)
        assert not judge.is_over
    judge.update(docked, True, 15.5)
    assert judge.is_over
    assert verdicts(judge)['coverage'] == (
        True, 'coverage: required at least 50.0 % of the floor swept; measured 60.0 % after 5.5 s of 100 s')
    assert verdicts(judge)['docked'][0]


def test_a_violated_guard_fails_but_does_not_end_the_run():
    coverage, collisions = Coverage(0.5), Collisions(0)
    judge = judged(coverage, collisions)
    judge.update(collisions, False, 0.0)
    judge.locate(Pose(3.0, 1.5, 0.0))
    judge.update(collisions, True, 0.5)
    judge.locate(Pose(4.0, 1.5, 0.0))
    judge.update(coverage, 0.4, 1.0)
    assert not judge.is_over
    judge.update(coverage, 0.5, 2.0)
    assert judge.is_over
    assert verdicts(judge)['coverage'][0]
    assert verdicts(judge)['collisions'] == (
        False, 'collisions: required at most 0 collisions; measured 1 after 2.0 s of 100 s; violated first after '
               '0.5 s, at (3.00, 1.50) m')


def test_a_run_does_not_end_before_every_guard_has_a_value():
    coverage, battery = Coverage(0.5), Battery(20.0)
    judge = judged(coverage, battery)
    judge.update(coverage, 0.9, 0.0)
    assert not judge.is_over
    judge.update(battery, 50.0, 1.0)
    assert judge.is_over


def test_without_goals_a_run_lasts_until_the_time_limit():
    battery = Battery(20.0)
    judge = judged(battery)
    judge.update(battery, 50.0, 7.0)
    judge.check_time(7.0 + LIMIT - 0.1)
    assert not judge.is_over
    judge.check_time(7.0 + LIMIT)
    assert judge.is_over
    assert verdicts(judge)['battery'] == (
        True, 'battery: required never less than 20.0 % of charge; measured a lowest charge of 50.0 % '
              'after 100.0 s of 100 s: the time limit is reached')


def test_values_after_the_time_limit_are_ignored():
    coverage, battery = Coverage(0.5), Battery(20.0)
    judge = judged(coverage, battery)
    judge.update(coverage, 0.4, 0.0)
    judge.update(battery, 50.0, 0.0)
    judge.update(coverage, 0.6, LIMIT)
    judge.update(battery, 10.0, LIMIT)
    assert not verdicts(judge)['coverage'][0]
    assert verdicts(judge)['battery'][0]
    assert verdicts(judge)['coverage'][1].endswith('measured 40.0 % after 100.0 s of 100 s: the time limit is reached')


def test_a_condition_without_a_value_fails():
    coverage, docked, collisions = Coverage(0.5), Docked(), Collisions(5)
    judge = judged(coverage, docked, collisions)
    judge.update(coverage, 0.6, 0.0)
    judge.check_time(LIMIT)
    assert [is_met for is_met, _ in verdicts(judge).values()] == [True, False, False]
    assert 'measured nothing on /collisions after' in verdicts(judge)['collisions'][1]


def test_it_is_told_why_a_condition_has_no_value():
    coverage, collisions = Coverage(0.5), Collisions(5)
    judge = judged(coverage, collisions)
    judge.update(coverage, 0.4, 0.0)
    judge.check_time(LIMIT)
    words = [verdict.words for verdict in judge.verdicts(lambda _: '/topic', lambda _: 'nobody is there')]
    assert [each.endswith('; nobody is there') for each in words] == [False, True]


def test_a_run_without_any_message_does_not_begin_and_can_be_aborted():
    judge = judged(Coverage(0.5))
    judge.check_time(10.0 * LIMIT)
    assert not judge.is_over
    judge.abort('no message')
    assert verdicts(judge)['coverage'][1].endswith('measured nothing on /coverage after 0.0 s of 100 s: no message')


def test_in_an_aborted_run_guards_fail_and_goals_that_are_met_stay_met():
    coverage, docked, battery = Coverage(0.5), Docked(), Battery(20.0)
    judge = judged(coverage, docked, battery)
    for condition, value in ((coverage, 0.6), (docked, False), (battery, 50.0)):
        judge.update(condition, value, 1.0)
    judge.abort('no message')
    assert [is_met for is_met, _ in verdicts(judge).values()] == [True, False, False]


def test_in_a_void_run_every_condition_fails_also_if_it_was_over():
    coverage, battery = Coverage(0.5), Battery(20.0)
    judge = judged(coverage, battery)
    judge.update(battery, 50.0, 1.0)
    judge.update(coverage, 0.6, 1.0)
    assert judge.is_over and all(is_met for is_met, _ in verdicts(judge).values())
    judge.annul('forged')
    judge.annul('forged again')
    assert [is_met for is_met, _ in verdicts(judge).values()] == [False, False]
    assert verdicts(judge)['coverage'][1].endswith('measured 60.0 % after 0.0 s of 100 s: forged')


def test_a_void_run_still_tells_why_it_ended():
    judge = judged(Coverage(0.5))
    judge.abort('the test was stopped')
    judge.annul('forged')
    assert verdicts(judge)['coverage'][1].endswith(': the test was stopped; forged')


def test_a_run_whose_time_goes_back_is_void():
    coverage = Coverage(0.5)
    judge = judged(coverage)
    judge.update(coverage, 0.2, 7.0)
    judge.update(coverage, 0.3, 9.0)
    judge.update(coverage, 0.9, 8.5)
    assert verdicts(judge)['coverage'] == (
        False, 'coverage: required at least 50.0 % of the floor swept; measured 30.0 % after 2.0 s of 100 s: '
               'the time went back from 9.0 s to 8.5 s')


# --- requirements -------------------------------------------------------------------------------------------------

def test_settings_become_conditions():
    requirements = Requirements(coverage=0.5, reach='1 2; 3 4 -0.5', docked=True, battery=20.0, collisions=0,
                                fields='rumba/battery_state/voltage 13 inf; /rumba/odom/twist/twist/linear/x -0.3 0.3')
    conditions = requirements.conditions()
    assert [condition.name for condition in conditions] == [
        'coverage', 'reach_1', 'reach_2', 'docked', 'battery', 'collisions', 'field_rumba_battery_state_voltage',
        'field_rumba_odom_twist_twist_linear_x']
    assert [condition.required for condition in conditions[1:3]] == [
        'to reach (1.00, 2.00) m within 0.10 m',
        'to reach (3.00, 4.00) m within 0.10 m and heading -0.50 rad within 0.20 rad']
    assert conditions[6].required == 'rumba/battery_state/voltage always within 13 to inf'
    assert [type(condition) for condition in Requirements(reach='1 2').conditions()] == [Reach]


@pytest.mark.parametrize('requirements, message', [
    (Requirements(), r'^there is no requirement: set one or more of coverage, reach, docked, '),
    (Requirements(reach='1'), r"^reach has '1': must be x y or x y theta"),
    (Requirements(reach='1 2; 3 nan'), r"^reach has '3 nan': "),
    (Requirements(reach='1 2 3 4'), r"^reach has '1 2 3 4': "),
    (Requirements(fields='rumba/odom 1'), r"^fields has 'rumba/odom 1': must be TOPIC/FIELD LOW HIGH"),
    (Requirements(fields='a/b 2 1'), r"^fields has 'a/b 2 1': "),
    (Requirements(fields='a/b low high'), r"^fields has 'a/b low high': "),
    (Requirements(fields='a/b nan 1'), r"^fields has 'a/b nan 1': "),
    (Requirements(fields='a/b 0 1; /a/b 0 2'), r'^field_a_b occurs twice: require one thing of each')])
def test_requirements_that_cannot_be_understood_are_refused(requirements, message):
    with pytest.raises(ConfigError, match=message):
        requirements.conditions()


def test_every_kind_of_condition_is_either_goal_or_guard():
    kinds = [*Condition.__subclasses__(), *FieldCondition.__subclasses__()]
    assert {kind.__name__: kind.is_guard for kind in kinds if kind is not FieldCondition} == {
        'Coverage': False, 'Reach': False, 'Docked': False, 'Battery': True, 'Collisions': True, 'Field': True,
        'Agreement': True, 'Rate': True}
