"""Points for conditions: all, none or a part of them, and one sentence that tells why they were lost."""

import json

import pytest

from rumba_evaluation.marks import github, gradescope
from rumba_evaluation.marks.scheme import Mark, Scheme, nothing
from rumba_evaluation.verdicts.conditions import Battery, Collisions, Coverage, Docked, Reach
from rumba_evaluation.verdicts.field_conditions import Field
from rumba_evaluation.verdicts.mission_verdict import Judge
from rumba_sim.model.common.errors import ConfigError
from rumba_sim.model.common.geometry import Pose

LIMIT = 100.0  # [s]


def marked(points, partial, *readings, void=''):
    """The marks of a run, by name, after pairs of a condition and its value."""
    conditions = list(dict.fromkeys(condition for condition, _ in readings))
    judge = Judge(conditions, LIMIT)
    for number, (condition, value) in enumerate(readings):
        judge.update(condition, value, float(number))
    judge.check_time(LIMIT)
    if void:
        judge.annul(void)
    marks = Scheme(conditions, points, partial).marks(judge.verdicts(lambda _: ''))
    return {mark.name: mark for mark in marks}


def test_without_partial_credit_a_condition_earns_all_or_nothing():
    marks = marked('coverage 8; docked 2', '', (Coverage(0.5), 0.49), (Docked(), False))
    assert [mark.score for mark in marks.values()] == [0.0, 0.0]
    assert marks['coverage'].reason.startswith('8 of 8 points lost: coverage: required at least 50.0 % of the floor '
                                               'swept; measured 49.0 % after ')


def test_without_points_each_condition_earns_one():
    marks = marked('', '', (Coverage(0.5), 0.6), (Collisions(0), False))
    assert {name: (mark.score, mark.max_score) for name, mark in marks.items()} == {
        'coverage': (1.0, 1.0), 'collisions': (1.0, 1.0)}
    assert 'lost' not in marks['coverage'].reason


@pytest.mark.parametrize('condition, value, worthless, share', [
    (Coverage(0.5), 0.3, '0.1', 0.5), (Coverage(0.5), 0.05, '0.1', 0.0), (Coverage(0.5), 0.3, '0.1 2', 0.25),
    (Reach('reach', Pose(3.0, 1.0, float('nan')), 0.2, 0.1), Pose(3.0, 1.6, 0.0), '1.0', 0.5),
    (Reach('reach', Pose(3.0, 1.0, 1.0), 0.2, 0.1), Pose(3.0, 1.0, 0.0), '1.0', 0.5),
    (Battery(20.0), 15.0, '10', 0.5)])
def test_partial_credit_grows_from_the_worthless_figure_to_the_required_one(condition, value, worthless, share):
    name = condition.name
    assert marked(f'{name} 10', f'{name} {worthless}', (condition, value))[name].score == pytest.approx(10.0 * share)


def test_fewer_collisions_earn_more():
    collisions = Collisions(1)
    presses = [(collisions, is_pressed) for is_pressed in (True, False, True, False, True, False)]
    assert marked('collisions 4', 'collisions 5', *presses)['collisions'].score == pytest.approx(2.0)


def test_a_field_earns_by_the_share_of_values_in_its_range():
    field = Field('a/b', 0.0, 1.0)
    assert marked('field_a_b 4', 'field_a_b 0', *((field, value) for value in (0.5, 2.0, 1.0, 0.0)))[
        'field_a_b'].score == pytest.approx(3.0)


def test_guards_earn_by_the_share_of_points_that_the_goals_earned_so_that_nothing_is_earned_by_standing_still():
    collisions = Collisions(0)
    marks = marked('coverage 8; collisions 2', 'coverage 0', (collisions, False), (Coverage(0.4), 0.1))
    assert marks['collisions'].score == pytest.approx(0.5)
    assert marks['collisions'].reason.endswith(
        '; the rule was kept, but rules count only as far as the task is done: 25 % of the points for coverage are '
        'earned, so this earns 25 % too')
    assert marked('', '', (collisions, False))['collisions'].score == 1.0  # without goals


