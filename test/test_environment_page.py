"""The page of the learning environment says what is true, and its examples run."""

import re
import subprocess
import sys

import pytest
from workspaces import ROOT

from rumba_evaluation.learning.coverage_task import CoverageTask
from rumba_evaluation.learning.rooms import rooms
from rumba_evaluation.learning.task_config import Reward, TaskConfig
from rumba_sim.model.common.config import describe, names

PAGE = (ROOT / 'docs' / 'environment.md').read_text()
EXAMPLES = re.findall(r'```python\n(.*?)```', PAGE, re.DOTALL)


@pytest.mark.parametrize('number, needed, printed', [
    (0, 'gymnasium', r'swept \d+% of a room in a minute; a picture of \(\d+, \d+, 3\)\n'),
    (1, 'gymnasium', r'mean coverage 0\.0\d+\n'), (2, 'stable_baselines3', '')])
def test_the_examples_run(number, needed, printed):
    pytest.importorskip(needed, reason=f'{needed} is optional: pip install {needed}')
    assert len(EXAMPLES) == 3
    done = subprocess.run([sys.executable, '-c', EXAMPLES[number]], stdout=subprocess.PIPE, universal_newlines=True,
                          check=True)
    assert re.fullmatch(printed, done.stdout)


def test_the_settings_are_those_that_there_are():
    assert f'```\n{describe(TaskConfig)}\n```' in PAGE


def test_the_parts_and_the_range_of_the_reward_are_true():
    assert re.findall(r'^\| `(\w+)` \| -?[\d.]+ \| ', PAGE, re.MULTILINE) == names(Reward)
    for name in names(Reward):
        value = getattr(Reward(), name)
        assert re.search(rf'^\| `{name}` \| -?{value:g} \| ', PAGE, re.MULTILINE), name
    low, high = map(float, re.search(r'lies between (-[\d.]+) and ([\d.]+)', PAGE).groups())
    task = CoverageTask(rooms(0, 1))
    assert low == pytest.approx(task.lowest_reward, abs=0.06) and high == pytest.approx(task.highest_reward, abs=0.06)
