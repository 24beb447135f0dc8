"""What the master knows, looked at once a second while there are clients, and what `/rosapi` tells of it."""

import threading
import time
from typing import Any, Callable, Dict, FrozenSet, List, NamedTuple

import rosgraph
import rospy
import rosservice

from rumba_sim.ros.common.peers import NO_ANSWER
from rumba_viewer.page.allow_list import AllowList
from rumba_viewer.page.errors import Refusal

PERIOD = 1.0  # [s] between two looks


class Known(NamedTuple):
    """What the master knows.

    Attributes:
        is_there: whether it answers.
        types: of all topics, by name.
        published, services: names.
    """

    is_there: bool = False
    types: Dict[str, str] = {}
    published: FrozenSet[str] = frozenset()
    services: FrozenSet[str] = frozenset()


def look() -> Known:
    """Ask the master; blocks until it answers."""
    master = rosgraph.Master(rospy.get_name())
    try:
        types = dict(master.getTopicTypes())
        published, _, services = master.getSystemState()
    except NO_ANSWER:  # it ended during a call
        return Known()
    return Known(True, types, frozenset(name for name, _ in published), frozenset(name for name, _ in services))


class Graph:
    """The newest look at the master."""

    def __init__(self, allowed: AllowList, has_clients: Callable[[], bool]) -> None:
        """Tell clients of what they may reach."""
        self.known = look()
        self._allowed, self._has_clients = allowed, has_clients
        self._answers: Dict[str, Callable[[Any], Dict[str, Any]]] = {
            'topics': self._topics, 'topics_for_type': self._topics_for_type, 'topic_type': self._topic_type,
            'services': lambda _: {'services': self._services()}, 'service_type': self._service_type,
            'get_time': lambda _: {'time': now()}}

    def start(self) -> None:
        """Look again and again, in a thread of its own."""
        threading.Thread(target=self._look_around, daemon=True).start()

    def _look_around(self) -> None:
        while not rospy.is_shutdown():
            time.sleep(PERIOD)
            if self._has_clients():
                self.known = look()

    def api(self, name: str, values: Any) -> Any:
        """The answer of `/rosapi/NAME`; some take time, and are called in a thread.

        Raises:
            Refusal: there is no such service, or no master.
        """
        answer = self._answers.get(name)
        if answer is None:
            raise Refusal(f'there is no /rosapi/{name} here: there are ' + ', '.join(self._answers))
        if not self.known.is_there:
            raise Refusal(f'no roscore answers at {rosgraph.get_master_uri()}')
        return answer(values if isinstance(values, dict) else {})

    def _may(self, what: str, name: str) -> bool:
        try:
            self._allowed.robot(what, name)
        except Refusal:
            return False
        return True

    def _visible(self, what: Callable[[str], bool]) -> List[str]:
        return sorted(name for name in self.known.types if (self._may('read', name) or self._may('write', name))
                      and what(name))

    def _topics(self, _: Any) -> Dict[str, Any]:
        names = self._visible(lambda _: True)
        return {'topics': names, 'types': [self.known.types[name] for name in names]}

    def _topics_for_type(self, values: Any) -> Dict[str, Any]:
        kind = values.get('type')
        return {'topics': self._visible(lambda name: self.known.types[name] == kind and name in self.known.published)}

    def _topic_type(self, values: Any) -> Dict[str, Any]:
        name = values.get('topic')
        return {'type': self.known.types[name] if name in self._visible(lambda _: True) else ''}

    def _services(self) -> List[str]:
        return sorted(name for name in self.known.services if self._may('call', name))

    def _service_type(self, values: Any) -> Dict[str, Any]:
        name = values.get('service')
        return {'type': rosservice.get_service_type(name) or '' if name in self._services() else ''}


def now() -> Dict[str, int]:
    """The time of the wall clock."""
    stamp = rospy.Time.from_sec(time.time())
    return {'secs': stamp.secs, 'nsecs': stamp.nsecs}
