"""Long commands of ./rumba say how far they are: no terminal stays silent for ten seconds."""

import os
import pty
import subprocess
import time

import pytest
from checkouts import commands, make_checkout, on_system, surroundings
from workspaces import ROOT

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
    """What a command prints, with the time of each piece [s], the exit code, and the longest silence [s]."""
    ours, theirs = pty.openpty() if is_terminal else os.pipe()
    begin = time.monotonic()
    process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=theirs, stderr=subprocess.STDOUT,
                               env=environment)
    os.close(theirs)
    pieces, times = [], [begin]
    while True:
        try:
            piece = os.read(ours, 65536)
        except OSError:  # a terminal that all have closed
            break
        if not piece:
            break
        pieces.append(piece.decode())
        times.append(time.monotonic())
    os.close(ours)
    code = process.wait()
    times.append(time.monotonic())
    return ''.join(pieces), code, max(after - before for before, after in zip(times, times[1:]))


@pytest.mark.parametrize('is_terminal', [False, True], ids=['piped', 'terminal'])
def test_apt_that_says_nothing_leaves_no_silence(tmp_path, is_terminal):
    path = commands(tmp_path / 'bin', **{
        'apt-get': APT,
        'apt-cache': '#!/bin/sh\n', 'id': '#!/bin/sh\necho 0\n', 'dpkg-query': '#!/bin/sh\nexit 1\n'})
    environment = surroundings(PATH=f'{path}:{os.environ["PATH"]}', **on_system(tmp_path))
    said, code, silence = recorded([str(make_checkout(tmp_path / 'checkout') / 'rumba'), 'build'], environment,
                                   is_terminal)
    assert code == 1 and 'cannot install packages: broken' in said
    assert 'rumba: installing 2 packages, 7 MB to download' in said
    assert 'MB to download, 0:08 (usually 1 to 5 min)' in said and silence < SILENCE


def test_a_build_that_stands_at_100_percent_says_what_it_does_and_for_how_long():
    work = 'work() { echo "[100%] Compiling the functions"; sleep 5; return 3; }; '
    said, code, silence = recorded(['sh', '-c', f"{SETUP}{work}with_progress building '2 min' work"], surroundings())
    assert code == 3 and silence < 4.0
    assert said.startswith('rumba: building\nrumba: building 100 %, 0:0')
    assert said.splitlines()[-1].endswith(' (usually 2 min): Compiling the functions')


def test_a_line_of_progress_fits_a_terminal_of_80_columns():
    work = f'work() {{ echo "[ 45%] {"long " * 40}"; }}; '
    said, _, _ = recorded(['sh', '-c', f"{SETUP}{work}with_progress building '2 min' work"], surroundings(), True)
    lines = [line for line in said.replace('\x1b[K', '').split('\r') if line]
    assert max(map(len, lines)) == 79 and lines[-1].startswith('rumba: building  45 %, 0:00 (usually 2 min): long')


def test_a_command_that_is_shown_is_spoken_of_only_while_it_is_silent():
    work = 'work() { for i in 1 2 3; do echo $i; sleep 0.4; done; sleep 3; echo end; }; '
    said, code, silence = recorded(['sh', '-c', f"{SETUP}{work}with_voice testing '' work"], surroundings())
    assert code == 0 and silence < 3.0
    lines = said.splitlines()
    assert lines[:3] == ['1', '2', '3'] and lines[-1] == 'end'
    assert all(line.startswith('rumba: testing, 0:0') for line in lines[3:-1]) and len(lines) > 4


def test_nobody_waits_for_the_next_beat_once_the_command_has_ended():
    begin = time.monotonic()
    said, code, _ = recorded(['sh', '-c', f"{SETUP}beat=60; with_progress building '' true"], surroundings())
    assert (said, code) == ('rumba: building\n', 0) and time.monotonic() - begin < 30.0
