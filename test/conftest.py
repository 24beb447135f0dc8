"""Workspaces that the tests share: that of ./rumba, and those of strangers, each built from nothing once."""

import contextlib
import fcntl
import os
import shutil
import signal
import subprocess

import pytest
from workspaces import BUILD_TIMEOUT, ROOT, UNDERLAY, WS, Space, Workspace, clean_environment, roscore

STRANGERS = sorted((ROOT / 'test' / 'packages').iterdir())

# Tests that a shell runs in its background would ignore Ctrl-C, and so would all that they start.
signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(scope='session')
def environment():
    """An environment without other workspaces, in which a roscore runs."""
    environment = clean_environment()
    with roscore(environment):
        yield environment


@pytest.fixture(scope='session')
def workspace(tmp_path_factory, environment):
    """The workspace that ./rumba builds: this repository's packages and lessons; installed into an empty folder."""
    with once(tmp_path_factory, 'installed') as (_, is_first):
        if is_first:
            shutil.rmtree(WS / 'install', ignore_errors=True)
            if not (WS / 'lessons').exists():  # otherwise ./rumba test has just built it
                subprocess.run([str(ROOT / 'rumba'), 'build'], check=True, timeout=BUILD_TIMEOUT)
            # What `make install` does last: the rest is built, and other tests use the folder at the same time.
            Space(UNDERLAY, environment).run(f'cmake -P {WS}/build/cmake_install.cmake', BUILD_TIMEOUT)
    return Workspace(WS, [], environment)


@pytest.fixture(scope='session')
def beside(tmp_path_factory, environment):
    """A stranger's packages and the package of messages that they use side by side, built from nothing."""
    packages = [ROOT / 'rumba_msg', *(path for path in STRANGERS if path.name.startswith('battery_'))]
    return built(tmp_path_factory, 'beside', lambda path: Workspace(path, packages, environment))


@pytest.fixture(scope='session')
def overlay(tmp_path_factory, environment, workspace):
    """A stranger's packages alone, built from nothing over the install space of this repository's."""
    return built(tmp_path_factory, 'overlay',
                 lambda path: Workspace(path, STRANGERS, environment, workspace.setup('install')))


def built(tmp_path_factory, name, workspace_at):
    """A workspace with its install space, built by the first that wants it."""
    with once(tmp_path_factory, name) as (path, is_first):
        workspace = workspace_at(path)
        if is_first:
            workspace.make('install')  # after it has built all
    return workspace


@contextlib.contextmanager
def once(tmp_path_factory, name):
    """A folder that all processes of pytest share, and whether this is the first that makes it; the others wait."""
    base = tmp_path_factory.getbasetemp()
    shared = base.parent if 'PYTEST_XDIST_WORKER' in os.environ else base
    made = shared / f'{name}_is_made'
    with open(shared / f'{name}.lock', 'w') as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield shared / name, not made.exists()
        made.touch()
