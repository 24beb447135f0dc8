"""Publishers of the topics that clients have advertised. One serves all clients of a topic."""

import concurrent.futures
import struct
import time
from typing import Any, Callable, Dict, List, Optional, Set

import rosgraph
import rospy

from rumba_viewer.page.messages.errors import Refusal
from rumba_viewer.ros.page.rosapi import types

QUEUE = 20  # messages that wait for a subscriber that is slow; of more, the oldest are dropped
PATIENCE = 1.0  # [s] for which a new publisher waits for the subscribers that the master knows
LINGER = 2.0  # [s] for which a publisher without clients stays: what they sent at last is still under way
LOOK = 0.02  # [s] between two looks whether they are connected
MOST_PENDING = 20  # messages that wait for that
SEQUENCE = struct.Struct('<I')  # the number of a message, with which its header begins


class Outlet:
    """A topic that clients publish to.

    Attributes:
        kind: type of its messages.
        clients: who publishes.
        uses: how often a client has begun to publish.
        publisher: None until the master knows of it.
        pending: messages that came before that, and before subscribers were connected.
    """

    def __init__(self, kind: str, make: Any) -> None:
        """Publish messages that `make` makes."""
        self.kind, self.make = kind, make
        self.clients: Set[Any] = set()
        self.uses = 0
        self.publisher: Any = None
        self.pending: Optional[List[bytes]] = []
        self.is_closed = False
        self._number = 0  # of the newest message

    def publish(self, data: bytes) -> None:
        """Publish a serialised message, as soon as that is possible."""
        if self.pending is not None:
            self.pending.append(data)
            del self.pending[:-MOST_PENDING]
        else:
            self._send(data)

    def release(self) -> None:
        """Publish what has waited."""
        pending, self.pending = self.pending or [], None
        for data in pending:
            self._send(data)

    def _send(self, data: bytes) -> None:
        """Hand rospy bytes that need no more work; as it does, count the messages that begin with a header."""
        self._number += 1
        message = rospy.AnyMsg()
        message._buff = SEQUENCE.pack(self._number) + data[SEQUENCE.size:] if self.make._has_header else data
        self.publisher.publish(message)


class Talking:
    """Publishes for clients. Its methods are called in the thread of the loop, and never block."""

    def __init__(self, later: Callable[..., Any]) -> None:
        """Call functions in the loop `later`, after a time [s]."""
        self._later = later
        self._outlets: Dict[str, Outlet] = {}
        self._executor = concurrent.futures.ThreadPoolExecutor(1)  # for what waits for the master

    def advertise(self, client: Any, topic: str, kind: str, latch: bool) -> None:
        """Prepare to publish on a topic.

        Raises:
            Refusal: the type is not installed, or another client publishes another type there.
        """
        outlet = self._outlets.get(topic)
        if outlet is not None and not outlet.clients and outlet.kind != kind:
            self._close(topic, outlet)
            outlet = None
        if outlet is None:
            make = types.of_message(kind)
            if make is None:
                raise Refusal(f'{topic}: the type {kind} is not installed here')
            outlet = self._outlets[topic] = Outlet(kind, make)
            self._open(topic, outlet, latch)
        if outlet.kind != kind:
            raise Refusal(f'{topic} has the type {outlet.kind} and not {kind}')
        outlet.clients.add(client)
        outlet.uses += 1

    def unadvertise(self, client: Any, topic: str) -> None:
        """A client no longer publishes; soon after the last one, the publisher is taken back."""
        outlet = self._outlets.get(topic)
        if outlet is not None:
            left, uses = outlet, outlet.uses
            outlet.clients.discard(client)
            if not outlet.clients:
                self._later(LINGER, lambda: self._end(topic, left, uses))

    def _end(self, topic: str, outlet: Outlet, uses: int) -> None:
        """Take a publisher back, unless a client has begun to publish again."""
        if outlet.uses == uses:
            self._close(topic, outlet)

    def _close(self, topic: str, outlet: Outlet) -> None:
        if not outlet.is_closed:
            del self._outlets[topic]
            outlet.is_closed = True
            self._submit(self._take_back, outlet)

    def kinds(self) -> Dict[str, str]:
        """The types of all topics that clients have advertised; in any thread."""
        return {topic: outlet.kind for topic, outlet in list(self._outlets.items()) if outlet.clients}

    def outlet(self, topic: str) -> Outlet:
        """The outlet of a topic that was advertised."""
        return self._outlets[topic]

    def close(self) -> None:
        """Begin nothing more."""
        self._executor.shutdown(wait=False)

    def _submit(self, act: Callable[..., Any], *arguments: Any) -> Any:
        try:
            return self._executor.submit(act, *arguments)
        except RuntimeError:  # closed
            return None

    @staticmethod
    def _take_back(outlet: Outlet) -> None:
        if outlet.publisher is not None:
            outlet.publisher.unregister()

    def _open(self, topic: str, outlet: Outlet, latch: bool) -> None:
        future = self._submit(self._register, topic, outlet, latch)
        if future is not None:
            future.add_done_callback(lambda found: self._later(0.0, lambda: self._on_registered(
                topic, outlet, latch, None if found.exception() else found.result())))

    @staticmethod
    def _register(topic: str, outlet: Outlet, latch: bool) -> int:
        """Register at the master; returns how many nodes subscribe to the topic."""
        if outlet.publisher is None:
            outlet.publisher = rospy.Publisher(topic, outlet.make, queue_size=QUEUE, latch=latch, tcp_nodelay=True)
        subscribed = rosgraph.Master(rospy.get_name()).getSystemState()[1]
        return sum(len(nodes) for name, nodes in subscribed if name == topic)

    def _on_registered(self, topic: str, outlet: Outlet, latch: bool, subscribers: Optional[int]) -> None:
        if outlet.is_closed or rospy.is_shutdown():
            return
        if subscribers is None:  # the master did not answer
            self._later(PATIENCE, lambda: self._open(topic, outlet, latch))
        else:
            self._await(outlet, subscribers, time.monotonic() + PATIENCE)

    def _await(self, outlet: Outlet, subscribers: int, end: float) -> None:
        """Publish as soon as all subscribers are connected, or after a while."""
        if outlet.is_closed:
            return
        if outlet.publisher.get_num_connections() >= subscribers or time.monotonic() > end:
            outlet.release()
        else:
            self._later(LOOK, lambda: self._await(outlet, subscribers, end))
