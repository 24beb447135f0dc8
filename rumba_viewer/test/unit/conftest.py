"""The same examples in every run, on a machine of any speed, and nothing written beside the tests."""

import signal

import hypothesis
import pytest

hypothesis.settings.register_profile('rumba', derandomize=True, database=None, deadline=None)
hypothesis.settings.load_profile('rumba')

# Tests that a shell runs in its background would ignore Ctrl-C, and so would all that they start.
signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture
def opened():
    """A window that shows one robot."""
    from windows import Opened, robot, snapshot  # Qt is for those who ask for it
    opened = Opened(snapshot(robot()))
    yield opened
    opened.window.close()
