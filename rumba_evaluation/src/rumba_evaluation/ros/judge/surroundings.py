"""What the master tells of topics and nodes during a run."""

import contextlib
from typing import Any, Collection, Dict, List, Mapping, Set, Tuple

import roslib.message
import rosgraph
import rospy

from rumba_evaluation.verdicts.silence import Seen
from rumba_sim.ros.running import peers

RESERVED = '/reserved'  # below it are topics of nodes that have no name yet


class Surroundings:
    """Remembers all topics and nodes that there were."""

    def __init__(self) -> None:
        """There was nothing yet."""
        self._publishers: Dict[str, Set[str]] = {}
        self._nodes: Set[str] = set()
        self._present: Set[str] = set()

    def look(self) -> List[Tuple[str, List[str]]]:
        """The publishers of all topics that there are now; none if the master ends, or is busy."""
        try:
            state, *others = rosgraph.Master(rospy.get_name()).getSystemState()
        except (rosgraph.MasterException, OSError):
            return []
        publishers = [(topic, nodes) for topic, nodes in state if not topic.startswith(RESERVED)]
        for topic, nodes in publishers:
            self._publishers.setdefault(topic, set()).update(nodes)
        self._present = {node for each in (publishers, *others) for _, nodes in each for node in nodes}
        self._nodes |= self._present
        return publishers

    def seen(self, ours: Collection[str], heard: Collection[str], told: Mapping[str, str]) -> Seen:
        """All that there was.

        Args:
            ours: nodes of the world and the judge, and namespaces of robots.
            heard: topics of which messages came.
            told: types of topics of the world of which the master does not know.
        """
        types: Dict[str, str] = {}
        with contextlib.suppress(rosgraph.MasterException, OSError):
            types = dict(rosgraph.Master(rospy.get_name()).getTopicTypes())
        silent = {node for node in self._present - set(ours) if not peers.is_alive(node)}
        publishers = {topic: set(ours) for topic in told}
        return Seen({**publishers, **self._publishers}, {**told, **types}, self._nodes,
                    (self._nodes - self._present) | silent, [*ours, '/rosout'], heard)


def fields(kind: str) -> Dict[str, str]:
    """Types of the fields of a type; none if it is a plain one, or unknown here."""
    found: Any = None
    with contextlib.suppress(ValueError, ImportError):
        found = roslib.message.get_message_class(kind)
    return {} if found is None else dict(zip(found.__slots__, found._slot_types))
