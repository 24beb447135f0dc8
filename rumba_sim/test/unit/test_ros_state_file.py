"""What a simulator says while its world cannot be saved, without a master."""

import pytest
from rooms import room

from rumba_sim.model.common.errors import WorldError
from rumba_sim.model.simulation import world_state
from rumba_sim.model.simulation.world import World
from rumba_sim.ros.simulator import state_file
from rumba_sim.ros.simulator.settings import Settings
from rumba_sim.ros.simulator.state_file import StateFile

FULL = '/x: cannot save the world: No space left on device'
GONE = '/x: cannot save the world: No such file or directory'


@pytest.fixture
def said(monkeypatch):
    """What is logged."""
    lines = []
    for name in ('logerr', 'loginfo'):
        monkeypatch.setattr(state_file.rospy, name, lambda line, name=name: lines.append((name, line)))
    return lines


def test_a_disk_that_stays_full_is_told_once_and_so_is_its_end(said, monkeypatch, tmp_path):
    trouble = iter([FULL, FULL, FULL, GONE, GONE, '', '', FULL])

    def write(*_):
        error = next(trouble)
        if error:
            raise WorldError(error)
    monkeypatch.setattr(world_state, 'write', write)
    file, world = StateFile(Settings(state=str(tmp_path / 'state'))), World(room(3.0, 2.0))
    for _ in range(8):
        file.save(world, 0)
    kept = '; what was saved before is still there'
    assert said == [('logerr', FULL + kept), ('logerr', GONE + kept),
                    ('loginfo', f'{tmp_path}/state: the world is saved again'), ('logerr', FULL + kept)]
