"""The sandbox of a submission: what a program in it sees, changes, and is given."""

import os
import pathlib
import signal
import subprocess
import sys

import pytest

from rumba_evaluation.submissions import sandbox, supervised
from rumba_evaluation.submissions.sandbox import Bubblewrap, Plain
from rumba_evaluation.submissions.supervised import Limits

TROUBLE = sandbox.trouble()
needs_sandbox = pytest.mark.skipif(bool(TROUBLE), reason=f'this system permits no sandbox: {TROUBLE}')
LIMITS = Limits(60.0)
PRINTS = 'import os, sys; print(sys.argv[1:], sorted(os.environ.items()))'


@pytest.fixture
def own(tmp_path):
    """The folder of a submission."""
    folder = tmp_path / 'own'
    for name in ('shm', 'tmp'):
        (folder / name).mkdir(parents=True)
    return folder


def shell(box, own, command, around='around_node'):
    """What a shell command prints that a submission runs."""
    return supervised.run(box.around_test(getattr(box, around)(['sh', '-c', command], str(own))), dict(os.environ),
                          str(own), LIMITS).output


@needs_sandbox
def test_a_program_changes_its_own_folder_and_nothing_else(own, tmp_path):
    box = Bubblewrap([str(tmp_path)], [])
    places = [own, own / 'src', tmp_path, '/', '/usr', '/etc', '/opt', '/var', '/home', '/root', '/proc/sys/kernel']
    (own / 'src').mkdir()
    shell(box, own, ' '.join(f'touch {place}/mark;' for place in places) + 'touch /tmp/mark /dev/shm/mark')
    found = [place for place in places if (pathlib.Path(place) / 'mark').exists()]
    assert found == [own, own / 'src']
    assert (own / 'tmp' / 'mark').exists() and (own / 'shm' / 'mark').exists()
    assert not pathlib.Path('/tmp/mark').exists() and not pathlib.Path('/dev/shm/mark').exists()


@needs_sandbox
def test_a_program_sees_what_it_needs_but_nothing_of_what_is_hidden_below_it(own, tmp_path):
    (tmp_path / 'packages' / 'tests').mkdir(parents=True)
    (tmp_path / 'others').mkdir()
    for path in ('packages/needed', 'packages/tests/hidden', 'others/hidden'):
        (tmp_path / path).write_text('here')
    (tmp_path / 'link').symlink_to('packages')
    box = Bubblewrap([str(tmp_path / 'link')], [str(tmp_path / 'link' / 'tests'), str(tmp_path / 'others')])
    found = shell(box, own, f'cat {tmp_path}/link/needed {tmp_path}/packages/needed; '
                            f'find / -name hidden -not -path "/proc/*" -not -path "/sys/*" 2>/dev/null')
    assert found == 'herehere'


@needs_sandbox
def test_a_program_sees_no_other_processes_and_no_network(own):
    other = int(subprocess.check_output(['sh', '-c', 'sleep 600 >&- & echo $!']))
    found = shell(Bubblewrap([], []), own, f'kill -9 {other}; kill -9 {os.getpid()}; ls /proc | grep -c "^[0-9]"; '
                                           'grep -c : /proc/net/dev')
    os.kill(other, signal.SIGKILL)
    processes, interfaces = map(int, found.splitlines()[-2:])
    assert processes < 10 and interfaces == 1


@needs_sandbox
def test_a_program_does_not_see_the_environment_of_who_marks(own, monkeypatch):
    monkeypatch.setenv('SECRET_OF_THE_TEACHER', 'x')
    found = shell(Bubblewrap([], []), own, 'env; cat /proc/*/environ')
    assert 'PATH=' in found and 'SECRET_OF_THE_TEACHER' not in found


def test_what_ends_a_run_is_not_taken_from_the_folder_of_a_submission(own):
    package = own / 'rumba_evaluation'
    (package / 'submissions').mkdir(parents=True)
    for path in (package / '__init__.py', package / 'submissions' / '__init__.py', own / 'os.py', own / 'signal.py'):
        path.write_text("raise SystemExit('taken from the submission')\n")
    found = supervised.run(Plain().around_test(['echo', 'well']), dict(os.environ), str(own), LIMITS)
    assert found == (0, 'well\n', '')


@needs_sandbox
def test_a_program_has_no_rights_beyond_those_of_a_user(own):
    assert 'CapEff:\t0000000000000000\n' in shell(Bubblewrap([], []), own, 'cat /proc/self/status')


@pytest.mark.parametrize('box', [Plain(), pytest.param(Bubblewrap([], []), marks=needs_sandbox)],
                         ids=['without', 'with'])
def test_one_process_has_bounds_of_its_own(own, box):
    assert 'File size limit exceeded' in shell(box, own, 'head -c 300000000 /dev/zero > large || wc -c large')
    assert (own / 'large').stat().st_size == sandbox.FILE
    code = "x = bytearray(3 * 10**9)"
    assert 'MemoryError' in shell(box, own, f'{sys.executable} -c "{code}"')


def test_a_script_gives_an_environment_of_its_own_and_hides_the_log_file(tmp_path):
    path = tmp_path / 'script'
    command = sandbox.clean({'NAME': "it's $HOME", 'PATH': os.environ['PATH']}, [sys.executable, '-c', PRINTS, 'first'])
    path.write_text(sandbox.script(command, ['GIVEN', 'OTHER']))
    path.chmod(0o755)
    environment = {**os.environ, 'GIVEN': 'a b', 'SECRET': 'x'}
    environment.pop('OTHER', None)
    found = subprocess.run([str(path), '__log:=/a/b.log', 'c d', '__name:=e'], env=environment, stdout=subprocess.PIPE,
                           universal_newlines=True, check=True).stdout
    assert found.startswith("['first', 'c d', '__name:=e'] [('GIVEN', 'a b'), ")
    assert "('NAME', \"it's $HOME\")" in found and 'SECRET' not in found and 'OTHER' not in found


def test_it_is_told_why_there_is_no_sandbox(monkeypatch, tmp_path):
    monkeypatch.setenv('PATH', str(tmp_path))
    assert sandbox.trouble() == 'bubblewrap is not installed'
    program = tmp_path / 'bwrap'
    program.write_text('#!/bin/sh\necho first\necho "bwrap: No permissions" >&2\nexit 1\n')
    program.chmod(0o755)
    assert sandbox.trouble() == 'bwrap: No permissions'
    program.write_text('#!/bin/sh\nexit 3\n')
    assert sandbox.trouble() == 'bwrap ended with exit code 3'
