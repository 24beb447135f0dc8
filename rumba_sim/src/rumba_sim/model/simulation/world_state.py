"""The whole state of a world as plain values and arrays, and the file in which it is kept.

The file is an .npz of NumPy without pickled objects: the arrays, and a header in JSON.
"""

import contextlib
import hashlib
import io
import json
import os
import zipfile
from typing import Any, Dict, List, Mapping, NamedTuple, Sequence, Tuple

import numpy as np

from rumba_sim.model.common.errors import WorldError, quoted
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.common.regular_file import opened
from rumba_sim.model.kernel import Array
from rumba_sim.model.maps.floor_plan import FloorPlan
from rumba_sim.model.simulation.obstacle import Obstacle, Stop
from rumba_sim.model.simulation.robot import Start

FORMAT, VERSION = 'world of rumba_sim', 5
HEADER = 'header'


class Member(NamedTuple):
    """A robot, apart from what is in arrays."""

    name: str
    start: Start
    wheels: Mapping[str, Any]  # state of the bit generator of its wheels
    laser: Mapping[str, Any]  # and of that of its laser
    bias: float  # systematic error of its laser, in its standard deviations


class WorldState(NamedTuple):
    """Everything that makes a world go on as it would have."""

    origin: Dict[str, Any]  # what a world must have in common with it, by `origin`
    tick: int
    spawned: int  # how many robots there were so far
    members: List[Member]  # in the order of the arrays
    obstacles: List[Obstacle]  # in the order of the arrays
    arrays: Dict[str, Array]
    digest: str  # of the world


def origin(plan: FloorPlan, settings: Mapping[str, Any], step_rate: float, seed: int,
           obstacles: Sequence[Obstacle]) -> Dict[str, Any]:
    """What the state of a world fits to, by names for people.

    Args:
        plan: the floor plan.
        settings: of the robots, as nested mappings.
        step_rate: ticks per second [Hz].
        seed: of the world.
        obstacles: that were there from the start.
    """
    floor = hashlib.sha256(repr((plan.resolution, plan.origin, plan.dock, plan.start, *plan.further_docks)).encode())
    for layer in (plan.occupancy, plan.cliff, plan.carpet):
        floor.update(b'none' if layer is None else repr(layer.shape).encode() + np.ascontiguousarray(layer).tobytes())
    return {'map': plan.name, 'floor': floor.hexdigest(), 'seed': seed, 'step_rate': step_rate,
            'obstacles': hashlib.sha256(repr(obstacles).encode()).hexdigest(), **_flat(settings)}


def _flat(settings: Mapping[str, Any], path: str = '') -> Dict[str, Any]:
    flat: Dict[str, Any] = {}
    for name, value in settings.items():
        flat.update(_flat(value, f'{path}{name}/') if isinstance(value, Mapping) else {path + name: value})
    return flat


def check_origin(saved: Mapping[str, Any], here: Mapping[str, Any]) -> None:
    """Check that a state fits.

    Args:
        saved: origin of the state.
        here: origin of the world that shall go on from it.

    Raises:
        WorldError: the map, the seed, the step rate or a setting is another one.
    """
    if saved.get('floor') != here['floor']:
        raise WorldError(f'was saved on another map, {quoted(saved.get("map"))}, or the map has changed since')
    if saved.get('obstacles') != here['obstacles']:
        raise WorldError('was saved with other obstacles at the start')
    if saved.keys() != here.keys():
        raise WorldError('was saved by another version of rumba_sim, which has other settings')
    for name, value in here.items():
        if name != 'map' and saved[name] != value:
            raise WorldError(f'was saved with {name} {quoted(saved[name])}, which is {quoted(value)} now')


def fill(arrays: Dict[str, Array], saved: Mapping[str, Array]) -> None:
    """Copy saved arrays into those of a world.

    Raises:
        WorldError: they have other names, shapes or types.
    """
    for name, array in arrays.items():
        if name not in saved or (saved[name].shape, saved[name].dtype) != (array.shape, array.dtype):
            raise WorldError('was saved by another version of rumba_sim, or is damaged')
        np.copyto(array, saved[name])


