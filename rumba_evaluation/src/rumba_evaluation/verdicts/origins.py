"""Who publishes what a run is judged by: a run counts only if that is the node of the robot, and nobody else.

Otherwise the node that is marked could publish its own coverage.
"""

from typing import Dict, Iterable, List, Sequence, Set

CLOCK = '/clock'
STATE = 'simulator/state'


class Origins:
    """The publishers of the topics of a run, by the messages that came and by what the master tells.

    Attributes:
        is_complete: whether it is known who must publish all that was published.
    """

    def __init__(self, measured: Sequence[str], state: str, publisher: str) -> None:
        """Nobody has published yet.

        Args:
            measured: topics that only the node of the robot may publish.
            state: the topic on which the node of the robot names itself.
            publisher: full name of that node; empty: the one that `state` names.
        """
        self._measured, self._state, self._publisher = measured, state, publisher
        self._named: List[str] = []
        self._publishers: Dict[str, Set[str]] = {topic: set() for topic in (*measured, state, CLOCK)}

    def watch(self, topic: str) -> None:
        """Judge by one more topic, which any nodes may publish, unless the node of the robot is one of them."""
        self._publishers.setdefault(topic, set())

    def names(self, node: str) -> None:
        """A message of `state` names the node of the robot."""
        if node not in self._named:
            self._named.append(node)

    def publishes(self, topic: str, node: str) -> None:
        """A node publishes a topic; topics by which the run is not judged are ignored."""
        if topic in self._publishers:
            self._publishers[topic].add(node)

    @property
    def is_complete(self) -> bool:
        """Whether the node of the robot is known, or does not matter because nobody publishes what it measures."""
        return bool(self._publisher or self._named) or not any(self._publishers[topic] for topic in self._measured)

    @property
    def owners(self) -> List[str]:
        """Full names of the nodes of the robot, as far as they are known."""
        return [self._publisher] if self._publisher else list(self._named)

    @property
    def has_state(self) -> bool:
        """Whether some node publishes the state, so that a message of it comes, or has come."""
        return bool(self._publishers[self._state])

    def problem(self) -> str:
        """Why the run does not count, in words; empty if nothing is wrong so far, whether complete or not."""
        if len(self._publishers[CLOCK]) > 1:
            return f'{CLOCK} is published by {_listed(self._publishers[CLOCK])}: one node alone may do that'
        if self._publisher:
            return self._intruder(self._publisher)
        if len(self._named) > 1:
            return f'{self._state} names {_listed(self._named)}: it must name one node'
        if self._named:
            return self._intruder(self._named[0])
        return ''

    def unknown(self) -> str:
        """Why a run does not count that has ended before it was complete, in words."""
        topic = next(topic for topic in self._measured if self._publishers[topic])
        return (f'{topic} is published by {_listed(self._publishers[topic])}, but no node publishes {self._state}: '
                'start the simulator, or name the node that may publish by the parameter publisher')

    def _intruder(self, owner: str) -> str:
        """In words, which node publishes what only the owner may publish."""
        for topic, nodes in self._publishers.items():
            is_owned = topic in self._measured or owner in nodes or topic == self._state and not self._publisher
            if is_owned and nodes - {owner}:
                return f'{topic} is published by {_listed(nodes - {owner})}: {owner} alone may do that'
        return ''


def _listed(names: Iterable[str]) -> str:
    return ' and '.join(sorted(names))
