"""A run is judged by what was heard, goal by goal and guard by guard, and nothing passes unheard."""

import math

import pytest

from rumba_evaluation.verdicts.mission_asked import Asked
from rumba_evaluation.verdicts.mission_verdict import (Battery, Collisions, Condition, Coverage, Docked, Field, Judge,
                                                       Reach)
from rumba_sim.model.errors import ConfigError
from rumba_sim.model.geometry import Pose

LIMIT = 100.0  # [s]
ANYWHERE = math.nan


def judged(*conditions):
    """A judge of conditions, each with some name."""
    return Judge(conditions, LIMIT)


def said(judge):
    """Whether each condition is met, and what is said of it, by its name."""
    return {name: (is_met, words) for name, is_met, words in judge.verdicts(lambda condition: f'/{condition.name}')}


def met(condition, *values):
    """Whether a condition is met after values."""
    for value in values:
        condition.hear(value)
    return condition.is_met


# --- conditions ---------------------------------------------------------------------------------------------------

@pytest.mark.parametrize('values, is_met', [
    ([0.5], True), ([0.499], False), ([0.7, 0.2], False), ([math.nan], False), ([], False)])
def test_the_newest_coverage_counts(values, is_met):
    assert met(Coverage(0.5), *values) is is_met


@pytest.mark.parametrize('poses, is_met', [
    ([Pose(3.0, 1.1, 0.0)], True),
    ([Pose(3.0, 1.1, 0.0), Pose(9.0, 9.0, 0.0)], True),  # reached once is reached
    ([Pose(1.0, 3.0, 0.0)], False),
    ([Pose(3.0, 1.21, 0.0)], False)])
def test_a_place_is_reached_once_and_near_enough(poses, is_met):
    assert met(Reach('reach', Pose(3.0, 1.0, ANYWHERE), 0.2, 0.1), *poses) is is_met


@pytest.mark.parametrize('theta, is_met', [(3.1, True), (-3.1, True), (3.0, False), (-2.9, False)])
def test_a_heading_is_compared_around_the_circle(theta, is_met):
    assert met(Reach('reach', Pose(3.0, 1.0, 3.14), 0.2, 0.1), Pose(3.0, 1.0, theta)) is is_met


def test_place_and_heading_must_fit_at_the_same_time():
    condition = Reach('reach', Pose(3.0, 1.0, 1.0), 0.2, 0.1)
    assert not met(condition, Pose(0.0, 0.0, 1.0), Pose(3.0, 1.0, 1.5))
    assert condition.measured() == 'there, with a heading 0.50 rad off at the least'


def test_who_comes_not_near_is_told_how_near():
    condition = Reach('reach', Pose(3.0, 1.0, 1.0), 0.2, 0.1)
    assert not met(condition, Pose(3.0, 2.5, 0.0), Pose(3.0, 3.0, 0.0))
    assert condition.measured() == '1.50 m from it at the nearest'


@pytest.mark.parametrize('contacts, is_met, words', [
    ([True, True], False, 'on the dock, which it never left'), ([False, True], True, 'on the dock'),
    ([True, False, True], True, 'on the dock'), ([True, False, True, False], False, 'off the dock')])
def test_who_never_left_its_dock_has_not_docked(contacts, is_met, words):
    condition = Docked()
    assert met(condition, *contacts) is is_met
    assert condition.measured() == words


@pytest.mark.parametrize('charges, is_met', [
    ([30.0, 20.0], True), ([30.0, 19.9, 50.0], False), ([30.0, math.nan], True), ([math.nan], False)])
def test_the_lowest_charge_counts(charges, is_met):
    assert met(Battery(20.0), *charges) is is_met


def test_only_a_bumper_that_is_pressed_anew_is_a_collision():
    assert met(Collisions(2), True, True, False, True, True, False)
    assert not met(Collisions(1), True, True, False, True)
    assert met(Collisions(0), False, False)


@pytest.mark.parametrize('values, is_met', [
    ([-0.3, 0.3], True), ([0.0, 0.31, 0.0], False), ([-0.31], False), ([math.nan], False), (['0.1'], False),
    ([None], False), ([True], False), ([False], True)])
def test_a_field_stays_in_its_range(values, is_met):
    assert met(Field('rumba/odom/twist/twist/linear/x', -0.3, 0.3), *values) is is_met


def test_what_is_no_number_is_told():
    condition = Field('rumba/battery_status/debug_message', 0.0, 1.0)
    condition.hear('17.0 V')
    condition.hear(0.5)
    assert not condition.is_met
    assert condition.measured() == "'17.0 V', which is no number"


# --- the run ------------------------------------------------------------------------------------------------------

def test_a_run_ends_when_all_goals_are_met_at_once():
    coverage, docked = Coverage(0.5), Docked()
    judge = judged(coverage, docked)
    for now, condition, value in [(10.0, docked, True), (11.0, docked, False), (12.0, docked, True),
                                  (13.0, docked, False), (14.0, coverage, 0.6)]:
        judge.hear(condition, value, now)
        assert not judge.is_over
    judge.hear(docked, True, 15.5)
    assert judge.is_over
    assert said(judge)['coverage'] == (True, 'coverage: asked at least 50.0 % of the floor swept; measured 60.0 % '
                                             'after 5.5 s of 100 s')
    assert said(judge)['docked'][0]


