"""Workspaces that the tests share, each built from nothing once."""

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
    workspace = Workspace(tmp_path_factory.mktemp('side_by_side') / 'ws', packages, environment)
    workspace.make()
    workspace.make('install')
    return workspace


@pytest.fixture(scope='session')
def overlay(tmp_path_factory, environment):
    """A stranger's packages alone, built from nothing over the install space of this repository's."""
    below = Workspace(tmp_path_factory.mktemp('below') / 'ws', OURS + STAND_INS, environment)
    below.make('install')
    overlay = Workspace(tmp_path_factory.mktemp('above') / 'ws', STRANGERS, environment, below.setup('install'))
    overlay.make()
    overlay.make('install')
    return overlay
