"""News of publishers, of which a node forgets none.

When a node subscribes, the master answers with the publishers that there are, and from then on calls the node when
there are others. On a busy machine rospy may hear of a new one before it has read that answer, takes the answer for the
newer news, and forgets the other: the subscriber never connects to it, and a client of an action may wait for ever.
"""

from typing import Any, List

from rospy.impl.registration import RegManager


def use() -> None:
    """Have this node connect to the publishers of all news that it has not looked at yet."""
    setattr(RegManager, 'publisher_update', _update)


def _update(manager: Any, topic: str, publishers: List[str]) -> None:
    """Note news of a topic; to connect to a publisher that has ended does no harm."""
    with manager.cond:
        older = [publisher for name, known in manager.updates if name == topic for publisher in known]
        manager.updates.append((topic, list(dict.fromkeys([*older, *publishers]))))
        manager.cond.notify_all()
