"""Scratch catkin workspaces and a master of their own, untouched by the workspace that runs the tests."""

import contextlib
import functools
import os
import pathlib
import re
import signal
import subprocess
import threading
import time
import uuid
import xmlrpc.client
from typing import Dict, FrozenSet, Iterator, List, Optional, Sequence, Tuple

from ports import free_port

ROOT = pathlib.Path(__file__).resolve().parents[1]
WS = (ROOT / '.ws').resolve()  # a link if the path of the checkout has spaces
OURS = [path.parent for path in sorted(ROOT.glob('*/package.xml'))]
STAND_INS = [path.parent for path in sorted(ROOT.glob('compat/*/package.xml'))]
TUTORIALS = [path.parent for path in sorted(ROOT.glob('rumba_tutorials/**/package.xml'))]
SPEED_GUARD = ROOT / 'rumba_tutorials' / '04_cpp_library' / 'speed_guard'  # which uses the library beside it
TIMEOUT = 60.0
BUILD_TIMEOUT = 900.0
FROM_OTHER_WORKSPACES = ('CMAKE_PREFIX_PATH', 'ROS_PACKAGE_PATH', 'PYTHONPATH', 'PKG_CONFIG_PATH', 'LD_LIBRARY_PATH')
# What ./rumba has built its own workspace over: empty if that is the ROS of the distribution, below /usr.
BELOW = [pathlib.Path(path) for path in os.environ.get('CMAKE_PREFIX_PATH', '').split(':')
         if path and WS not in pathlib.Path(path).parents and (pathlib.Path(path) / 'setup.sh').exists()]
UNDERLAY = [path / 'setup.sh' for path in BELOW[:1]]  # the setup files below every workspace


class Space:
    """What a user has after sourcing setup files, and after the shell commands of a preamble."""

    def __init__(self, setups: Sequence[pathlib.Path], environment: Dict[str, str], preamble: str = '') -> None:
        self._setups = tuple(setups)
        self._environment = environment
        self._preamble = preamble

    def start(self, command: str, **options) -> subprocess.Popen:
        """Start a shell command in this space; `options` go to Popen."""
        return subprocess.Popen(['bash', '-c', f'{self._preamble} exec {command}'], universal_newlines=True,
                                env=sourced(self._setups, self._environment), **{'stdout': subprocess.PIPE, **options})

    def run(self, command: str, timeout: float = TIMEOUT, **options) -> str:
        """Output of a shell command in this space, which must succeed."""
        process = self.start(command, stderr=subprocess.PIPE, **options)
        output, errors = process.communicate(timeout=timeout)
        assert process.returncode == 0, f'{command}: exit code {process.returncode}\n{output}{errors}'
        return output

    @contextlib.contextmanager
    def running(self, command: str) -> Iterator[subprocess.Popen]:
        """A node that runs as long as the block."""
        process = self.start(command)
        try:
            yield process
        finally:
            process.send_signal(signal.SIGINT)
            process.communicate(timeout=TIMEOUT)

    @contextlib.contextmanager
    def printing(self, command: str) -> Iterator['Printed']:
        """What a node prints that runs as long as the block."""
        printed = Printed(self.start(command))
        try:
            yield printed
        finally:
            printed.process.send_signal(signal.SIGINT)
            printed.process.wait(TIMEOUT)
            printed.reader.join()
            printed.process.stdout.close()


class Printed:
    """A process, and the lines that it has printed, for tests that share it."""

    def __init__(self, process: subprocess.Popen) -> None:
        self.process = process
        self.lines: List[str] = []
        self._news = threading.Condition()
        self.reader = threading.Thread(target=self._read)
        self.reader.start()

    def _read(self) -> None:
        for line in self.process.stdout:
            with self._news:
                self.lines.append(line)
                self._news.notify_all()

    def find(self, pattern: str, begin: int = 0) -> int:
        """The number of the first line from `begin` on in which a pattern is found, once it is printed."""
        with self._news:
            assert self._news.wait_for(lambda: self._first(pattern, begin) is not None, 3.0 * TIMEOUT), (
                f'waited in vain for: {pattern}')
            return self._first(pattern, begin)

    def fresh(self, pattern: str) -> int:
        """The same for lines that are printed from now on."""
        return self.find(pattern, len(self.lines))

    def _first(self, pattern: str, begin: int) -> Optional[int]:
        found = re.compile(pattern)
        return next((number for number in range(begin, len(self.lines)) if found.search(self.lines[number])), None)


