"""Topics whose messages one thread takes, whichever of them comes.

rospy has a thread for each connection. When a simulator tells all that a robot senses at once, in as many messages as
there are sensors, as many threads wake up and wait for one another. That takes longer than what they do.
"""

import contextlib
import select
import threading
from typing import Any, Callable, Dict, List, Optional, Set

from rospy.core import is_shutdown
from rospy.exceptions import TransportException, TransportTerminated
from rospy.impl import tcpros_pubsub
from rospy.impl.tcpros_base import TCPROSTransport, recv_buff

LENGTH = 4  # [bytes] before each message

_shared: Set[str] = set()  # full names of topics


def use() -> None:
    """Have the subscribers of this node use these connections."""
    setattr(tcpros_pubsub, 'TCPROSTransport', SharedConnection)


def share(*topics: str) -> None:
    """Have one thread take the messages of topics, given by their full names, to which this node subscribes later.

    None of their callbacks may wait for anything that comes by one of these topics, nor take long.
    """
    _shared.update(topics)


class Reception:
    """The thread."""

    def __init__(self) -> None:
        """Do nothing yet."""
        self._lock = threading.Lock()
        self._ready: Optional[select.epoll] = None  # it is made with the thread, for the first connection
        self._connections: Dict[int, 'SharedConnection'] = {}  # by their file descriptors

    def add(self, connection: 'SharedConnection') -> None:
        """Take what comes by a connection until it fails, or `remove`.

        Raises:
            AttributeError, OSError, ValueError: it is closed.
        """
        with self._lock:
            connection.socket.setblocking(False)  # what came may have been taken already, when a descriptor was reused
            number = connection.socket.fileno()
            if self._ready is None:
                self._ready = select.epoll()
                threading.Thread(target=self._run, args=[self._ready], daemon=True).start()
            self._ready.register(number, select.EPOLLIN)
            self._connections[number] = connection

    def remove(self, connection: 'SharedConnection') -> None:
        """Take no more from a connection."""
        with self._lock:
            for number in [number for number, known in self._connections.items() if known is connection]:
                del self._connections[number]
                if self._ready is not None:
                    with contextlib.suppress(OSError, ValueError):  # it is closed, and so not there any more
                        self._ready.unregister(number)

    def _run(self, ready: select.epoll) -> None:
        while True:
            for number, _ in ready.poll():
                connection = self._connections.get(number)
                if connection is not None:
                    connection.take()


_reception = Reception()


class SharedConnection(TCPROSTransport):
    """A connection whose own thread only opens it, and waits for its end, if its topic is shared."""

    def __init__(self, *arguments: Any, **named: Any) -> None:
        """As TCPROSTransport."""
        super().__init__(*arguments, **named)
        self._has_ended = threading.Event()
        self._error: Optional[BaseException] = None
        self._tell: Callable[[List[Any], Any], None] = lambda messages, connection: None

    def receive_loop(self, msgs_callback: Callable[[List[Any], Any], None]) -> None:
        """Have messages told to a function until the connection is closed."""
        self._tell = msgs_callback
        super().receive_loop(msgs_callback)

    def receive_once(self) -> List[Any]:
        """Wait for messages; of a shared topic, for what came with the header, and then for the end of the connection.

        Raises:
            TransportException: the connection is of no use any more.
        """
        if self.name not in _shared:
            found: List[Any] = super().receive_once()
            return found
        found = self._unpacked()
        if found:
            return found
        self._has_ended.clear()
        try:
            _reception.add(self)
        except (AttributeError, OSError, ValueError) as error:
            raise TransportTerminated(str(error)) from None
        if not self.done:
            self._has_ended.wait()
        failure, self._error = self._error, None
        if failure is not None:
            raise failure if isinstance(failure, TransportException) else TransportException(f'{self.name}: {failure}')
        return []

    def take(self) -> None:
        """Tell the messages that have come; after an error, the thread of this connection goes on with that."""
        try:
            self.stat_bytes += recv_buff(self.socket, self.read_buff, self.protocol.buff_size)
            messages = self._unpacked()
            if messages and not is_shutdown():
                self._tell(messages, self)
        except BaseException as error:  # the other topics must go on
            _reception.remove(self)
            self._error = error
            self._has_ended.set()

    def _unpacked(self) -> List[Any]:
        """The messages of which all was read.

        Raises:
            Exception: what was read is no message, or the connection is closed.
        """
        messages: List[Any] = []
        if self.read_buff.tell() >= LENGTH:
            self.protocol.read_messages(self.read_buff, messages, self.socket)
            self.stat_num_msg += len(messages)
        for message in messages:
            message._connection_header = self.header
        if self.is_latched and messages:
            self.latch = messages[-1]
        return messages

    def close(self) -> None:
        """Close it, and end its thread."""
        _reception.remove(self)
        super().close()
        self._has_ended.set()
