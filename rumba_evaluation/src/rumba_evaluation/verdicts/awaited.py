"""The topics of the node that is marked: in lockstep, the judge awaits a message on each of them after each tick."""

from typing import Dict, Iterable, List, Set

START = 25.0  # [s] for a node that does not publish yet: a world waits 30 s for those who start
PATIENCE = 5.0  # [s] for a message, once there is a publisher: a busy machine may let a node wait for seconds
TRIES = 3  # ticks without an answer, after which a topic is awaited no longer
STEADY = 10  # ticks with an answer, one after the other, that bring back one of these


class Awaited:
    """Who has answered since the last tick; the caller supplies the time of the wall clock [s]."""

    def __init__(self, topics: Iterable[str]) -> None:
        """Nobody has answered yet."""
        self._tries = dict.fromkeys(topics, TRIES)
        self._steady = dict.fromkeys(self._tries, 0)  # ticks with an answer since the last one without
        self._published: Dict[str, float] = {}  # since when
        self._heard: Set[str] = set()

    def publishes(self, topic: str, now: float) -> None:
        """There is a publisher, whose messages come from now on."""
        self._published.setdefault(topic, now)

    def hear(self, topic: str) -> None:
        """A message came."""
        if topic in self.silent:
            self._steady[topic] += 1
            if self._steady[topic] % STEADY == 0:
                self._tries[topic] = min(self._tries[topic] + 1, TRIES)
        self._heard.add(topic)

    def begin(self) -> None:
        """The next tick is awaited."""
        self._heard.clear()

    @property
    def silent(self) -> List[str]:
        """Topics without an answer, that are still awaited."""
        return [topic for topic, tries in self._tries.items() if tries > 0 and topic not in self._heard]

    def give_up(self, tick: float, now: float) -> None:
        """Wait no longer in this tick, which came at a time, for those who had time enough."""
        for topic in self.silent:
            if topic in self._published:
                end = max(tick, self._published[topic]) + PATIENCE
            else:
                end = tick + START
            if now > end:
                self._heard.add(topic)
                self._steady[topic] = 0
                self._tries[topic] -= 1 if topic in self._published else TRIES
