"""In an examination, parameters stay as they were launched."""

import pytest

from rumba_evaluation.verdicts.examination import Examination

LAUNCHED = {'simulator': {'seed': 1, 'battery': {'drain': 60.0}}, 'use_sim_time': True}
FLAT = {'/simulator/seed': 1, '/simulator/battery/drain': 60.0, '/use_sim_time': True}
OTHERS = {'student': {'speed': 0.3}, 'rosversion': '1.15.15'}


def changed(**values):
    """The parameters of the simulator with other values, among all that there are."""
    return {**LAUNCHED, **OTHERS, 'simulator': {**LAUNCHED['simulator'], **values}}


@pytest.mark.parametrize('launched', [LAUNCHED, FLAT])
@pytest.mark.parametrize('now, words', [
    (changed(), ''),
    ({**changed(), 'student': {'speed': 9.0, 'more': 1}}, ''),
    (changed(seed=2), 'the parameter /simulator/seed was changed'),
    (changed(battery={}), 'the parameter /simulator/battery/drain is gone'),
    (changed(wait_for=''), 'the parameter /simulator/wait_for is new'),
    ({**changed(seed=2), 'use_sim_time': False},
     'the parameter /simulator/seed was changed and the parameter /use_sim_time was changed')])
def test_each_change_is_told_also_the_first_look(launched, now, words):
    examination = Examination(launched, ['/simulator'])
    examination.look(now)
    assert examination.problem == (f'{words}: in an examination nobody may do that' if words else '')


def test_the_first_problem_stays():
    examination = Examination(LAUNCHED, ['/simulator'])
    for seed in (1, 2, 1):
        examination.look(changed(seed=seed))
    assert '/simulator/seed was changed' in examination.problem
