"""Scratch catkin workspaces and a roscore of their own, untouched by the workspace that runs the tests."""

import contextlib
import os
import pathlib
import signal
import socket
import subprocess
import threading
import time
from typing import Dict, Iterator, Optional

ROOT = pathlib.Path(__file__).resolve().parents[1]
WS = (ROOT / '.ws').resolve()  # a link if the path of the checkout has spaces
OURS = [path.parent for path in sorted(ROOT.glob('*/package.xml'))]
STAND_INS = [path.parent for path in sorted(ROOT.glob('compat/*/package.xml'))]
TUTORIALS = [path.parent for path in sorted(ROOT.glob('rumba_tutorials/**/package.xml'))]
TIMEOUT = 60.0
BUILD_TIMEOUT = 900.0
FROM_OTHER_WORKSPACES = ('CMAKE_PREFIX_PATH', 'ROS_PACKAGE_PATH', 'PYTHONPATH', 'PKG_CONFIG_PATH', 'LD_LIBRARY_PATH')
NOETIC_SETUP = pathlib.Path('/opt/ros/noetic/setup.sh')
UNDERLAY = f'. {NOETIC_SETUP}; ' if NOETIC_SETUP.exists() else ''


class Space:
    """What a user has after sourcing a setup file."""

    def __init__(self, setup: str, environment: Dict[str, str]) -> None:
        self._setup = setup
        self._environment = environment

    def start(self, command: str, **options) -> subprocess.Popen:
        """Start a shell command in this space; `options` go to Popen."""
        return subprocess.Popen(['bash', '-c', f'{self._setup} exec {command}'], universal_newlines=True,
                                env=self._environment, **{'stdout': subprocess.PIPE, **options})

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


class Workspace:
    """A catkin workspace in a new folder, with links to packages."""

    def __init__(self, path: pathlib.Path, packages, environment: Dict[str, str], over: str = '') -> None:
        """Make the folder if there is none; `over` is the setup file of a workspace below this one, if any."""
        self.path = path
        self._environment = environment
        self._below = Space(UNDERLAY + (f'. {over};' if over else ''), environment)
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
        """What a user has in `devel` or `install`; `environment` is one with another master."""
        return Space(f'. {self.setup(space)};', environment or self._environment)


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
    """This process's environment without other workspaces, for a roscore of its own on this machine."""
    with socket.socket() as free:
        free.bind(('localhost', 0))
        port = free.getsockname()[1]
    environment = {name: value for name, value in os.environ.items() if name not in FROM_OTHER_WORKSPACES}
    return {**environment, 'ROS_MASTER_URI': f'http://localhost:{port}', 'ROS_HOSTNAME': 'localhost'}


@contextlib.contextmanager
def roscore(environment: Dict[str, str]) -> Iterator[None]:
    """A master at the environment's ROS_MASTER_URI, as long as the block."""
    port = environment['ROS_MASTER_URI'].rpartition(':')[2]
    space = Space(UNDERLAY, environment)
    with space.running(f'roscore -p {port}'):
        deadline = time.monotonic() + TIMEOUT
        while space.start('rosparam get /run_id', stderr=subprocess.DEVNULL).wait(TIMEOUT) != 0:
            assert time.monotonic() < deadline, 'roscore does not come up'
        yield