def generator(state: Mapping[str, Any]) -> np.random.Generator:
    """A random generator in a state.

    Raises:
        WorldError: this is no state of one.
    """
    found = np.random.default_rng()
    try:
        found.bit_generator.state = state
    except (ValueError, TypeError, KeyError, OverflowError) as error:
        raise WorldError(f'is damaged: {error}') from error
    return found


# --- the file -----------------------------------------------------------------------------------------------------

def write(path: str, state: WorldState, ticks: int) -> None:
    """Write a file: either the whole new one is there afterwards, or the old one.

    Args:
        path: path of the file.
        state: of the world.
        ticks: number of ticks of the simulation, which resets of the world do not change.

    Raises:
        WorldError: the file cannot be written.
    """
    members = [{**member._asdict(), 'start': [list(member.start.pose), *member.start[1:]]} for member in state.members]
    header = {'format': FORMAT, 'version': VERSION, 'ticks': ticks, **state._asdict(), 'members': members}
    del header['arrays']
    beside = f'{path}.new'
    # In memory first: a ZipFile that could not write to the disk would try again when it is collected.
    content = io.BytesIO()
    np.savez(content, **{HEADER: np.frombuffer(json.dumps(header).encode(), np.uint8)}, **state.arrays)
    try:
        with open(beside, 'wb') as file:
            file.write(content.getbuffer())
            file.flush()
            os.fsync(file.fileno())
        os.replace(beside, path)
        _sync_folder(path)
    except OSError as error:
        with contextlib.suppress(OSError):
            os.remove(beside)
        raise WorldError(f'{path}: cannot save the world: {error.strerror}') from error


def _sync_folder(path: str) -> None:
    folder = os.open(os.path.dirname(path) or '.', os.O_RDONLY)
    try:
        os.fsync(folder)
    finally:
        os.close(folder)


def read(path: str) -> Tuple[WorldState, int]:
    """Read a file: the state, and the number of ticks of the simulation.

    Raises:
        WorldError: it cannot be read, is damaged, or was written by another version.
    """
    with opened(path, WorldError) as file:
        try:
            with zipfile.ZipFile(file):  # older NumPy would print a line of its own if it is none
                file.seek(0)
            with np.load(file, allow_pickle=False) as content:
                header = json.loads(bytes(content[HEADER]).decode())
                if header['format'] != FORMAT:
                    raise ValueError('its format is another one')
                if header['version'] == VERSION:
                    arrays = {name: content[name] for name in content.files if name != HEADER}
                    return _state(header, arrays), _count(header['ticks'])
        except Exception as error:  # NumPy, zipfile and tokenize raise almost anything if bytes have changed
            raise WorldError(f'{path}: is no saved world, or is damaged: {error}') from error
    raise WorldError(f'{path}: was saved by another version of rumba_sim: its format is '
                     f'{quoted(header["version"])}, must be {VERSION}')


def _state(header: Mapping[str, Any], arrays: Dict[str, Array]) -> WorldState:
    members = []
    for each in header['members']:
        pose, charge, brushes_up = each['start']
        start = Start(_pose(*pose), float(charge), bool(brushes_up))
        members.append(Member(str(each['name']), start, dict(each['wheels']), dict(each['laser']),
                              float(each['bias'])))
    obstacles = [_obstacle(*each) for each in header['obstacles']]
    return WorldState(dict(header['origin']), _count(header['tick']), _count(header['spawned']), members, obstacles,
                      arrays, str(header['digest']))


def _obstacle(name: Any, pose: Any, height: Any, radius: Any, length: Any, width: Any, stops: Any) -> Obstacle:
    return Obstacle(str(name), _pose(*pose), float(height), float(radius), float(length), float(width), tuple(
        Stop(_pose(*where), float(travel), float(least), float(most)) for where, travel, least, most in stops))


def _pose(x: Any, y: Any, theta: Any) -> Pose:
    return Pose(float(x), float(y), float(theta))


def _count(value: Any) -> int:
    if type(value) is not int or not 0 <= value < 2 ** 62:
        raise ValueError(f'{quoted(value)} is not a number of ticks')
    return value
