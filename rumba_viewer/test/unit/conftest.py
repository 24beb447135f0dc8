"""What the tests of the window share."""

import signal

import pytest

# A shell makes its background processes ignore Ctrl-C; these tests and their children must not.
signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture
def opened():
    """A window that shows one robot."""
    from windows import Opened, robot, snapshot  # other tests work without Qt
    opened = Opened(snapshot(robot()))
    yield opened
    opened.window.close()
