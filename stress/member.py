"""One process of the trial ground, a node or the master: how it starts and ends, what it prints, what it holds."""

import collections
import contextlib
import ctypes
import resource
import signal
import subprocess
import sys
import threading
from typing import NamedTuple, Tuple

import psutil
import roslib.packages

KEPT = 20_000  # lines that are kept of what it printed since the last look
LINE = 5_000  # [bytes] that are kept of a line
DIES_WITH_PARENT = 1  # PR_SET_PDEATHSIG
ENDS_WITHIN = 20.0  # [s] after a signal that asks for it


class Role(NamedTuple):
    """A node as it is started."""

    name: str  # full name; without a slash at its beginning, it is no node
    package: str  # empty if the program is a path
    program: str
    ready: str = ''  # the topic that it registers last; empty: any will do
    arguments: Tuple[str, ...] = ()
    is_world: bool = False  # whether the robots are in it
    registers_again: bool = True  # whether it notices that the master was started again
    pulse: str = ''  # what shows that it does what it is for: one of oracles.PULSES
    talks: bool = False  # whether it prints a line for each message
    fails_if_ended: bool = False  # with exit code 1, as a test whose conditions are not met yet
    keeps: int = 0  # sockets to nodes that were killed, at most, until it wants to tell them something


class Usage(NamedTuple):
    """What a process holds."""

    fds: int
    sockets: int
    threads: int
    megabytes: float

    def __str__(self):
        return f'{self.fds} files of which {self.sockets} sockets, {self.threads} threads, {self.megabytes:.0f} MB'


class Member:
    """A process that is started again and again.

    Attributes:
        name: full name of the node.
        role: how it is started.
        process: of psutil; None before the first start.
        baseline: what it held once it had settled; None until then.
        starts: how often it was started.
        last: the last lines that it printed.
    """

    def __init__(self, role, environment, folder):
        """Prepare a process with an environment and a working directory."""
        self.name, self.role = role.name, role
        self.process = None
        self.baseline = None
        self.starts = 0
        self._environment, self._folder = environment, folder
        self._lines = collections.deque(maxlen=KEPT)
        self._reader = None
        self.last = collections.deque(maxlen=3)

    @property
    def command(self):
        """What is executed; without rosrun, so that the process is the node itself."""
        if self.role.package == 'rosmaster':
            return [sys.executable, '-c', 'import rosmaster; rosmaster.rosmaster_main()', *self.role.arguments]
        script = self.role.program
        if self.role.package:
            script = roslib.packages.find_node(self.role.package, script)[0]
        if not self.name.startswith('/'):
            return [script, *self.role.arguments]
        namespace, _, name = self.name.rpartition('/')
        return [script, *self.role.arguments, f'__name:={name}', f'__ns:={namespace or "/"}']

    def start(self, file_size=None, arguments=(), **environment):
        """Start it.

        Args:
            file_size: bytes after which no file of it can grow any more, as if the disk were full.
            arguments: further ones.
            environment: variables that differ.
        """
        def limit():
            ctypes.CDLL(None).prctl(DIES_WITH_PARENT, signal.SIGKILL)  # even if this process is killed
            if file_size is not None:
                resource.setrlimit(resource.RLIMIT_FSIZE, (file_size, file_size))

        self.process = psutil.Popen([*self.command, *arguments], cwd=str(self._folder), stdin=subprocess.DEVNULL,
                                    stdout=subprocess.PIPE, stderr=subprocess.STDOUT, preexec_fn=limit,
                                    env={**self._environment, **environment}, start_new_session=True)
        self.baseline = None
        self.starts += 1
        self._reader = threading.Thread(target=self._read, args=[self.process.stdout], daemon=True)
        self._reader.start()

    def _read(self, stream):
        with stream:
            for line in stream:
                text = line[:LINE].decode(errors='replace').rstrip('\n')
                self._lines.append(text)
                self.last.append(text)

    def printed(self):
        """The newest lines that it printed since the last look."""
        lines = []
        with contextlib.suppress(IndexError):
            while True:
                lines.append(self._lines.popleft())
        return lines

    @property
    def is_alive(self):
        """Whether it runs."""
        return self.process is not None and self.process.poll() is None

    def usage(self):
        """What it holds now.

        Raises:
            psutil.Error: it has ended.
        """
        with self.process.oneshot():
            return Usage(self.process.num_fds(), len(self.process.connections('inet')), self.process.num_threads(),
                         self.process.memory_info().rss / 2 ** 20)

    def end(self, number=signal.SIGTERM, patience=ENDS_WITHIN):
        """Send a signal that ends it, and wait; returns the exit code, None if it does not end and had to be killed."""
        if self.process is None:
            return None
        if self.is_alive:
            self.process.send_signal(number)
            self.process.send_signal(signal.SIGCONT)
        try:
            code = self.process.wait(patience)
        except psutil.TimeoutExpired:
            self.kill()
            return None
        self._reader.join(patience)
        return code

    def kill(self):
        """Kill it and all that it started."""
        if self.process is None:
            return
        with contextlib.suppress(psutil.Error):
            for child in self.process.children(recursive=True):
                child.kill()
        with contextlib.suppress(psutil.Error):
            self.process.kill()
        self.process.wait()
        self._reader.join(ENDS_WITHIN)
