"""The commands of keys, and how the input of a terminal is split into keys; without ROS."""

import pytest
from pytest import approx

from rumba_sim.ros.running.terminal import split_keys
from rumba_sim.ros.teleop_key.driver import MOVES, SPEEDS, ZEROS, Driver
from rumba_sim.ros.teleop_key.settings import Settings
from rumba_sim.ros.teleop_key.teleop_key import HELP

SETTINGS = Settings(linear=0.3, angular=0.7, hold=0.5)
SILENCE = None


def pressed(*keys):
    """A driver that got keys at time 100."""
    driver = Driver(SETTINGS)
    for key in keys:
        driver.press(key, 100.0)
    return driver


@pytest.mark.parametrize('key, linear, angular', [
    ('u', 0.3, 0.7), ('i', 0.3, 0.0), ('o', 0.3, -0.7),
    ('j', 0.0, 0.7), ('k', 0.0, 0.0), ('l', 0.0, -0.7),
    ('m', -0.3, -0.7), (',', -0.3, 0.0), ('.', -0.3, 0.7),
    ('up', 0.3, 0.0), ('down', -0.3, 0.0), ('left', 0.0, 0.7), ('right', 0.0, -0.7),
    (' ', 0.0, 0.0), ('I', 0.0, 0.0), ('\x1b[5~', 0.0, 0.0), ('\x1c', 0.0, 0.0),
])
def test_each_key_has_its_command_and_all_others_stop(key, linear, angular):
    assert pressed('up', key).command(100.0) == (linear, angular)


def test_a_key_counts_until_its_hold_is_over_then_a_few_zeros_then_silence():
    driver = pressed('up')
    assert driver.command(100.49) == (0.3, 0.0)
    assert driver.doing == 'forward'
    assert [driver.command(100.5 + i) for i in range(ZEROS)] == [(0.0, 0.0)] * ZEROS
    assert driver.command(200.0) is SILENCE
    assert driver.doing == 'stop'


def test_a_repeated_key_counts_from_its_last_press():
    driver = pressed('up')
    assert not driver.press('up', 100.4)
    assert driver.command(100.8) == (0.3, 0.0)
    assert driver.command(100.9) == (0.0, 0.0)


def test_another_move_and_every_stop_are_published_at_once():
    driver = Driver(SETTINGS)
    assert [driver.press(key, 0.0) for key in ('up', 'i', 'left', 'k', ' ', 'q')] == [
        True, False, True, True, True, False]


def test_nothing_is_published_before_the_first_key_and_after_forgetting():
    assert Driver(SETTINGS).command(0.0) is SILENCE
    driver = pressed('up')
    driver.forget()
    assert driver.command(100.0) is SILENCE


@pytest.mark.parametrize('key, linear, angular', [
    ('q', 0.33, 0.77), ('z', 0.27, 0.63), ('w', 0.33, 0.7), ('x', 0.27, 0.7), ('e', 0.3, 0.77), ('c', 0.3, 0.63)])
def test_speed_keys_change_speeds_by_a_tenth_and_neither_start_nor_stop_nor_prolong_a_move(key, linear, angular):
    assert pressed(key).command(100.0) is SILENCE
    driver = pressed('u')
    driver.press(key, 100.4)
    assert driver.command(100.4) == approx((linear, angular))
    assert driver.command(100.5) == (0.0, 0.0)


def test_speeds_stay_within_what_the_robot_can_do():
    for keys, speeds in (
            ('q' * 50, (0.5, 1.9)), ('z' * 50, (0.02, 0.1)), ('w' * 50, (0.5, 0.7)), ('c' * 50, (0.3, 0.1))):
        assert pressed(*keys, 'u').command(100.0) == speeds
    assert pressed(*'z' * 50, *'q' * 50, '.').command(100.0) == (-0.5, 1.9)


@pytest.mark.parametrize('text, keys, rest', [
    ('', [], ''),
    ('iq ', ['i', 'q', ' '], ''),
    ('\x1b[A\x1b[B\x1b[C\x1b[D', ['up', 'down', 'right', 'left'], ''),
    ('\x1bOA\x1bOB\x1bOC\x1bOD', ['up', 'down', 'right', 'left'], ''),
    ('i\x1b', ['i'], '\x1b'),
    ('i\x1b[', ['i'], '\x1b['),
    ('i\x1b[1;5', ['i'], '\x1b[1;5'),
    ('\x1bO', [], '\x1bO'),
    ('\x1b[1;5Au', ['\x1b[1;5A', 'u'], ''),
    ('\x1biu', ['\x1bi', 'u'], ''),
    ('\x1b\x1b[A', ['\x1b', 'up'], ''),
    ('\x1b\x1b', ['\x1b'], '\x1b'),
    ('\xc3\xa9\n', ['\xc3', '\xa9', '\n'], ''),
])
def test_input_is_split_into_keys_and_a_rest(text, keys, rest):
    assert split_keys(text) == (keys, rest)


def test_the_help_names_every_key_and_fits_a_small_terminal():
    lines = HELP.format(topic='/rumba/teleop/cmd_vel').splitlines()
    assert len(lines) < 24 and max(map(len, lines)) < 80
    words = HELP.replace(',  ', ' , ').split()
    for key in [*(key for key in MOVES if len(key) == 1), *SPEEDS, 'b', 'h', 'Esc', 'arrow', 'space']:
        assert key in words or f'{key},' in words, key