def test_a_guard_that_breaks_is_judged_but_ends_nothing():
    coverage, collisions = Coverage(0.5), Collisions(0)
    judge = judged(coverage, collisions)
    judge.hear(collisions, True, 0.0)
    judge.hear(coverage, 0.4, 1.0)
    assert not judge.is_over
    judge.hear(coverage, 0.5, 2.0)
    assert judge.is_over
    assert said(judge)['coverage'][0]
    assert said(judge)['collisions'] == (False, 'collisions: asked at most 0 collisions; measured 1 '
                                                'after 2.0 s of 100 s')


def test_goals_that_are_met_wait_until_every_guard_was_heard():
    coverage, battery = Coverage(0.5), Battery(20.0)
    judge = judged(coverage, battery)
    judge.hear(coverage, 0.9, 0.0)
    assert not judge.is_over
    judge.hear(battery, 50.0, 1.0)
    assert judge.is_over


def test_guards_alone_are_judged_until_the_time_is_up():
    battery = Battery(20.0)
    judge = judged(battery)
    judge.hear(battery, 50.0, 7.0)
    judge.look(7.0 + LIMIT - 0.1)
    assert not judge.is_over
    judge.look(7.0 + LIMIT)
    assert judge.is_over
    assert said(judge)['battery'] == (True, 'battery: asked never less than 20.0 % of charge; measured 50.0 % at the '
                                            'least after 100.0 s of 100 s: the time was up')


def test_what_comes_when_the_time_is_up_counts_no_more():
    coverage, battery = Coverage(0.5), Battery(20.0)
    judge = judged(coverage, battery)
    judge.hear(coverage, 0.4, 0.0)
    judge.hear(battery, 50.0, 0.0)
    judge.hear(coverage, 0.6, LIMIT)
    judge.hear(battery, 10.0, LIMIT)
    assert not said(judge)['coverage'][0]
    assert said(judge)['battery'][0]
    assert said(judge)['coverage'][1].endswith('measured 40.0 % after 100.0 s of 100 s: the time was up')


def test_a_condition_of_which_nothing_is_heard_fails():
    coverage, docked, collisions = Coverage(0.5), Docked(), Collisions(5)
    judge = judged(coverage, docked, collisions)
    judge.hear(coverage, 0.6, 0.0)
    judge.look(LIMIT)
    assert [is_met for is_met, _ in said(judge).values()] == [True, False, False]
    assert 'measured nothing on /collisions after' in said(judge)['collisions'][1]


def test_a_run_of_which_nothing_is_heard_does_not_begin_and_is_given_up():
    judge = judged(Coverage(0.5))
    judge.look(10.0 * LIMIT)
    assert not judge.is_over
    judge.give_up('nobody spoke')
    assert said(judge)['coverage'][1].endswith('measured nothing on /coverage after 0.0 s of 100 s: nobody spoke')


def test_a_guard_that_is_not_judged_to_the_end_fails_and_a_goal_that_is_met_stays_met():
    coverage, docked, battery = Coverage(0.5), Docked(), Battery(20.0)
    judge = judged(coverage, docked, battery)
    for condition, value in ((coverage, 0.6), (docked, False), (battery, 50.0)):
        judge.hear(condition, value, 1.0)
    judge.give_up('the robot fell silent')
    assert [is_met for is_met, _ in said(judge).values()] == [True, False, False]


# --- what is asked ------------------------------------------------------------------------------------------------

def test_settings_become_conditions():
    asked = Asked(coverage=0.5, reach='1 2; 3 4 -0.5', docked=True, battery=20.0, collisions=0,
                  fields='rumba/battery_state/voltage 13 inf; /rumba/odom/twist/twist/linear/x -0.3 0.3')
    conditions = asked.conditions()
    assert [condition.name for condition in conditions] == [
        'coverage', 'reach_1', 'reach_2', 'docked', 'battery', 'collisions', 'field_rumba_battery_state_voltage',
        'field_rumba_odom_twist_twist_linear_x']
    assert [condition.asked for condition in conditions[1:3]] == [
        'to reach (1.00, 2.00) m within 0.10 m',
        'to reach (3.00, 4.00) m within 0.10 m and heading -0.50 rad within 0.20 rad']
    assert conditions[6].asked == 'rumba/battery_state/voltage always within 13 to inf'
    assert [type(condition) for condition in Asked(reach='1 2').conditions()] == [Reach]


@pytest.mark.parametrize('asked, message', [
    (Asked(), r'^nothing is asked: set one or more of coverage, reach, docked, '),
    (Asked(reach='1'), r"^reach has '1': must be x y or x y theta"),
    (Asked(reach='1 2; 3 nan'), r"^reach has '3 nan': "),
    (Asked(reach='1 2 3 4'), r"^reach has '1 2 3 4': "),
    (Asked(fields='rumba/odom 1'), r"^fields has 'rumba/odom 1': must be TOPIC/FIELD LOW HIGH"),
    (Asked(fields='a/b 2 1'), r"^fields has 'a/b 2 1': "),
    (Asked(fields='a/b low high'), r"^fields has 'a/b low high': "),
    (Asked(fields='a/b nan 1'), r"^fields has 'a/b nan 1': "),
    (Asked(fields='a/b 0 1; /a/b 0 2'), r'^field_a_b is asked twice')])
def test_what_cannot_be_understood_is_refused(asked, message):
    with pytest.raises(ConfigError, match=message):
        asked.conditions()


def test_every_kind_of_condition_is_either_goal_or_guard():
    assert {kind.__name__: kind.is_guard for kind in Condition.__subclasses__()} == {
        'Coverage': False, 'Reach': False, 'Docked': False, 'Battery': True, 'Collisions': True, 'Field': True}
