"""Marking: what hidden tests ask, what becomes of submissions that break, and the sheet of a class."""

import json
import os
import textwrap

import pytest

from rumba_evaluation.marks import class_marks, hidden_tests, mark, submission
from rumba_evaluation.marks.class_marks import Row
from rumba_evaluation.marks.marking import Ros
from rumba_evaluation.marks.scheme import Mark
from rumba_evaluation.marks.submission import Launch, Outcome, Submission
from rumba_evaluation.submissions import supervised
from rumba_evaluation.submissions.diagnosis.mistakes import Wanted
from rumba_evaluation.submissions.sandbox import Plain
from rumba_evaluation.submissions.supervised import Run
from rumba_sim.model.common.errors import ConfigError
from rumba_sim.ros.running import launched

TEST = '''
    <launch>
      <arg name="student" default="sweeper" />
      <arg name="least" default="0.5" />
      <test test-name="{name}" pkg="rumba_evaluation" type="mission_test" time-limit="30">
        <param name="coverage" value="$(arg least)" />
        <param name="docked" value="true" />
        <param name="{setting}" value="{value}" />
        <param name="robot" value="rumba" />
      </test>
    </launch>
'''


@pytest.fixture
def tests(tmp_path):
    """A folder of hidden tests, and a function that writes a test into it."""
    folder = tmp_path / 'hidden'
    folder.mkdir()

    def write(name='sweeps', setting='points', value='coverage 8; docked 2', text=TEST):
        (folder / f'{name}.test').write_text(textwrap.dedent(text.format(name=name, setting=setting, value=value)))
        return str(folder)
    return write


def test_points_are_known_before_a_test_runs(tests):
    tests('b', value='coverage 1; docked 1')
    first, second = hidden_tests.load(tests('a'), {'least': '0.3'})
    assert first.name == 'a' and first.arguments == {'least': '0.3'}
    assert first.points == {'a': {'coverage': 8.0, 'docked': 2.0}}
    assert first.patience == hidden_tests.START + 30.0
    assert hidden_tests.all_points([first, second]) == {
        'a.coverage': 8.0, 'a.docked': 2.0, 'b.coverage': 1.0, 'b.docked': 1.0}


@pytest.mark.parametrize('setting, value, text, message', [
    ('points', 'coverage 8', TEST, r'sweeps\.test: sweeps: points does not name docked'),
    ('battery', 'full', TEST, r'sweeps\.test: sweeps: battery is '),
    ('points', '', '<launch></launch>', r'has no <test pkg="rumba_evaluation" type="mission_test">: nothing earns'),
    ('points', '', '<launch>', r'sweeps\.test: no element found')])
def test_a_hidden_test_that_cannot_be_understood_is_refused(tests, setting, value, text, message):
    with pytest.raises(ConfigError, match=message):
        hidden_tests.load(tests('sweeps', setting, value, text), {})


def test_an_argument_that_no_test_declares_is_refused(tests, tmp_path):
    with pytest.raises(ConfigError, match=r'^lest:= is no argument of any \.test file in '):
        hidden_tests.load(tests(), {'lest': '1'})
    with pytest.raises(ConfigError, match=r'has no \.test file: give the folder'):
        hidden_tests.load(str(tmp_path), {})


LAUNCH = Launch([Wanted('homework', 'sweeper')], ['/judge', '/simulator'], ['/judge'], {'/judge/coverage': 0.5})


class Runs:
    """What is run instead of rostest: keeps the commands, and answers the same to each."""

    def __init__(self, monkeypatch, output='', stopped=''):
        self.commands, self.environments = [], []
        self._answer = Run(1, output, stopped)
        monkeypatch.setattr(supervised, 'run', self._run)

    def _run(self, command, environment, *_):
        self.commands.append(command)
        self.environments.append(environment)
        return self._answer


@pytest.fixture
def own(tmp_path):
    """A submission with a script that nobody can run yet."""
    script = tmp_path / 'own' / 'homework' / 'scripts' / 'sweeper'
    script.parent.mkdir(parents=True)
    script.write_text('#!/bin/sh\n')
    script.parent.with_name('package.xml').write_text('<package><name>homework</name></package>')
    return tmp_path / 'own'


