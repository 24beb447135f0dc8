"""What came for a control tick of a world in lockstep, in an order that does not depend on the machine."""

from typing import Any, Dict, List, Sequence, Tuple

NEVER = -1.0


class TickReadings:
    """Keeps what comes until everything is there that was sent for a tick."""

    def __init__(self, order: Sequence[str]) -> None:
        """Nothing has come yet; `order` is that in which the topics of a tick count; others follow, by their names."""
        self._order = list(order)
        self._newest = dict.fromkeys(order, NEVER)
        self._pending: List[Tuple[str, Any]] = []
        self._due: Dict[str, float] = {}

    def take(self, topic: str, stamp: float, reading: Any) -> None:
        """Something came on a topic; `stamp` [s] is 0 if it has none."""
        self._newest[topic] = stamp
        self._pending.append((topic, reading))

    def expect(self, due: Dict[str, float]) -> None:
        """A tick was sent, and with it or before it messages with these stamps [s], by their topics.

        A topic that is not in the order does not count before something has come on it.
        """
        self._due = {topic: stamp for topic, stamp in due.items() if topic in self._newest}

    @property
    def missing(self) -> List[str]:
        """Topics whose message for the tick has not come."""
        return [topic for topic, stamp in self._due.items() if self._newest.get(topic, NEVER) < stamp]

    def release(self) -> List[Tuple[str, Any]]:
        """Everything that has come, as topic and reading, in the order in which it counts."""
        rank = {topic: number for number, topic in enumerate(self._order)}
        pending = sorted(self._pending, key=lambda each: (rank.get(each[0], len(rank)), each[0]))
        self._pending.clear()
        return pending
