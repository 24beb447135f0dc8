"""The processes that tests of nodes start cannot tell that they come from a process that had loaded the libraries."""

import json
import os
import signal
import subprocess

import programs
import pytest

TELLS = """#!/usr/bin/env python3
import json, os, signal, sys
told = {
    'arguments': sys.argv, 'name': __name__, 'folder': os.getcwd(), 'path': sys.path, 'stdin': sys.stdin.read(),
    'environment': dict(os.environ), 'parent': os.getppid(), 'group': os.getpgrp(),
    'files': sorted(os.readlink(f'/proc/self/fd/{number}').split(':')[0] for number in range(3)),
    'others': [number for number in os.listdir('/proc/self/fd') if int(number) > 2 and
               'socket' in os.path.realpath(f'/proc/self/fd/{number}')],
    'signals': [str(signal.getsignal(number)) for number in (signal.SIGINT, signal.SIGTERM, signal.SIGPIPE)],
    'ros': [name for name in sys.modules if 'rospy' in name or name.startswith('rumba_sim.ros')]}
print(json.dumps(told))
print('an error', file=sys.stderr)
sys.exit(3)
"""


@pytest.fixture
def script(tmp_path):
    """A function that writes a program and returns its path."""
    def write(text):
        path = tmp_path / 'program'
        path.write_text(text)
        path.chmod(0o755)
        return str(path)
    return write


def test_what_a_program_sees_is_what_it_sees_if_it_is_started_as_usual(script, tmp_path):
    path = script(TELLS)
    options = {'stdin': subprocess.PIPE, 'stdout': subprocess.PIPE, 'stderr': subprocess.PIPE, 'cwd': str(tmp_path),
               'universal_newlines': True,
               'env': {**os.environ, 'MARK': 'x', 'PYTHONPATH': f'/no/where:{os.environ.get("PYTHONPATH", "")}'}}
    found = []
    for process in (subprocess.Popen([path, '_map:=studio', 'b c'], **options),
                    programs.start_script(path, '_map:=studio', 'b c', **options)):
        output, error = process.communicate('typed', timeout=60.0)
        found.append((json.loads(output), error, process.returncode))
    usual, ours = found
    assert usual == ours
    assert usual[0]['arguments'] == [path, '_map:=studio', 'b c'] and usual[0]['stdin'] == 'typed'
    assert usual[1:] == ('an error\n', 3) and usual[0]['parent'] == os.getpid()


@pytest.mark.parametrize('text, code', [
    ('pass', 0), ('import sys; sys.exit("a reason")', 1), ('import sys; sys.exit(2)', 2), ('1 / 0', 1),
    ('import os; os._exit(7)', 7), ('import os, signal; os.kill(os.getpid(), signal.SIGTERM)', -signal.SIGTERM),
    ('import os, signal; os.kill(os.getpid(), signal.SIGKILL)', -signal.SIGKILL),
    ('import atexit; atexit.register(print, "at exit")', 0)])
def test_it_ends_as_it_would(script, text, code):
    path = script(f'#!/usr/bin/env python3\n{text}\n')
    options = {'stdout': subprocess.PIPE, 'stderr': subprocess.PIPE, 'universal_newlines': True}
    usual = subprocess.run([path], check=False, **options)
    process = programs.start_script(path, **options)
    output, error = process.communicate(timeout=60.0)
    assert (process.returncode, output) == (usual.returncode, usual.stdout)
    assert process.returncode == code
    assert error.splitlines()[-1:] == usual.stderr.splitlines()[-1:]


def test_signals_reach_it_and_it_is_a_process_of_its_own(script):
    path = script('#!/usr/bin/env python3\nimport time\nprint("on", flush=True)\ntime.sleep(600.0)\n')
    one, other = (programs.start_script(path, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) for _ in range(2))
    assert one.stdout.readline() == other.stdout.readline() == b'on\n'
    assert one.pid != other.pid and os.getppid() != one.pid
    one.send_signal(signal.SIGINT)
    one.communicate(timeout=60.0)
    assert one.returncode in (1, -signal.SIGINT)  # as a KeyboardInterrupt that nobody catches
    assert other.poll() is None
    other.kill()
    other.communicate(timeout=60.0)
    assert other.returncode == -signal.SIGKILL
