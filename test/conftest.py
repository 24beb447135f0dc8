"""Workspaces that the tests share, each built from nothing once."""

import contextlib
import fcntl
import os
import signal

import pytest
from workspaces import OURS, ROOT, STAND_INS, TUTORIALS, Workspace, clean_environment, roscore

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
    """This repository's packages, its lessons, and a stranger's side by side, built from nothing, then installed."""
    packages = OURS + STAND_INS + TUTORIALS + STRANGERS
    with once(tmp_path_factory, 'side_by_side') as (path, is_first):
        workspace = Workspace(path, packages, environment)
        if is_first:
            workspace.make()
            workspace.make('install')
    return workspace


@pytest.fixture(scope='session')
def overlay(tmp_path_factory, environment):
    """A stranger's packages alone, built from nothing over the install space of this repository's."""
    with once(tmp_path_factory, 'overlay') as (path, is_first):
        below = Workspace(path / 'below', OURS + STAND_INS, environment)
        overlay = Workspace(path / 'above', STRANGERS, environment, below.setup('install'))
        if is_first:
            below.make('install')
            overlay.make()
            overlay.make('install')
    return overlay


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
