"""A page is played as its reader would, and what is not as it says is found."""

import os
import pathlib
import re
import time

import consoles
import pytest
from workspaces import Space, clean_environment

ECHO = 'python3 -c "print(input(chr(62) + chr(32)) * 2)"'  # it prompts as `> ` does
SLEEP = 'sh -c "echo on; exec sleep 100"'


def play(tmp_path, *fences):
    """Play a page of these fences in a shell without ROS."""
    page = tmp_path / 'README.md'
    page.write_text('\n'.join(f'Text.\n\n```console\n{fence}\n```\n' for fence in fences) + '\n```sh\nfalse\n```\n')
    consoles.play(page, Space([], clean_environment()))


@pytest.mark.parametrize('fence', [
    '$ true',
    '$ echo one; echo two\none\ntwo',
    '$ echo one; echo two\n...\ntwo',
    '$ echo one; echo two\none\n...',
    '$ printf "1\\n2\\n3\\n4\\n"\n1\n...\n3\n4',
    '$ echo "at 12:30 (now)"\nat ...:30 (now)',
    '$ printf "\\033[31mred\\033[0m\\n"\nred',
    '$ printf "no end"\nno end',
    '$ echo 1\n1\n$ echo 2\n2',
    f'$ {ECHO}\n> ab\nabab',
    f'$ {SLEEP}\non\n^C',
    f'$ {SLEEP}\non\n^C\n$ echo next\nnext',
    f'$ {SLEEP}\non\n...',
    '$ x=5\n$ echo $x\n5',
])
def test_what_is_shown_is_found(tmp_path, fence):
    begin = time.monotonic()
    play(tmp_path, fence)
    assert time.monotonic() - begin < 60.0  # none waited for a sleep


@pytest.mark.parametrize('fence, complaint', [
    ('$ echo one\ntwo', 'wanted: what the README shows, and no more\n$ echo one\ntwo\n--- the terminal shows:\none'),
    ('$ echo one; echo two\none', 'and no more'),
    ('$ echo one; echo two\ntwo', 'and no more'),
    ('$ echo 12x30\n12.30', 'and no more'),
    ('$ echo one\none\ntwo\n...', 'what the README shows'),
    ('$ false', 'exit code 0 instead of 1'),
    ('$ no_such_command\n...: command not found', 'exit code 0 instead of 127'),
    (f'$ {ECHO}\n> ab\nab', 'and no more'),
])
def test_what_is_not_shown_is_found(tmp_path, fence, complaint):
    with pytest.raises(AssertionError, match=re.escape(complaint)):
        play(tmp_path, fence)


def test_a_command_that_runs_on_without_saying_so_is_found(tmp_path, monkeypatch):
    monkeypatch.setattr(consoles, 'TIMEOUT', 1.0)
    with pytest.raises(AssertionError, match=re.escape('or `...` as its last line')):
        play(tmp_path, f'$ {SLEEP}\non')


def test_a_failure_that_comes_later_is_found(tmp_path):
    with pytest.raises(AssertionError, match='exit code 0 instead of 3'):
        play(tmp_path, f'$ {waiting(tmp_path, "exit 3")}\non\n...',
             f'$ echo go > {tmp_path}/pipe\n$ while [ -e /proc/$(cat {tmp_path}/pid) ]; do sleep 0.1; done; sleep 0.5')


def test_terminals_are_open_together_and_nothing_is_left(tmp_path):
    play(tmp_path, f'$ {waiting(tmp_path, "exec sleep 100")}\non\n...', f'$ echo go > {tmp_path}/pipe')
    assert not pathlib.Path('/proc', (tmp_path / 'pid').read_text().strip()).exists()


def waiting(tmp_path, then):
    """A command that says `on`, waits until somebody writes into a pipe, and goes on; its number is in the file pid."""
    os.mkfifo(tmp_path / 'pipe')
    return f"sh -c 'echo $$ > {tmp_path}/pid; echo on; cat {tmp_path}/pipe; {then}'"
