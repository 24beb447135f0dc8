"""A node connects to each publisher that it hears of, in whatever order the news come."""

import threading

import pytest
from rospy.impl.registration import RegManager

from rumba_sim.ros.running import publisher_updates

TOPIC, OTHER = '/rumba/dock/cancel', '/rumba/dock/goal'
PATIENCE = 30.0  # [s]


class Handler:
    """Of the news of a node: it notes the connections that are wanted, and ends after the last."""

    done = False

    def __init__(self, count):
        self.wanted, self.news, self._count = [], threading.Condition(), count

    def _connect_topic(self, topic, publisher):
        with self.news:
            self.wanted.append((topic, publisher))
            self.done = len(self.wanted) >= self._count
            self.news.notify_all()
        return 1, '', 0


@pytest.mark.parametrize('updates', [
    [(TOPIC, ['new']), (TOPIC, [])], [(TOPIC, []), (TOPIC, ['new'])], [(TOPIC, ['old', 'new']), (TOPIC, ['old'])],
    [(TOPIC, ['new']), (OTHER, ['new']), (TOPIC, [])]], ids=['late answer', 'usual', 'one of two', 'two topics'])
def test_no_publisher_is_forgotten(monkeypatch, updates):
    monkeypatch.setattr(RegManager, 'publisher_update', RegManager.publisher_update)  # puts it back
    publisher_updates.use()
    wanted = {(topic, publisher) for topic, publishers in updates for publisher in publishers}
    handler = Handler(len(wanted))
    manager = RegManager(handler)
    for update in updates:
        manager.publisher_update(*update)
    threading.Thread(target=manager.run, daemon=True).start()
    with handler.news:
        assert handler.news.wait_for(lambda: handler.done, PATIENCE), f'{handler.wanted} of {wanted}'
    assert sorted(handler.wanted) == sorted(wanted)
