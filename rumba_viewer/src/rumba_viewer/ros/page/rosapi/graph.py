"""What the master knows, looked at once a second while there are clients."""

import threading
import time
from typing import Callable, Dict, List, NamedTuple

import rosgraph
import rospy

from rumba_sim.ros.running.peers import NO_ANSWER
from rumba_viewer.ros.page.rosapi.clock import Clock

PERIOD = 1.0  # [s] between two looks
USE_SIM_TIME = '/use_sim_time'


class Known(NamedTuple):
    """What the master knows.

    Attributes:
        is_there: whether it answers.
        types: of the topics that some node publishes, or another node subscribes to; '*': not known yet.
        publishers, subscribers, services: names of nodes by the name of a topic or service.
    """

    is_there: bool = False
    types: Dict[str, str] = {}
    publishers: Dict[str, List[str]] = {}
    subscribers: Dict[str, List[str]] = {}
    services: Dict[str, List[str]] = {}


def look() -> Known:
    """Ask the master; blocks until it answers."""
    own, master = rospy.get_name(), rosgraph.Master(rospy.get_name())
    try:
        types = dict(master.getTopicTypes())  # also of topics that are gone
        publishers, subscribers, services = [dict(one) for one in master.getSystemState()]
    except NO_ANSWER:  # it ended during a call
        return Known()
    live = set(publishers) | {name for name, nodes in subscribers.items() if set(nodes) - {own}}
    return Known(True, {name: types.get(name, '*') for name in live}, publishers, subscribers, services)


class Graph:
    """The newest look at the master; also tells a clock whether time is simulated."""

    def __init__(self, has_clients: Callable[[], bool], clock: Clock) -> None:
        """Look once, and while there are clients."""
        self._has_clients, self._clock = has_clients, clock
        self._look()
        self._look_at_time()

    def fresh(self) -> Known:
        """What the master knows now, or a moment ago; blocks if it must be asked, as after a time without clients."""
        if time.monotonic() > self._looked + 2 * PERIOD:
            self._look()
        return self.known

    def start(self) -> None:
        """Look again and again, in a thread of its own."""
        threading.Thread(target=self._look_around, daemon=True).start()

    def _look_around(self) -> None:
        while not rospy.is_shutdown():
            time.sleep(PERIOD)
            self._look_at_time()
            if self._has_clients():
                self._look()

    def _look(self) -> None:
        self.known, self._looked = look(), time.monotonic()

    def _look_at_time(self) -> None:
        try:
            self._clock.follow(rosgraph.Master(rospy.get_name()).getParam(USE_SIM_TIME) is True)
        except rosgraph.MasterError:  # it is not set
            self._clock.follow(False)
        except NO_ANSWER:
            pass
