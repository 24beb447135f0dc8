"""A simulator saves its world when it ends, at whatever moment that is."""

import types

import pytest
import rospy

from rumba_sim.ros.simulator import simulator


@pytest.fixture
def ending(monkeypatch):
    """A simulator without ROS, a topic of which is closed while it publishes, and what it has saved."""
    saved = []
    found = object.__new__(simulator.Simulator)
    found._world, found._ticks, found._is_paused, found._lockstep = 'the world', 7, False, None
    found._file = types.SimpleNamespace(save=lambda world, ticks: saved.append((world, ticks)))

    def tick():
        raise rospy.ROSException('publish() to a closed topic')
    found._tick = tick
    monkeypatch.setattr(simulator, 'wake_on_time', lambda: None)
    monkeypatch.setattr(simulator.gc, 'freeze', lambda: None)
    monkeypatch.setattr(rospy, 'is_shutdown', lambda: False)
    return found, saved


def test_a_topic_that_is_closed_while_it_publishes_does_not_keep_it_from_saving(ending, monkeypatch):
    found, saved = ending
    monkeypatch.setattr(rospy.core, 'is_shutdown_requested', lambda: True)
    found.run()
    assert saved == [('the world', 7)]


def test_an_error_of_its_own_is_told_and_nothing_is_saved(ending, monkeypatch):
    found, saved = ending
    monkeypatch.setattr(rospy.core, 'is_shutdown_requested', lambda: False)
    with pytest.raises(rospy.ROSException):
        found.run()
    assert saved == []
