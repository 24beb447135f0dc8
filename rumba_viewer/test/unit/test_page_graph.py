"""What the page knows of the master, without one."""

import pytest

pytest.importorskip('rospy', reason='needs ROS')

from rumba_viewer.ros.page.rosapi import graph  # noqa: E402
from rumba_viewer.ros.page.rosapi.graph import PERIOD, Graph, Known  # noqa: E402


def test_the_first_client_after_a_while_hears_of_what_is_there_now(monkeypatch):
    now, there = [100.0], ['/old']
    monkeypatch.setattr(graph.time, 'monotonic', lambda: now[0])
    monkeypatch.setattr(graph, 'look', lambda: Known(True, dict.fromkeys(there, 'a/B')))
    monkeypatch.setattr(Graph, '_look_at_time', lambda _: None)
    looked = Graph(lambda: False, None)
    there[:] = ['/new']
    now[0] += PERIOD
    assert list(looked.fresh().types) == ['/old']
    now[0] += 1.5 * PERIOD
    assert list(looked.fresh().types) == list(looked.known.types) == ['/new']
