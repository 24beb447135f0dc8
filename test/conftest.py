"""Workspaces that the tests share: that of ./rumba, and one of strangers over it, built from nothing once."""

import contextlib
import fcntl
import os
import shutil
import signal
import subprocess

import pytest
from workspaces import BUILD_TIMEOUT, ROOT, SPEED_GUARD, UNDERLAY, WS, Space, Workspace, clean_environment, master

STRANGERS = sorted((ROOT / 'test' / 'packages').iterdir())
LESSON = [*sorted((ROOT / 'test' / 'lesson').iterdir()),
          *(path for path in STRANGERS if path.name.startswith('battery_'))]

# Tests that a shell runs in its background would ignore Ctrl-C, and so would all that they start.
signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(scope='session')
def environment():
    """An environment without other workspaces, in which a master runs."""
    environment = clean_environment()
    with master(environment):
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
def overlay(tmp_path_factory, environment, workspace):
    """A stranger's packages, and that of the lessons with a library below it, built over our install space."""
    with once(tmp_path_factory, 'overlay') as (path, is_first):
        overlay = Workspace(path, [*STRANGERS, SPEED_GUARD], environment,
                            [*UNDERLAY, workspace.setup('install')])
        if is_first:
            overlay.make('install')  # after it has built all
    return overlay


@pytest.fixture(scope='session')
def lesson(tmp_path_factory, environment, workspace):
    """A learner's packages, with a rumba_msg and a rumba_bringup of its own, built over our install space."""
    with once(tmp_path_factory, 'lesson') as (path, is_first):
        lesson = Workspace(path, LESSON, environment, [*UNDERLAY, workspace.setup('install')])
        if is_first:
            lesson.make()
    return lesson


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
