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


@pytest.fixture
def topics(monkeypatch):
    """All topics that are opened, by name; rospy opens fake ones."""
    import rospy  # other tests work without ROS
    from fake_topics import Topic
    monkeypatch.setattr(Topic, 'opened', {})
    for name in ('Subscriber', 'Publisher'):
        monkeypatch.setattr(rospy, name, Topic)
    return Topic.opened
