"""A world that was saved goes on bit for bit; a file that does not fit is refused, and never harmed."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rooms import crooked, quiet, room

from rumba_sim.model.common.config import updated
from rumba_sim.model.common.errors import RumbaError, WorldError
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation import world_state
from rumba_sim.model.simulation.world import World

PLAN = crooked(dock=Pose(3.8, 1.0, 0.0), cliff=(3.6, 2.6, 4.0, 3.0), carpet=(0.0, 0.0, 1.0, 1.0))
CONFIG = updated(RobotConfig(), {'battery': {'drain': 50}}, 'test')
ACTIONS = st.tuples(
    st.sampled_from(['drive', 'drive', 'drive', 'scan', 'spawn', 'kill', 'dock', 'move', 'brushes', 'reset', 'step']),
    st.integers(0, 3), st.floats(-0.5, 0.5), st.floats(-1.9, 1.9), st.integers(1, 700))


def do(world, action, number, v, w, ticks):
    """What happens to a world, and what it answers; the same for the same arguments."""
    names = list(world.robots)
    name = names[number % len(names)] if names else ''
    try:
        if action == 'drive':
            world.robots[name].command(v, w, world.tick)
        elif action == 'scan':
            return world.scan(name).tolist()
        elif action == 'spawn':
            world.spawn(f'new{number}', Pose(2.0 + v, 1.0 + w / 4.0, w), 0.5 + v, v > 0.0)
        elif action == 'kill':
            world.kill(name)
        elif action == 'dock':
            world.teleport(name, PLAN.dock)
        elif action == 'move':
            world.teleport(name, Pose(2.0 + 4.0 * v, 1.5 + 0.7 * w, w))
        elif action == 'brushes':
            world.robots[name].brushes_up = v > 0.0
        elif action == 'reset':
            world.reset()
    except (RumbaError, KeyError) as error:
        return str(error)
    world.step(ticks)
    return world.digest()


def saved_and_restored(world, folder, ticks=0):
    """The world that goes on from a file."""
    path = str(pathlib.Path(folder, 'state'))
    world_state.write(path, world.state(), ticks)
    state, found = world_state.read(path)
    assert found == ticks
    return World.restored(state, world.plan, world.config, world.step_rate, world.seed)


@settings(max_examples=60, deadline=None)
@given(st.lists(ACTIONS, max_size=12), st.lists(ACTIONS, min_size=1, max_size=12), st.integers(0, 5))
def test_whatever_happened_before_a_restored_world_goes_on_as_the_saved_one(before, after, seed):
    world = World(PLAN, CONFIG, seed=seed)
    for number in range(2):
        world.spawn(f'rumba{number}')
    for each in before:
        do(world, *each)
    with tempfile.TemporaryDirectory() as folder:
        again = saved_and_restored(world, folder, 7)
    assert again.digest() == world.digest()
    assert list(again.robots) == list(world.robots)
    for each in after:
        assert do(again, *each) == do(world, *each)
    assert again.floor.coverage == world.floor.coverage and again.floor.dirt_left == world.floor.dirt_left


def test_an_hour_that_is_saved_and_restored_each_minute_ends_as_an_uninterrupted_one(tmp_path):
    worlds = []
    for is_interrupted in (False, True):
        world = World(PLAN, CONFIG, seed=3)
        for name, x, y in (('a', 0.4, 1.4), ('b', 2.0, 2.5), ('c', 2.2, 0.6)):
            world.spawn(name, Pose(x, y, 0.0))
        rng = np.random.default_rng(4)
        for minute in range(60):
            if is_interrupted:
                world = saved_and_restored(world, tmp_path)
            for _ in range(30):
                for member in world.robots.values():
                    member.command(rng.uniform(-0.1, 0.5), rng.uniform(-1.9, 1.9), world.tick)
                world.step(100)
            if minute == 20:
                world.kill('b')
                world.teleport('a', PLAN.dock)
            if minute == 30:
                world.spawn('d')
        worlds.append(world)
    assert worlds[0].digest() == worlds[1].digest()
    assert worlds[0].state().members == worlds[1].state().members
    assert worlds[0].floor.coverage > 0.1


def test_when_a_configuration_is_set_once_more_does_not_matter():
    worlds = [World(PLAN, CONFIG, seed=3) for _ in range(2)]
    for world in worlds:
        world.spawn('a', Pose(0.4, 1.4, 0.0)).command(0.1, 0.0, 0)
        world.spawn('b', Pose(2.2, 0.6, 0.0))
        world.step(7)
    worlds[1].config = CONFIG
    for world in worlds:
        world.step(20)
    assert worlds[0].digest() == worlds[1].digest()


def test_a_state_is_a_copy():
    world = World(PLAN, CONFIG)
    world.spawn('rumba').command(0.3, 0.0, 0)
    state = world.state()
    digest = world.digest()
    world.step(100)
    assert world.digest() != digest
    assert World.restored(state, PLAN, CONFIG).digest() == digest


@pytest.mark.parametrize('plan, config, rate, seed, message', [
    (room(4.0, 3.0), CONFIG, 50, 0, r"^was saved on another map, 'room', or the map has changed since$"),
    (PLAN, quiet(), 50, 0, r'^was saved with odometry/scale_error 0.01, which is 0.0 now$'),
    (PLAN, RobotConfig(), 50, 0, r'^was saved with battery/drain 50.0, which is 1.0 now$'),
    (PLAN, CONFIG, 100, 0, r'^was saved with step_rate 50, which is 100 now$'),
    (PLAN, CONFIG, 50, 1, r'^was saved with seed 0, which is 1 now$')])
def test_a_state_of_another_world_is_refused(plan, config, rate, seed, message):
    world = World(PLAN, CONFIG)
    world.spawn('rumba')
    with pytest.raises(WorldError, match=message):
        World.restored(world.state(), plan, config, rate, seed)


def test_a_state_with_other_arrays_or_an_other_digest_is_refused():
    state = World(PLAN, CONFIG).state()
    for change, message in (({'arrays': {}}, 'another version'), ({'digest': 'x'}, 'is damaged'),
                            ({'origin': {**state.origin, 'new': 1}}, 'which has other settings')):
        with pytest.raises(WorldError, match=message):
            World.restored(state._replace(**change), PLAN, CONFIG)


@pytest.fixture()
def path(tmp_path):
    """A file with a saved world."""
    world = World(PLAN, CONFIG)
    world.spawn('rumba')
    world_state.write(str(tmp_path / 'state'), world.state(), 12)
    return tmp_path / 'state'


def test_a_file_that_is_cut_or_changed_anywhere_is_refused_in_one_line_or_holds_the_same(path):
    content, whole = path.read_bytes(), world_state.read(str(path))
    rng = np.random.default_rng(1)
    refused = 0
    for number in range(400):
        changed = bytearray(content)
        place = int(rng.integers(len(content)))
        if number % 2:
            changed[place] ^= 1 << int(rng.integers(8))
        else:
            del changed[place:]
        path.write_bytes(changed)
        try:
            state, ticks = world_state.read(str(path))
            World.restored(state, PLAN, CONFIG)
        except WorldError as error:
            assert '\n' not in str(error)
            refused += 1
        else:  # a byte that means nothing, such as the time of an entry
            assert (ticks, state.digest, state.members) == (whole[1], whole[0].digest, whole[0].members)
    assert refused > 300


@pytest.mark.parametrize('content', [b'', b'PK', b'no saved world\n', b'\x93NUMPY\x01\x00', b'\x80\x04N.'])
def test_something_else_is_refused(tmp_path, content):
    (tmp_path / 'state').write_bytes(content)
    with pytest.raises(WorldError, match='/state: is no saved world, or is damaged: '):
        world_state.read(str(tmp_path / 'state'))


def test_an_object_of_python_is_not_loaded(tmp_path):
    np.savez(tmp_path / 'state.npz', header=np.array([{}], object))
    with pytest.raises(WorldError, match='is no saved world'):
        world_state.read(str(tmp_path / 'state.npz'))


def test_what_is_no_file_is_refused(tmp_path):
    os.mkfifo(tmp_path / 'pipe')
    with pytest.raises(WorldError, match='is a named pipe: must be a regular file$'):
        world_state.read(str(tmp_path / 'pipe'))
    with pytest.raises(WorldError, match='No such file or directory$'):
        world_state.read(str(tmp_path / 'none'))


def test_a_file_of_another_version_is_refused(path):
    with np.load(path) as content:
        arrays = dict(content)
    header = json.loads(arrays['header'].tobytes())
    arrays['header'] = np.frombuffer(json.dumps({**header, 'version': 1}).encode(), np.uint8)
    with open(path, 'wb') as file:
        np.savez(file, **arrays)
    with pytest.raises(WorldError, match=r'/state: was saved by another version of rumba_sim: its format is 1, must be '
                                         '5$'):
        world_state.read(str(path))


def test_the_old_file_stays_if_the_new_one_cannot_be_written(path, monkeypatch):
    before, state = path.read_bytes(), World(PLAN, CONFIG).state()

    def fail(_):
        raise OSError(28, 'No space left on device')
    monkeypatch.setattr(world_state.os, 'fsync', fail)
    with pytest.raises(WorldError, match=r'/state: cannot save the world: No space left on device$'):
        world_state.write(str(path), state, 1)
    assert path.read_bytes() == before
    assert [each.name for each in path.parent.iterdir()] == ['state']


def test_a_folder_that_is_not_there_is_one_line(tmp_path):
    with pytest.raises(WorldError, match=r'none/state: cannot save the world: No such file or directory$'):
        world_state.write(str(tmp_path / 'none' / 'state'), World(PLAN, CONFIG).state(), 0)


def test_a_disk_that_is_full_in_the_middle_of_a_file_is_one_error_and_nothing_more(tmp_path):
    """A ZipFile whose end could not be written tries again when it is collected, and prints a traceback."""
    code = f'''
import gc, resource, signal, sys
sys.path.insert(0, {str(pathlib.Path(__file__).parent)!r})
from rooms import room
from rumba_sim.model.simulation import world_state
from rumba_sim.model.common.errors import WorldError
from rumba_sim.model.simulation.world import World
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (300, 300))
try:
    world_state.write("{tmp_path}/state", World(room(3.0, 2.0)).state(), 0)
except WorldError as error:
    print(error)
gc.collect()
'''
    done = subprocess.run([sys.executable, '-c', code], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          universal_newlines=True, check=True)
    assert done.stdout == f'{tmp_path}/state: cannot save the world: File too large\n'
    assert done.stderr == '' and not list(tmp_path.iterdir())
