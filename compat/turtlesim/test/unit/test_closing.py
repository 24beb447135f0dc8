"""Turtles go without a delay for others, and their names are free when they are needed again."""

import threading
import weakref

import pytest

from turtlesim.ros import turtlesim_node

TIMEOUT = 30.0


class Topics:
    """The topics of a turtle, which cannot be closed before `may_close` is set."""

    def __init__(self, may_close, closed):
        self._itself = self  # as in rospy: only a collection of garbage frees them
        self._may_close = may_close
        self._closed = closed

    def close(self):
        """Wait, then note it."""
        assert self._may_close.wait(TIMEOUT)
        self._closed.append(weakref.ref(self))


class Requests:
    """The loop, at once."""

    def call(self, function):
        """Call a function."""
        return function()


@pytest.fixture
def node(monkeypatch):
    """A node with 40 turtles beside turtle1, without a master."""
    monkeypatch.setattr(turtlesim_node, 'read_background', lambda: (1, 2, 3))
    monkeypatch.setattr(turtlesim_node.rospy, 'loginfo', lambda _: None)
    node = turtlesim_node.Turtlesim.__new__(turtlesim_node.Turtlesim)
    node.may_close, node.closed = threading.Event(), []
    node._field, node._requests = turtlesim_node.Field((1, 2, 3)), Requests()
    for _ in range(40):
        node._field.spawn('', 1.0, 1.0, 0.0)
    node._outputs, node._inputs = ({name: Topics(node.may_close, node.closed) for name in node._field.names}
                                   for _ in range(2))
    node._broadcaster = turtlesim_node.Broadcaster(node._field, node._outputs)
    node._changing, node._closing = threading.Lock(), threading.Thread()
    node._closing.start()
    yield node
    node.may_close.set()


def test_a_reset_is_answered_before_the_topics_of_40_turtles_are_closed(node):
    node._on_reset(None)
    assert list(node._outputs) == list(node._inputs) == node._field.names == ['turtle1']
    assert not node.closed


def test_the_next_change_waits_until_they_are(node):
    node._on_reset(None)
    threading.Timer(0.1, node.may_close.set).start()
    with node._change():
        assert len(node.closed) == 80


def test_nothing_is_left_of_topics_that_are_closed(node):
    node._on_reset(None)
    node.may_close.set()
    node._closing.join(TIMEOUT)
    assert [each() for each in node.closed] == [None] * 80
