"""An everyday run leaves out what is marked thorough, but for parameters that exist."""

import os
import shutil
import subprocess

import pytest
from workspaces import ROOT

SAMPLE = """import pytest
@pytest.mark.thorough(except_for=[{!r}])
@pytest.mark.parametrize('size', ['small', 'large'])
def test_size(size):
    pass
@pytest.mark.thorough
def test_long():
    pass
"""


@pytest.mark.parametrize('excepted, is_everyday, told', [
    ('small', True, '1 passed, 2 deselected'), ('small', False, '3 passed'), ('smal', False, '3 passed'),
    ('smal', True, "excepts parameters that it does not have: ['smal']")])
def test_of_a_thorough_test_an_everyday_run_takes_the_excepted_parameters_and_refuses_unknown_ones(
        tmp_path, excepted, is_everyday, told):
    shutil.copy(ROOT / 'conftest.py', tmp_path)
    (tmp_path / 'test_sample.py').write_text(SAMPLE.format(excepted))
    environment = {name: value for name, value in os.environ.items()
                   if name not in ('RUMBA_EVERYDAY', 'PYTEST_ADDOPTS')}
    if is_everyday:
        environment['RUMBA_EVERYDAY'] = '1'
    done = subprocess.run(['python3', '-m', 'pytest', '-q', '-p', 'no:cacheprovider', str(tmp_path)], env=environment,
                          stdout=subprocess.PIPE, universal_newlines=True)
    assert told in done.stdout
    assert done.returncode == ('passed' not in told)
