"""Runs that nobody trusts: their limits, and that nothing of them is left."""

import os
import pathlib
import subprocess
import sys
import textwrap
import threading
import time

import pytest

from rumba_evaluation.submissions import processes, sandbox, scratch, supervised
from rumba_evaluation.submissions.supervised import Kept, Limits, Stopped

LONG = 60.0  # [s]: no test takes as long
DETACHED = """
    import os, subprocess, sys, time
    subprocess.Popen(['setsid', 'sh', '-c', 'echo $$ > {pid}; exec sleep 1000'])
    while not os.path.exists({pid!r}) or not open({pid!r}).read():
        time.sleep(0.01)
"""


def run(code, folder, limits=Limits(LONG), stop=None):
    """Run code in Python, as a test is run without a sandbox."""
    command = sandbox.Plain().around_test([sys.executable, '-c', textwrap.dedent(code)])
    return supervised.run(command, dict(os.environ), str(folder), limits, stop)


def lives(path):
    """Whether the process lives whose number is in a file."""
    try:
        return pathlib.Path(f'/proc/{path.read_text().strip()}/stat').read_text().split()[2] != 'Z'
    except FileNotFoundError:
        return False


def test_the_exit_code_and_the_output_are_kept(tmp_path):
    done = run('import os, sys; print(os.getcwd()); sys.exit(3)', tmp_path)
    assert done == (3, f'{tmp_path}\n', '')


def test_what_a_run_has_started_ends_with_it_also_in_a_session_of_its_own(tmp_path):
    pid = tmp_path / 'pid'
    begin = time.monotonic()
    assert run(DETACHED.format(pid=str(pid)), tmp_path).stopped == ''
    assert pid.exists() and not lives(pid) and time.monotonic() - begin < LONG / 2


def test_what_outlives_a_killed_keeper_is_ended_too(tmp_path):
    pid = tmp_path / 'pid'
    program = tmp_path / 'marking.py'
    program.write_text(textwrap.dedent(f"""
        import os, sys
        from rumba_evaluation.submissions import processes, sandbox, supervised
        processes.adopt_orphans()
        code = {textwrap.dedent(DETACHED.format(pid=str(pid))) + 'os.kill(os.getppid(), 9); time.sleep(1000)'!r}
        done = supervised.run(sandbox.Plain().around_test([sys.executable, '-c', code]), dict(os.environ),
                              {str(tmp_path)!r}, supervised.Limits({LONG}))
        print(done.code)
        """))
    assert subprocess.run([sys.executable, str(program)], stdout=subprocess.PIPE, check=True).stdout == b'-9\n'
    assert pid.exists() and not lives(pid)


def test_a_run_ends_with_the_process_that_has_started_it(tmp_path):
    pid = tmp_path / 'pid'
    command = sandbox.Plain().around_test(
        [sys.executable, '-c', textwrap.dedent(DETACHED.format(pid=str(pid))) + 'time.sleep(1000)'])
    starter = subprocess.Popen([sys.executable, '-c', f'import subprocess; subprocess.run({command!r})'],
                               start_new_session=True)
    end = time.monotonic() + LONG
    while not (pid.exists() and pid.read_text() and lives(pid)) and time.monotonic() < end:
        time.sleep(0.01)
    starter.kill()
    starter.wait()
    while lives(pid) and time.monotonic() < end:
        time.sleep(0.01)
    assert not lives(pid)


@pytest.mark.parametrize('code, limits, reason', [
    ('import time; time.sleep(1000)', Limits(1.0), 'it took longer than 1 s'),
    ('import sys\nwhile True: sys.stdout.write(10000 * "x")', Limits(2.0, output=1000), 'it took longer than 2 s'),
    ('x = bytearray(b"x" * 300_000_000); import time; time.sleep(1000)', Limits(LONG, memory=100_000_000),
     'its processes took more than 100 MB of memory'),
    ('import subprocess\nwhile True: subprocess.Popen(["setsid", "sleep", "1000"])', Limits(LONG, processes=40),
     'it started more than 40 processes'),
    ('import os\nfor number in range(500): open(str(number), "w").close()\nimport time; time.sleep(1000)',
     Limits(LONG, files=300), 'it made more than 300 files'),
    ('f = open("big", "wb")\nfor _ in range(100): f.write(1_000_000 * b"x")\nf.flush(); import time; time.sleep(1000)',
     Limits(LONG, disk=50_000_000), 'it wrote more than 50 MB into files')])
def test_what_takes_too_much_is_ended_with_the_reason(tmp_path, code, limits, reason):
    done = run(code, tmp_path, limits)
    assert done.stopped == reason and len(done.output) < 3000 and not processes.below(os.getpid())


def test_another_thread_can_stop_a_run(tmp_path):
    stop = threading.Event()
    threading.Timer(0.5, stop.set).start()
    with pytest.raises(Stopped):
        run('import time; time.sleep(1000)', tmp_path, stop=stop)
    assert not processes.below(os.getpid())


@pytest.mark.parametrize('parts', [[b'ab'], [b'abc', b'', b'defg'], [b'abcdefgh', b'ijkl', b'mnop', b'qr']])
def test_of_an_output_the_beginning_and_the_end_are_kept(parts):
    kept = Kept(8)
    for part in parts:
        kept.add(part)
    whole = b''.join(parts).decode()
    text = kept.text()
    assert text == whole if len(whole) <= 8 else text.startswith('abcd\n... ') and text.endswith(whole[-2:])


def test_scratch_folders_of_a_killed_process_are_removed_and_others_are_not(tmp_path, monkeypatch):
    monkeypatch.setattr('tempfile.tempdir', str(tmp_path))
    abandoned = tmp_path / f'{scratch.PREFIX}old'
    (abandoned / 'closed' / 'more').mkdir(parents=True)
    (abandoned / scratch.LOCK).write_text('')
    (abandoned / 'closed').chmod(0)
    here = os.getcwd()
    os.chdir(abandoned)
    for _ in range(3000):  # deeper than Python can go, and than a path can name
        os.mkdir('deep')
        os.chdir('deep')
    os.chdir(here)
    with scratch.folder() as used:
        assert scratch.remove_abandoned() == [str(abandoned)] and not abandoned.exists() and used.exists()
    assert list(tmp_path.iterdir()) == []
