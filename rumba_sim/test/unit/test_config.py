"""Settings are strict: the error for a wrong one says what would be right."""

import dataclasses
import functools
import math

import pytest

from rumba_sim.model.common import config
from rumba_sim.model.common.errors import LONGEST, ConfigError

BOMB = functools.reduce(lambda inner, _: [inner] * 9, range(40), ['ha'])  # 9 ** 40 elements


@dataclasses.dataclass(frozen=True)
class Example:
    """One setting of each type."""

    speed: float = config.setting(0.3, 'how fast', 'm/s', low=0.0, high=0.5)
    count: int = config.setting(3, 'how many', low=1, high=9)
    place: float = config.setting(0.0, 'where', 'm')
    quiet: bool = config.setting(False, 'whether')
    name: str = config.setting('rumba', 'who')


@dataclasses.dataclass(frozen=True)
class House:
    """Settings with sections, one of them in another."""

    @dataclasses.dataclass(frozen=True)
    class Room:
        """A section that holds a section."""

        example: Example = config.section(Example, 'an example')
        size: float = config.setting(4.0, 'how large', 'm', low=1.0, high=9.0)

    room: Room = config.section(Room, 'where')
    doors: int = config.setting(2, 'how many', low=0, high=5)


def test_a_setting_that_is_left_out_keeps_its_default():
    assert config.from_mapping(Example, {'count': 5}, 'x') == Example(count=5)


def test_both_ends_of_a_range_and_whole_numbers_for_floats_are_allowed():
    assert config.from_mapping(Example, {'speed': 0, 'count': 9}, 'x') == Example(speed=0.0, count=9)
    assert config.from_mapping(Example, {'speed': 0.5, 'place': -1e9}, 'x') == Example(speed=0.5, place=-1e9)


@pytest.mark.parametrize('mapping, message', [
    ({'speed': -0.1}, r'^here: speed is -0\.1: must be 0 to 0\.5 \[m/s\]$'),
    ({'speed': 0.51}, r'speed is 0\.51: must be 0 to 0\.5 \[m/s\]'),
    ({'speed': math.nan}, r'speed is nan: must be 0 to 0\.5'),
    ({'speed': True}, r'speed is True: must be 0 to 0\.5'),
    ({'speed': 'fast'}, r"speed is 'fast': must be 0 to 0\.5"),
    ({'place': 10 ** 400}, r'place is inf: must be a finite number'),
    ({'count': 10 ** 400}, r'count is a number of 400 digits: must be 1 to 9'),
    ({'place': math.inf}, r'place is inf: must be a finite number \[m\]'),
    ({'count': 2.0}, r'count is 2\.0: must be 1 to 9$'),
    ({'count': 0}, r'count is 0: must be 1 to 9'),
    ({'count': True}, r'count is True: must be 1 to 9'),
    ({'quiet': 1}, r'quiet is 1: must be true or false'),
    ({'name': 5}, r'name is 5: must be text'),
    ({'sped': 0.2}, r"here: sped is unknown: did you mean 'speed'\?"),
    ({'zzz': 1}, r'zzz is unknown: known are speed, count, place, quiet, name'),
    ({'Speed': 1}, r"here: Speed is unknown: did you mean 'speed'\?"),
    ({1 << 20_000: 1}, r'here: a number of 6021 digits is unknown: known are speed, count, place, quiet, name'),
    ({'count': 1 << 20_000}, r'count is a number of 6021 digits: must be 1 to 9'),
    ({'name': [BOMB]}, r'name is \[\[\[\.\.\.\], .*\]: must be text'),
    ({'count': BOMB}, r'count is \[.*: must be 1 to 9'),
    ({'count': 'x' * 3_000_000}, r"count is 'xxx.*xxx': must be 1 to 9"),
    ({'x' * 3_000_000: 1}, r'here: xxx.*xxx is unknown: known are speed, count, place, quiet, name'),
    ({'count': '\x1b[2J\n'}, r"count is '\\x1b\[2J\\n': must be 1 to 9"),
    ({'\x1b[2J': 1}, r'here: \\x1b\[2J is unknown: known are'),
    ('speed', r"^here: is 'speed': must be a mapping of speed, count, place, quiet, name$"),
    ([], r'^here: is \[\]: must be a mapping of'),
    (None, r'^here: is None: must be a mapping of'),
])
def test_a_wrong_setting_is_named_with_what_would_be_right(mapping, message):
    with pytest.raises(ConfigError, match=message) as caught:
        config.from_mapping(Example, mapping, 'here')
    assert len(str(caught.value)) <= LONGEST and str(caught.value).isprintable()


def test_a_description_has_a_line_for_each_setting_with_default_unit_meaning_and_range():
    lines = config.describe(Example).splitlines()
    assert [line.split()[0] for line in lines] == config.names(Example)
    assert lines[0].split() == 'speed 0.3 [m/s] how fast; 0 to 0.5'.split()
    assert lines[3].split() == 'quiet False whether; true or false'.split()


# --- sections -----------------------------------------------------------------------------------------------------

def test_a_section_is_filled_from_a_nested_mapping_and_keeps_what_is_left_out():
    house = config.from_mapping(House, {'room': {'example': {'count': 7}, 'size': 5}}, 'x')
    assert house == House(room=House.Room(example=Example(count=7), size=5.0))
    assert config.updated(house, {'room': {'example': {'speed': 0.1}}}, 'x') == House(
        room=House.Room(example=Example(count=7, speed=0.1), size=5.0))
    assert config.from_mapping(House, {'room': {}}, 'x') == House()


@pytest.mark.parametrize('mapping, message', [
    ({'room': {'example': {'speed': 2.0}}}, r'^here: room/example/speed is 2\.0: must be 0 to 0\.5 \[m/s\]$'),
    ({'room': {'example': {'sped': 2.0}}}, r"^here: room/example/sped is unknown: did you mean 'speed'\?$"),
    ({'room': {'siez': 2.0}}, r"^here: room/siez is unknown: did you mean 'size'\?$"),
    ({'rom': {}}, r"^here: rom is unknown: did you mean 'room'\?$"),
    ({'room': 4.0}, r'^here: room is 4\.0: must be a mapping of example, size$'),
    ({'room': {'example': []}}, r'^here: room/example is \[\]: must be a mapping of speed, count, place, quiet, name$'),
    ({'doors': {'size': 1}}, r"^here: doors is \{'size': 1\}: must be 0 to 5$"),
    ({5: 1}, r'^here: 5 is unknown: known are room, doors$'),
])
def test_a_wrong_setting_in_a_section_is_named_by_its_path(mapping, message):
    with pytest.raises(ConfigError, match=message):
        config.from_mapping(House, mapping, 'here')


def test_leaves_are_the_settings_by_their_paths_those_of_sections_last():
    assert [path for path, _ in config.leaves(House)] == [
        'doors', 'room/size', 'room/example/speed', 'room/example/count', 'room/example/place', 'room/example/quiet',
        'room/example/name']
    assert [line.split()[0] for line in config.describe(House).splitlines()] == [
        path for path, _ in config.leaves(House)]


def test_an_explanation_tells_meaning_range_and_unit():
    fields = dict(config.leaves(House))
    assert config.explain(fields['room/size']) == 'how large; 1 to 9 [m]'
    assert config.explain(fields['room/example/quiet']) == 'whether; true or false'
