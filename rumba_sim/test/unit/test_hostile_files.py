"""Files of any content end in a map, in settings, or in one short line, soon and in little memory."""

import dataclasses
import os
import random
import resource
import time

import mutations
import pytest
from sheets import write

from rumba_sim.model.common import config, yaml_file
from rumba_sim.model.common.errors import LONGEST, ConfigError, MapError
from rumba_sim.model.maps import map_file
from rumba_sim.model.settings.robot_config import RobotConfig

SEEDS = range(150)
LONGEST_CASE = 3.0  # [s] of CPU time
MOST_MEMORY = 300_000  # [kB]


def loads(load, error):
    """Whether a file loads; fails if it ends in anything but a short line, or takes long or much memory."""
    memory, start = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, time.process_time()
    try:
        load()
        message = ''
    except error as exc:
        message = str(exc)
        assert message.isprintable() and 0 < len(message) <= LONGEST
    assert time.process_time() - start < LONGEST_CASE
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - memory < MOST_MEMORY
    return not message


def hostile_map(folder, seed):
    """Whether a map loads whose YAML file and images are hostile, or some of them."""
    dice = random.Random(seed)
    path = write(folder)
    for name, kind in (('flat.png', mutations.png), ('flat.pgm', mutations.pgm), ('flat.yaml', mutations.map_file)):
        if name == 'flat.pgm' or dice.random() < 0.6:
            (folder / name).write_bytes(kind(dice))
    return loads(lambda: map_file.load(path), MapError)


def hostile_settings(folder, seed):
    """Whether a file with hostile settings of a robot loads."""
    dice = random.Random(seed)
    section = dice.choice(dataclasses.fields(RobotConfig))
    good = {f'  {field.name}': field.default for field in dataclasses.fields(section.metadata['section'])}
    (folder / 'a.yaml').write_bytes(mutations.settings(dice, [section.name, *good], {section.name: '', **good}))
    return loads(lambda: config.from_mapping(RobotConfig, yaml_file.read_mapping(
        str(folder / 'a.yaml'), ConfigError), 'here'), ConfigError)


@pytest.mark.parametrize('kind', [hostile_map, hostile_settings])
def test_a_hostile_file_loads_or_is_one_short_line(tmp_path, kind, recwarn):
    os.mkfifo(str(tmp_path / 'pipe'))
    outcomes = set()
    for seed in SEEDS:
        try:
            outcomes.add(kind(tmp_path, seed))
        except Exception as exc:
            raise AssertionError(f'{kind.__name__} with seed {seed}') from exc
    assert outcomes == {True, False}
    assert [str(warning) for warning in recwarn] == []