def submitted(own, tmp_path):
    """A submission that was taken."""
    (tmp_path / 'scratch').mkdir()
    return Submission(str(own), LAUNCH.nodes, tmp_path / 'scratch', Plain())


def test_a_submission_without_a_package_gets_nothing_and_the_reason(tests, tmp_path):
    (tmp_path / 'empty').mkdir()
    [test] = hidden_tests.load(tests(), {})
    outcome, _ = submitted(tmp_path / 'empty', tmp_path).run(test, LAUNCH, tests(), {})
    assert outcome.marks[0] == Mark('sweeps.coverage', 0.0, 8.0, '8 of 8 points lost: the submission has no '
                                                                 'package.xml: it must hold a catkin package')
    assert outcome.notes[0].startswith('sweeps: the submission has no package.xml')


def test_nodes_come_from_the_tests_and_only_then_from_the_submission_whose_programs_run_apart(
        tests, own, tmp_path, monkeypatch):
    runs = Runs(monkeypatch)
    [test] = hidden_tests.load(tests(), {})
    submitted(own, tmp_path).run(test, LAUNCH, tests(), {})
    environment, prefix = runs.environments[0], tmp_path / 'scratch' / 'ours' / 'sweeps' / 'prefix'
    assert environment['ROS_PACKAGE_PATH'].split(':')[:2] == [str(tmp_path / 'hidden'), str(prefix / 'share')]
    assert environment['CMAKE_PREFIX_PATH'].split(':')[0] == str(prefix)
    assert str(tmp_path / 'own') not in ' '.join(environment.values())
    program = prefix / 'lib' / 'homework' / 'sweeper'
    assert '/src/submission/homework/scripts/sweeper "$@"' in program.read_text() and os.access(program, os.X_OK)
    assert not os.access(own / 'homework' / 'scripts' / 'sweeper', os.X_OK)


def test_a_test_without_a_verdict_earns_nothing_and_tells_what_the_nodes_printed(tests, own, tmp_path, monkeypatch):
    printed = ('Traceback (most recent call last):\n'
               '  File "/x/src/submission/homework/scripts/sweeper", line 1\n    x\n'
               'ZeroDivisionError: division by zero\n')
    Runs(monkeypatch, printed, 'it took longer than 120 s')
    [test] = hidden_tests.load(tests(), {})
    outcome, log = submitted(own, tmp_path).run(test, LAUNCH, tests(), {})
    assert [mark.score for mark in outcome.marks] == [0.0, 0.0] and log == printed
    assert outcome.marks[1].reason == '2 of 2 points lost: the test gave no verdict: it took longer than 120 s'
    assert [note for note in outcome.notes if 'homework/scripts/sweeper, line 1: ZeroDivisionError' in note]


def test_the_launch_file_of_a_run_passes_arguments_on_and_quotes_them(tests, own, tmp_path, monkeypatch):
    Runs(monkeypatch)
    [test] = hidden_tests.load(tests(), {'student': 'a "b" & c'})
    submitted(own, tmp_path).run(test, LAUNCH, tests(), {'recording': '/a.bag'})
    folder = tmp_path / 'scratch' / 'ours' / 'sweeps'
    assert (folder / 'sweeps.test').read_text() == (
        '<launch>\n  <param name="/judge/recording" value="/a.bag" />\n'
        f'  <include file="{tmp_path}/hidden/sweeps.test">\n'
        "    <arg name=\"student\" value='a \"b\" &amp; c' />\n  </include>\n</launch>\n")
    assert submission.LAUNCHED == launched.VARIABLE  # the nodes look there
    assert json.loads((folder / 'launched.json').read_text()) == {
        'nodes': ['/judge', '/simulator'], 'parameters': {'/judge/coverage': 0.5, '/judge/recording': '/a.bag'}}


ROWS = [Row('anna', Outcome([Mark('a.coverage', 2.5, 8.0, 'too little')], [])),
        Row('=berta', Outcome([Mark('a.coverage', 8.0, 8.0, 'well')], ['a: a node, which "failed"']))]