def sourced(setups: Tuple[pathlib.Path, ...], environment: Dict[str, str]) -> Dict[str, str]:
    """An environment, with ROS_MASTER_URI, after sourcing setup files, which leave ROS_MASTER_URI as it is."""
    if not setups:
        return environment
    others = frozenset(item for item in environment.items() if item[0] != 'ROS_MASTER_URI')
    return {**_sourced(setups, others), 'ROS_MASTER_URI': environment['ROS_MASTER_URI']}


@functools.lru_cache(maxsize=None)  # to source them takes longer than many a command of the tests
def _sourced(setups: Tuple[pathlib.Path, ...], environment: FrozenSet[Tuple[str, str]]) -> Dict[str, str]:
    script = ' && '.join([*(f'. {setup}' for setup in setups), 'exec env -0'])
    variables = subprocess.check_output(['bash', '-c', script], env=dict(environment), universal_newlines=True)
    return dict(variable.split('=', 1) for variable in variables.split('\0') if variable)


class Workspace:
    """A catkin workspace in a new folder, with links to packages."""

    def __init__(self, path: pathlib.Path, packages, environment: Dict[str, str],
                 over: Sequence[pathlib.Path] = UNDERLAY) -> None:
        """Make the folder if there is none; `over` are the setup files of what is below this workspace."""
        self.path = path
        self._environment = environment
        self._below = Space(over, environment)
        if not path.exists():
            (path / 'src').mkdir(parents=True)
            for package in packages:
                (path / 'src' / package.name).symlink_to(package)

    def make(self, target: str = '', python: str = '/usr/bin/python3') -> str:
        """catkin_make -j2, which must succeed; returns what it printed."""
        names = f'-DPYTHON_EXECUTABLE={python} -DPython_EXECUTABLE={python}'  # as in ./rumba
        return self._below.run(f'catkin_make -j2 {names} {target}', BUILD_TIMEOUT, cwd=self.path)

    def setup(self, space: str) -> pathlib.Path:
        """The setup file of `devel` or `install`."""
        return self.path / space / 'setup.sh'

    def space(self, space: str, environment: Optional[Dict[str, str]] = None) -> Space:
        """What a user has in `devel` or `install`; `environment` is one with another master.

        A command finds the nodes of the workspace in the folder $LIB: rosrun takes longer to look for a node than most
        nodes take to start.
        """
        return Space([self.setup(space)], environment or self._environment, f'LIB={self.path / space}/lib;')


def lines(process: subprocess.Popen) -> Iterator[str]:
    """What a process prints until it ends; it is killed after some minutes."""
    watch = threading.Timer(3.0 * TIMEOUT, process.kill)
    watch.start()
    try:
        for line in process.stdout:  # not `yield from`, which would close the file
            yield line
    finally:
        watch.cancel()


def last_of(process: subprocess.Popen, *wanted: str) -> str:
    """What a process prints beside the last of these words, once it has printed all of them in this order."""
    printed = lines(process)
    for word in wanted:
        line = next((line for line in printed if word in line), None)
        assert line is not None, f'waited in vain for: {word}'
    return line


def clean_environment() -> Dict[str, str]:
    """This process's environment without other workspaces, for a master of its own on this machine."""
    environment = {name: value for name, value in os.environ.items() if name not in FROM_OTHER_WORKSPACES}
    return {**environment, 'ROS_MASTER_URI': f'http://localhost:{free_port()}', 'ROS_HOSTNAME': 'localhost'}


@contextlib.contextmanager
def master(environment: Dict[str, str]) -> Iterator[None]:
    """A master at the environment's ROS_MASTER_URI, as long as the block; roscore takes several times as long."""
    uri = environment['ROS_MASTER_URI']
    with Space(UNDERLAY, environment).running(f'rosmaster --core -p {uri.rpartition(":")[2]}'):
        deadline = time.monotonic() + TIMEOUT
        while not has_begun(xmlrpc.client.ServerProxy(uri)):
            assert time.monotonic() < deadline, 'the master does not come up'
            time.sleep(0.02)
        yield


def has_begun(api: xmlrpc.client.ServerProxy) -> bool:
    """Whether a master answers; it then bears a name of its own, as those that roscore starts."""
    try:
        api.setParam('/test', '/run_id', str(uuid.uuid4()))
    except OSError:
        return False
    return True
