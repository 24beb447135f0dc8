"""/use_sim_time is after a simulator as it was before, whatever became of that simulator."""

import pytest

from rumba_sim.ros.simulator import simulated_time
from rumba_sim.ros.simulator.simulated_time import FOUND, USE_SIM_TIME, SimulatedTime


@pytest.fixture()
def parameters(monkeypatch):
    """The parameters of a master."""
    values = {}

    class Master:
        def __init__(self, _):
            self.getParam, self.hasParam = values.__getitem__, values.__contains__  # noqa: N815
            self.setParam, self.deleteParam = values.__setitem__, values.__delitem__  # noqa: N815
    monkeypatch.setattr(simulated_time.rosgraph, 'Master', Master)
    return values


@pytest.mark.parametrize('before, after', [({}, {}), ({USE_SIM_TIME: False}, {}),
                                           ({USE_SIM_TIME: True}, {USE_SIM_TIME: True})])
def test_it_is_restored(parameters, before, after):
    parameters.update(before)
    time = SimulatedTime('/simulator')
    assert time.claim() == before.get(USE_SIM_TIME, False)
    assert parameters == {USE_SIM_TIME: True, FOUND: before.get(USE_SIM_TIME, False)}
    time.restore()
    assert parameters == after


@pytest.mark.parametrize('found', [False, True])
def test_a_launch_file_hands_on_what_it_found(parameters, found, capsys):
    if found:
        parameters[USE_SIM_TIME] = True
    simulated_time.main()
    assert capsys.readouterr().out == f'{str(found).lower()}\n'
    parameters.update({USE_SIM_TIME: True, FOUND: found})
    time = SimulatedTime('/simulator')
    time.claim()
    time.restore()
    assert parameters == ({USE_SIM_TIME: True} if found else {})


@pytest.mark.parametrize('found', [False, True])
def test_after_a_simulator_was_killed_the_next_knows_what_that_one_found(parameters, found, capsys):
    parameters.update({USE_SIM_TIME: True, FOUND: found})
    simulated_time.main()
    assert capsys.readouterr().out == f'{str(found).lower()}\n'
    time = SimulatedTime('/simulator')
    assert time.claim()
    assert parameters[FOUND] == found
    line = time.mend()
    assert parameters == ({USE_SIM_TIME: True} if found else {})
    assert line == ('an earlier simulator was killed and left /use_sim_time set: it is '
                    f'{str(found).lower()} again, as before')
    assert time.mend() == ''


def test_without_a_master_nothing_was_found(monkeypatch, capsys):
    class Master:
        def __init__(self, _):
            pass

        def hasParam(self, _):  # noqa: N802
            raise ConnectionRefusedError
    monkeypatch.setattr(simulated_time.rosgraph, 'Master', Master)
    simulated_time.main()
    assert capsys.readouterr().out == 'false\n'