def test_the_sheet_of_a_class_has_a_row_for_each_and_no_formulas():
    assert class_marks.sheet(ROWS, {'a.coverage': 8.0}) == (
        'submission,points,of,a.coverage,notes\nanna,2.5,8,2.5,too little\n'
        '\'=berta,8,8,8,"a: a node, which ""failed"""\n')


def test_the_table_of_a_submission_tells_why_points_were_lost():
    assert class_marks.table(ROWS[0].outcome.marks) == 'a.coverage  2.5 of 8  too little\ntotal       2.5 of 8'


def test_submissions_of_one_name_keep_their_endings():
    assert class_marks.names(['/a/zoe', '/a/zoe.zip', '/a/max.py']) == {
        '/a/zoe': 'zoe', '/a/zoe.zip': 'zoe.zip', '/a/max.py': 'max'}


ROS = Ros(lambda *_: [], lambda *_: LAUNCH, list)


def test_a_class_is_marked_again_only_where_something_has_changed(tests, tmp_path, monkeypatch, capsys):
    for name in ('anna', 'berta'):
        (tmp_path / 'class' / name).mkdir(parents=True)
        (tmp_path / 'class' / name / 'package.xml').write_text('<package/>')
    marked = []

    def run(taken, *_):
        marked.append((taken.workspace.source / 'package.xml').read_text())
        return Outcome([Mark('sweeps.coverage', 8.0, 8.0, ''), Mark('sweeps.docked', 0.0, 2.0, 'away')], ['note']), ''
    monkeypatch.setattr(Submission, 'run', run)
    arguments = ['--all', str(tmp_path / 'class'), '--tests', tests(), '--output', str(tmp_path / 'out'), '--jobs', '2']

    def sheet():
        assert mark.main(arguments, ROS) == 0
        return (tmp_path / 'out' / 'marks.csv').read_text()
    first = sheet()
    assert len(marked) == 2 and first.splitlines()[1] == 'anna,8,10,8,0,note'
    assert sheet() == first and len(marked) == 2
    (tmp_path / 'class' / 'anna' / 'package.xml').write_text('<package></package>')
    assert sheet() == first and marked[2:] == ['<package></package>']
    tests(value='coverage 8; docked 3')
    sheet()
    assert len(marked) == 5
    assert json.loads((tmp_path / 'out' / 'anna' / 'results.json').read_text())['output'] == '8 of 10 points\nnote'
    assert 'anna: 8 of 10 points; note' in capsys.readouterr().out


def test_a_class_goes_on_whatever_is_wrong_with_one_of_it(tests, tmp_path, monkeypatch):
    for name in ('anna', 'berta'):
        (tmp_path / 'class' / name).mkdir(parents=True)

    def run(taken, *_):
        if not (taken.workspace.source / 'well.txt').exists():
            raise RecursionError('too \x1b deep')
        return Outcome([Mark('sweeps.coverage', 8.0, 8.0, '')], []), ''
    (tmp_path / 'class' / 'berta' / 'well.txt').write_text('')
    monkeypatch.setattr(Submission, 'run', run)
    arguments = ['--all', str(tmp_path / 'class'), '--tests', tests(), '--output', str(tmp_path / 'out')]
    assert mark.main(arguments, ROS) == 0
    rows = (tmp_path / 'out' / 'marks.csv').read_text().splitlines()
    assert rows[1:] == [r'anna,0,10,0,0,it cannot be marked: RecursionError: too \x1b deep', 'berta,8,10,8,0,']


@pytest.mark.parametrize('arguments, message', [
    (['--tests', '.'], 'mark: give one submission, or --all FOLDER; see --help\n'),
    (['a', '--all', 'b', '--tests', '.'], 'mark: give one submission, or '),
    (['.', '--tests', '/nowhere'], 'mark: /nowhere: is no folder\n'),
    (['.', '--tests', '.', '--jobs', '0'], 'mark: --jobs is 0: must be at least 1')])
def test_a_command_line_that_cannot_be_understood_is_refused_in_one_line(arguments, message, capsys):
    try:
        code = mark.main(arguments, ROS)
    except SystemExit as exit_:
        code = exit_.code
    error = capsys.readouterr().err
    assert code == 2 and error.startswith(message) and error.count('\n') == 1
