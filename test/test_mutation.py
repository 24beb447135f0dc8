"""The mutation tester names modules and tests that exist, and counts what cosmic-ray says of its faults."""

import json
import sys

import pytest
from workspaces import ROOT

sys.path.insert(0, str(ROOT))

from mutation import session  # noqa: E402
from mutation.judges import JUDGED  # noqa: E402


def planted(line, operator, result):
    """A line of `cosmic-ray dump`."""
    mutation = {'module_path': 'guard.py', 'operator_name': f'core/{operator}', 'start_pos': [line, 8]}
    return json.dumps([{'job_id': 'any', 'mutations': [mutation]}, result])


@pytest.mark.parametrize('judged', JUDGED.values(), ids=list(JUDGED))
def test_a_judged_module_and_its_tests_exist(judged):
    assert all((ROOT / path).is_file() for path in (judged.path, *judged.test_paths))


def test_a_fault_is_found_if_a_test_failed_or_did_not_end_and_skipped_ones_do_not_count():
    lines = [planted(1, 'AddNot', {'worker_outcome': 'normal', 'test_outcome': 'killed', 'diff': '-a\n+not a'}),
             planted(2, 'AddNot', {'worker_outcome': 'normal', 'test_outcome': 'survived', 'diff': ''}),
             planted(3, 'AddNot', {'worker_outcome': 'normal', 'test_outcome': 'incompetent', 'diff': ''}),
             planted(4, 'AddNot', {'worker_outcome': 'skipped', 'test_outcome': None, 'diff': None}),
             planted(5, 'AddNot', None)]
    found = list(session.faults_of(lines))
    assert [(fault.line, fault.is_found) for fault in found] == [(1, True), (2, False), (3, True), (5, None)]
    assert found[0].operator == 'AddNot' and found[0].change == '-a\n+not a'


def test_tests_judge_the_sources_of_the_copy_before_those_of_the_workspace(tmp_path, monkeypatch):
    monkeypatch.setenv('PYTHONPATH', '/workspace')
    for package in ('rumba_sim', 'rumba_cleaning'):
        (tmp_path / package / 'src').mkdir(parents=True)
    path = next(word for word in session.tests(JUDGED['guard'], tmp_path) if word.startswith('PYTHONPATH='))
    assert path == f'PYTHONPATH={tmp_path}/rumba_cleaning/src:{tmp_path}/rumba_sim/src:/workspace'
