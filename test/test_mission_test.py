"""A teacher's .test file marks good and bad homework, as docs/mission_test.md shows."""

import re

import pytest
from workspaces import ROOT

PAGE = (ROOT / 'docs' / 'mission_test.md').read_text()
HOMEWORK = ROOT / 'test' / 'packages' / 'homework'


@pytest.fixture()
def mark(overlay, tmp_path):
    """A function that marks the node of a student, and returns the exit code and the output of rostest."""
    def mark(student):
        process = overlay.space('devel').start(
            f'rostest --results-base-dir {tmp_path} homework homework.test student:={student}')
        output, _ = process.communicate(timeout=180.0)
        return process.returncode, output
    return mark


def test_the_page_shows_the_file():
    shown = re.search(r'```xml\n(.*?)```', PAGE, re.DOTALL).group(1)
    assert shown == (HOMEWORK / 'test' / 'homework.test').read_text()


@pytest.mark.thorough
def test_good_homework_meets_every_condition(mark):
    code, output = mark('sweeper')
    assert code == 0, output
    assert re.findall(r'/(test_\w+)\]\[(\w+)\]', output) == [
        (f'test_{name}', 'passed')
        for name in ('battery', 'collisions', 'coverage', 'field_rumba_odom_twist_twist_linear_x')]


@pytest.mark.thorough
def test_bad_homework_fails_only_in_the_condition_that_it_does_not_meet(mark):
    code, output = mark('sleeper')
    assert code != 0, output
    assert [name for name, word in re.findall(r'/test_(\w+)\]\[(\w+)\]', output) if word == 'FAILURE'] == ['coverage']
    assert re.search(r'```\n(coverage: .*)\n```', PAGE).group(1) in output


@pytest.mark.thorough
def test_homework_that_publishes_what_it_is_marked_by_fails_in_every_condition(mark):
    code, output = mark('forger')
    assert code != 0, output
    names = [name for name, word in re.findall(r'/test_(\w+)\]\[(\w+)\]', output) if word == 'FAILURE']
    assert names == ['battery', 'collisions', 'coverage', 'field_rumba_odom_twist_twist_linear_x']
    assert re.search(r'```\n(/rumba/cleaning_status is .*)\n```', PAGE).group(1) in output