def test_a_guard_that_is_kept_in_part_tells_both_parts():
    collisions = Collisions(1)
    presses = [(collisions, is_pressed) for is_pressed in (True, False, True, False, True, False)]
    marks = marked('coverage 8; docked 0; collisions 4', 'coverage 0; collisions 5', *presses, (Coverage(0.4), 0.2),
                   (Docked(), False))
    assert marks['collisions'].score == pytest.approx(1.0)
    assert marks['collisions'].reason.endswith(
        '; the rule was kept in part, which is worth 50 % of its points, but rules count only as far as the task is '
        'done: 50 % of the points for coverage are earned, so this earns 50 % of 50 %')


def test_a_guard_tells_that_nothing_of_the_task_is_done():
    marks = marked('', '', (Collisions(0), False), (Coverage(0.4), 0.0), (Docked(), False))
    assert marks['collisions'].reason.endswith(
        'done: no points for coverage and docked are earned, so this earns none')


def test_a_void_run_earns_nothing_and_no_part_of_it():
    marks = marked('', 'coverage 0', (Coverage(0.5), 0.4), void='forged')
    assert marks['coverage'].score == 0.0 and marks['coverage'].reason.endswith(': the time limit is reached; forged')


@pytest.mark.parametrize('points, partial, message', [
    ('coverage 8', '', '^points does not name docked: give its points'),
    ('coverage 8; docked 2; speed 1', '', "^points names 'speed': must be one of coverage, docked"),
    ('coverage 8; docked 2; docked 1', '', '^points names docked twice'),
    ('coverage 8; docked -1', '', "^points has docked '-1': must be one number"),
    ('coverage 8; docked', '', "^points has docked '': must be one number"),
    ('coverage nan; docked 1', '', "^points has coverage 'nan'"),
    ('coverage 0; docked 0', '', '^points are all 0'),
    ('', 'docked 0', '^partial names docked, which cannot be met in part'),
    ('', 'coverage', "^partial has coverage '': must be the figure"),
    ('', 'coverage 0.1 0', "^partial has coverage '0.1 0': must be the figure"),
    ('', 'coverage 0.6', '^partial has coverage 0.6: what is worth nothing must be below what is required, 0.5'),
    ('', 'coverage 0.5', '^partial has coverage 0.5: ')])
def test_schemes_that_cannot_be_understood_are_refused(points, partial, message):
    with pytest.raises(ConfigError, match=message):
        Scheme([Coverage(0.5), Docked()], points, partial)


MARKS = [Mark('coverage', 2.5, 4.0, '1.5 of 4 points lost: too little, 30 %'), Mark('docked', 1.0, 1.0, 'docked')]


def test_the_file_for_gradescope_has_what_its_specification_asks_for_and_can_be_read_again():
    text = gradescope.document(MARKS, 'after_due_date')
    content = json.loads(text)
    assert content['score'] == 3.5 and content['output'] == '3.5 of 5 points'
    assert content['tests'][0] == {
        'name': 'coverage', 'score': 2.5, 'max_score': 4.0, 'output': '1.5 of 4 points lost: too little, 30 %',
        'status': 'failed', 'visibility': 'after_due_date'}
    assert gradescope.marks_of(text) == MARKS


@pytest.mark.parametrize('text', ['', '{}', '[]', '{"tests": [{}]}', '{"tests": 3}'])
def test_another_file_is_not_read_as_marks(text):
    with pytest.raises(ValueError):
        gradescope.marks_of(text)


def test_github_gets_a_line_for_each_mark_and_classroom_its_sum():
    assert github.lines(MARKS) == [
        '::error title=coverage::2.5/4 points. 1.5 of 4 points lost: too little, 30 %25',
        '::notice title=docked::1/1 points. docked',
        '::notice title=Autograding complete::Points 3.5/5',
        '::notice title=Autograding report::{"totalPoints": 3.5, "maxPoints": 5.0}']


def test_nothing_is_earned_for_one_reason():
    assert nothing({'coverage': 3.0}, 'it cannot be built') == [
        Mark('coverage', 0.0, 3.0, '3 of 3 points lost: it cannot be built')]
