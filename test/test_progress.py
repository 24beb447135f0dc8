"""Long commands of ./rumba say how far they are: no terminal stays silent for ten seconds."""

import os
import re
import subprocess
import sys
import time

import pytest
from checkouts import commands, make_checkout, on_system, surroundings
from workspaces import ROOT

sys.path.insert(0, str(ROOT / 'packaging'))
import silence  # noqa: E402

SILENCE = 10.0  # [s] in which newcomers begin to think of Ctrl-C
APT = '''#!/bin/sh
case "$*" in
    update) exit 0 ;;
    *print-uris*) echo "'http://x' a_1.deb 3000000 M"; echo "'http://y' b_1.deb 4000000 M"; exit 0 ;;
esac
sleep 18
echo 'E: broken'
exit 100
'''
SETUP = f'say() {{ echo "rumba: $*"; }}; . {ROOT}/packaging/progress.sh; log=/dev/null; beat=2; '


def recorded(command, environment, is_terminal=False):
    """What a command prints, its exit code, and the longest silence [s]."""
    done = silence.record(command, environment, is_terminal)
    return done.text, done.code, done.silences()[0].time


@pytest.mark.parametrize('is_terminal', [False, True], ids=['piped', 'terminal'])
def test_apt_that_says_nothing_leaves_no_silence(tmp_path, is_terminal):
    path = commands(tmp_path / 'bin', **{
        'apt-get': APT,
        'apt-cache': '#!/bin/sh\n', 'id': '#!/bin/sh\necho 0\n', 'dpkg-query': '#!/bin/sh\nexit 1\n'})
    environment = surroundings(PATH=f'{path}:{os.environ["PATH"]}', **on_system(tmp_path))
    said, code, longest = recorded([str(make_checkout(tmp_path / 'checkout') / 'rumba'), 'build'], environment,
                                   is_terminal)
    assert code == 1 and 'cannot install packages: broken' in said
    assert 'rumba: installing 2 packages, 7 MB' in said
    assert '7 MB, 0:08 (usually 1 to 8 min)' in said and longest < SILENCE


def test_a_build_whose_targets_are_made_but_for_the_last_says_what_it_does_and_for_how_long():
    work = 'work() { echo "[100%] Compiling the functions"; sleep 5; return 3; }; '
    said, code, longest = recorded(['sh', '-c', f"{SETUP}{work}with_progress building '2 min' work"], surroundings())
    assert code == 3 and longest < 4.0
    assert said.startswith('rumba: building\nrumba: building 60 %, 0:0')
    assert said.splitlines()[-1].endswith(' (usually 2 min): Compiling the functions')


def test_a_line_of_progress_fits_a_terminal_of_80_columns():
    work = f'work() {{ echo "[ 45%] {"long " * 40}"; }}; '
    said, _, _ = recorded(['sh', '-c', f"{SETUP}{work}with_progress building '2 min' work"], surroundings(), True)
    lines = [line for line in said.replace('\x1b[K', '').split('\r') if line]
    assert max(map(len, lines)) == 79 and lines[-1].startswith('rumba: building 27 %, 0:00 (usually 2 min): long')


def test_a_command_that_is_shown_is_spoken_of_only_while_it_is_silent():
    work = 'work() { for i in 1 2 3; do echo $i; sleep 0.4; done; sleep 3; echo end; }; '
    said, code, longest = recorded(['sh', '-c', f"{SETUP}{work}with_voice testing '3 s' work"], surroundings())
    assert code == 0 and longest < 3.0
    lines = said.splitlines()
    assert lines[:4] == ['rumba: testing, usually 3 s', '1', '2', '3'] and lines[-1] == 'end'
    assert all(line.startswith('rumba: testing, 0:0') for line in lines[4:-1]) and len(lines) > 5


def test_nobody_waits_for_the_next_beat_once_the_command_has_ended():
    begin = time.monotonic()
    said, code, _ = recorded(['sh', '-c', f"{SETUP}beat=60; with_progress building '' true"], surroundings())
    assert (said, code) == ('rumba: building\n', 0) and time.monotonic() - begin < 30.0


@pytest.mark.parametrize('lines, shown', [
    (['dlstatus:1:0.00:Retrieving', 'dlstatus:2:99.9:Retrieving', 'pmstatus:a:0.5:Unpacking a',
      'pmstatus:a:50:Configuring a', 'pmstatus:a:100:Installed a'], [0, 29, 30, 65, 100]),
    (['reading sources... [  5%] a', 'reading sources... [100%] z', 'writing output... [  0%] a',
      'writing output... [100%] z'], [2, 50, 50, 100]),
    (['[ 50%] Building', 'warning: [all%] of it', '[100%] Built'], [30, 30, 60])], ids=['apt', 'sphinx', 'make'])
def test_a_bar_runs_once(lines, shown):
    work = f'work() {{ printf "%s\\n" {" ".join(map(repr, lines))}; }}; '
    said, _, _ = recorded(['sh', '-c', f"set -eu; {SETUP}{work}with_progress working '' work"], surroundings(), True)
    assert [int(percent) for percent in re.findall(r'working (\d+) %', said)] == shown


@pytest.mark.parametrize('arguments, code', [([], 0), (['--at-most', '0.5'], 1), (['--until', 'o.e'], 0)])
def test_the_recorder_says_when_a_command_was_silent_longest(tmp_path, arguments, code):
    log = tmp_path / 'log'
    command = [sys.executable, str(ROOT / 'packaging' / 'silence.py'), '--log', str(log), *arguments, 'sh', '-c',
               'echo one; sleep 1; echo two; sleep ' + ('600' if '--until' in arguments else '0')]
    done = subprocess.run(command, stdout=subprocess.PIPE, universal_newlines=True, timeout=60.0)
    assert done.returncode == code
    if '--until' in arguments:
        assert re.search(r"^silence: \d+\.\d s in all, \d+\.\d s until 'o\.e'$", done.stdout, re.MULTILINE)
    else:
        assert re.search(r"^silence: \d\.\d s in all\nsilence: \d\.\d s after 'one\\r\\n'$", done.stdout, re.MULTILINE)
        assert [line.split(maxsplit=1)[1] for line in log.read_text().splitlines()] == ["'one\\r\\n'", "'two\\r\\n'"]
