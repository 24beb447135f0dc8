"""Hypothesis: the same examples in every run, no time limit, no database beside the tests."""

import signal

import hypothesis
import pytest

hypothesis.settings.register_profile('rumba', derandomize=True, database=None, deadline=None)
hypothesis.settings.load_profile('rumba')

# A shell makes its background processes ignore Ctrl-C; these tests and their children must not.
signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture
def opened():
    """A window that shows one robot."""
    from windows import Opened, robot, snapshot  # other tests work without Qt
    opened = Opened(snapshot(robot()))
    yield opened
    opened.window.close()
