"""Runs a command that nobody trusts: with limits of time, memory, processes, files and output, and a sure end."""

import contextlib
import os
import selectors
import signal
import subprocess
import threading
import time
from typing import Iterator, Mapping, NamedTuple, Optional, Sequence, Set, Tuple

from rumba_evaluation.submissions import processes

LOOK_PERIOD = 0.2  # [s] of the wall clock between two looks at what the processes take
DISK_PERIOD = 2.0  # [s] of the wall clock between two looks at what they have written
MEGABYTE = 1_000_000
_running: Set[int] = set()  # numbers of the processes that `run` has started
_starting = threading.Lock()  # held while `_running` changes


class Limits(NamedTuple):
    """What a run may take."""

    seconds: float  # of the wall clock
    memory: int = 4_000 * MEGABYTE  # [bytes] resident, of all processes
    processes: int = 300
    disk: int = 1_000 * MEGABYTE  # [bytes] below the folder
    files: int = 50_000
    output: int = MEGABYTE  # [bytes] that are kept: half from the beginning, half from the end


class Run(NamedTuple):
    """What became of a run."""

    code: int
    output: str
    stopped: str  # why it was ended, in words; empty if it has ended itself


Stop = Optional[threading.Event]  # is set to end all runs from another thread


class Stopped(Exception):
    """The whole work is to end."""


def run(command: Sequence[str], environment: Mapping[str, str], folder: str, limits: Limits,
        stop: Stop = None) -> Run:
    """Run a command in a folder.

    The process that it starts must end all others that it has started, as `keeper` and a sandbox do.

    Args:
        command: with its arguments.
        environment: the whole of it.
        folder: in which it runs, and whose size counts.
        limits: of the run.
        stop: is set to end the run from another thread.

    Raises:
        Stopped: `stop` was set.
        OSError: the command cannot be started.
    """
    with _started(command, environment, folder) as process:
        return _Watch(process, folder, limits, stop).run()


@contextlib.contextmanager
def _started(command: Sequence[str], environment: Mapping[str, str], folder: str
             ) -> Iterator['subprocess.Popen[bytes]']:
    """A process that has ended after the block, with all that it has started."""
    with _starting:
        process = subprocess.Popen(command, env=environment, cwd=folder, stdin=subprocess.DEVNULL,
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True)
        _running.add(process.pid)
    try:
        yield process
    finally:
        if process.poll() is None:
            processes.end_all(process.pid)
            process.kill()
        assert process.stdout is not None
        process.stdout.close()
        process.wait()
        with _starting:
            _running.discard(process.pid)
            processes.end_strangers(_running)


class _Watch:
    """Looks at one run."""

    def __init__(self, process: 'subprocess.Popen[bytes]', folder: str, limits: Limits,
                 stop: Stop) -> None:
        self._process, self._folder, self._limits, self._stop = process, folder, limits, stop
        self._kept = Kept(limits.output)
        self._disk_due = 0.0

    def run(self) -> Run:
        """Wait for the end, or bring it about."""
        end = time.monotonic() + self._limits.seconds
        excess = ''
        while self._read() and not excess and time.monotonic() < end:
            excess = self._excess()
        if excess:
            return Run(-signal.SIGKILL, self._kept.text(), excess)
        if self._process.poll() is None:
            return Run(-signal.SIGKILL, self._kept.text(), f'it took longer than {self._limits.seconds:g} s')
        return Run(self._process.wait(), self._kept.text(), '')

    def _read(self) -> bool:
        """Take what is printed until the next look is due; returns whether the command may print more."""
        if self._stop is not None and self._stop.is_set():
            raise Stopped
        assert self._process.stdout is not None
        with selectors.DefaultSelector() as selector:
            selector.register(self._process.stdout, selectors.EVENT_READ)
            end = time.monotonic() + LOOK_PERIOD
            while time.monotonic() < end:
                if selector.select(max(0.0, end - time.monotonic())):
                    data = os.read(self._process.stdout.fileno(), 65536)
                    if not data:
                        return self._lives()
                    self._kept.add(data)
        return self._process.poll() is None

    def _lives(self) -> bool:
        """Whether the process goes on, although it prints no more."""
        try:
            self._process.wait(LOOK_PERIOD)
        except subprocess.TimeoutExpired:
            return True
        return False

    def _excess(self) -> str:
        """What is too much, in words."""
        load = processes.load(self._process.pid)
        if load.memory > self._limits.memory:
            return f'its processes took more than {self._limits.memory // MEGABYTE} MB of memory'
        if load.number > self._limits.processes:
            return f'it started more than {self._limits.processes} processes'
        if time.monotonic() >= self._disk_due:
            written, files = _sizes(self._folder)
            self._disk_due = time.monotonic() + DISK_PERIOD
            if written > self._limits.disk:
                return f'it wrote more than {self._limits.disk // MEGABYTE} MB into files'
            if files > self._limits.files:
                return f'it made more than {self._limits.files} files'
        return ''


class Kept:
    """The beginning and the end of an output."""

    def __init__(self, most: int) -> None:
        """Keep so many bytes."""
        self._half = most // 2
        self._first, self._last = bytearray(), bytearray()
        self._left_out = 0

    def add(self, data: bytes) -> None:
        """Take what was printed."""
        room = self._half - len(self._first)
        self._first += data[:room]
        self._last += data[room:]
        if len(self._last) > 2 * self._half:
            self._cut()

    def _cut(self) -> None:
        more = max(0, len(self._last) - self._half)
        self._left_out += more
        del self._last[:more]

    def text(self) -> str:
        """All that is kept."""
        self._cut()
        left_out = f'\n... {self._left_out} bytes are left out ...\n'.encode() if self._left_out else b''
        return (self._first + left_out + self._last).decode(errors='replace')


def _sizes(folder: str) -> Tuple[int, int]:
    """Bytes of all files below a folder, and their number; folders may be nested deeper than Python can go."""
    found = [subprocess.run(['du', '-s', *options, folder], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                            check=False).stdout.split() for options in (['--block-size=1'], ['--inodes'])]
    written, files = (int(words[0]) if words else 0 for words in found)
    return written, files
