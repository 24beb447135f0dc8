"""Fields that agree with others, and messages that come often enough; what comes for a tick counts in one order."""

import math

import pytest

from rumba_evaluation.verdicts.awaited import PATIENCE, START, STEADY, TRIES, Awaited
from rumba_evaluation.verdicts.field_conditions import Agreement, Rate
from rumba_evaluation.verdicts.mission_requirements import Requirements
from rumba_evaluation.verdicts.mission_verdict import Judge
from rumba_evaluation.verdicts.tick_readings import TickReadings
from rumba_sim.model.common.errors import ConfigError

OWN, OTHER = 0, 1


@pytest.mark.parametrize('values, is_met, words', [
    ([(OTHER, 3.0), (OWN, 3.5), (OTHER, 4.0), (OWN, 3.5)], True, '2 of 2 values, a largest difference of 0.5'),
    ([(OTHER, 3.0), (OWN, 2.4)], False, '0 of 1 values, a largest difference of 0.6'),
    ([(OWN, 9.0), (OTHER, 3.0)], False, 'nothing'),  # nothing was compared
    ([(OTHER, math.nan), (OWN, 3.0)], False, 'nothing'),
    ([(OTHER, 3.0), (OWN, 'three'), (OWN, 3.0)], False, '1 of 2 values, a largest difference of inf')])
def test_each_value_is_compared_with_the_newest_of_the_other_field(values, is_met, words):
    condition = Agreement('student/level', 'rumba/level', 0.5)
    for value in values:
        condition.update(value)
    assert (condition.is_met, condition.measured()) == (is_met, words)


@pytest.mark.parametrize('count, is_met', [(19, False), (20, True), (30, True), (31, False)])
def test_a_rate_is_that_of_the_whole_run(count, is_met):
    rate = Rate('student/status', 2.0, 3.0)
    judge = Judge([rate], 10.0)
    for number in range(count):
        judge.update(rate, None, 0.1 * number)
        assert rate.is_met  # so far
    judge.check_time(10.0)
    [verdict] = judge.verdicts(lambda _: '')
    assert verdict.is_met is is_met
    assert f'measured {count / 10.0:.1f} Hz after 10.0 s' in verdict.words


def test_settings_become_such_conditions():
    conditions = Requirements(agree='a/b /c/d 0.5; e/f g/h 0', rates='a 9 11').conditions()
    assert [(condition.name, condition.paths) for condition in conditions] == [
        ('agree_a_b', ['a/b', '/c/d']), ('agree_e_f', ['e/f', 'g/h']), ('rate_a', ['a'])]
    assert conditions[0].required == 'a/b within 0.5 of /c/d' and conditions[2].required == 'a at 9 to 11 Hz'


@pytest.mark.parametrize('requirements, message', [
    (Requirements(agree='a/b 1'), r"^agree has 'a/b 1': must be TOPIC/FIELD TOPIC/FIELD TOLERANCE"),
    (Requirements(agree='a/b'), r"^agree has 'a/b': "),
    (Requirements(agree='a/b c/d -1'), r"^agree has 'a/b c/d -1': "),
    (Requirements(rates='a 0 1'), r"^rates has 'a 0 1': must be TOPIC LOW HIGH \[Hz\]"),
    (Requirements(rates='a 3'), r"^rates has 'a 3': ")])
def test_such_settings_that_cannot_be_understood_are_refused(requirements, message):
    with pytest.raises(ConfigError, match=message):
        requirements.conditions()


def test_what_comes_for_a_tick_counts_in_one_order_once_it_is_complete():
    readings = TickReadings(['place', 'dock'])
    readings.take('other', 0.0, 'anything')
    readings.take('another', 0.0, 'anything else')
    readings.take('dock', 0.2, 'docked')
    readings.expect({'place': 0.2, 'dock': 0.2, 'not yet subscribed': 0.2})
    assert readings.missing == ['place']
    readings.take('place', 0.1, 'before')
    assert readings.missing == ['place']
    readings.take('place', 0.2, 'here')
    assert readings.missing == []
    assert readings.release() == [('place', 'before'), ('place', 'here'), ('dock', 'docked'),
                                  ('another', 'anything else'),
                                  ('other', 'anything')]
    assert readings.release() == []


def test_a_node_that_does_not_publish_is_awaited_while_it_may_start_and_then_no_longer():
    awaited = Awaited(['status'])
    awaited.give_up(0.0, START - 0.1)
    assert awaited.silent == ['status']
    awaited.give_up(0.0, START + 0.1)
    awaited.begin()
    assert awaited.silent == []


def test_a_node_that_answers_is_awaited_in_each_tick_and_is_given_up_if_it_often_does_not():
    awaited = Awaited(['status'])
    awaited.publishes('status', 0.0)
    for number in range(TRIES):
        assert awaited.silent == ['status']
        awaited.hear('status')
        assert awaited.silent == []
        awaited.begin()
        awaited.give_up(10.0 * number, 10.0 * number + PATIENCE - 0.1)
        assert awaited.silent == ['status']
        awaited.give_up(10.0 * number, 10.0 * number + PATIENCE + 0.1)
        awaited.begin()
    assert awaited.silent == []


@pytest.mark.parametrize('between, is_given_up', [(STEADY, False), (STEADY - 1, True)])
def test_a_machine_that_stands_still_now_and_then_is_no_reason_to_give_a_node_up(between, is_given_up):
    awaited = Awaited(['status'])
    awaited.publishes('status', 0.0)
    for _ in range(2 * TRIES):
        awaited.give_up(0.0, PATIENCE + 0.1)
        awaited.begin()
        for _ in range(between):
            awaited.hear('status')
            awaited.hear('status')  # counts once in a tick
            awaited.begin()
    assert (awaited.silent == []) is is_given_up
