"""Connections of publishers that send at once, in the thread that publishes.

rospy hands each message to a thread of its connection, and gives the processor away for it: where a node publishes
hundreds of small messages in a second, that takes longer than all the rest. And the system keeps a small message back
until an earlier one is acknowledged, for up to 40 ms: seconds of simulated time.
"""

import contextlib
import socket
from typing import Any, List, Optional

from rospy import topics
from rospy.impl.tcpros_pubsub import QueuedConnection


def use() -> None:
    """Have the publishers of this node use these connections."""
    setattr(topics, 'QueuedConnection', PromptConnection)


class PromptConnection(QueuedConnection):
    """Sends a message at once as far as the socket takes it; what it does not take waits, as in a QueuedConnection.

    So a subscriber that does not read loses the oldest messages of its queue, and nobody waits for it.
    """

    _queue: List[bytes]  # what waits behind that
    _error: Optional[Exception]

    def __init__(self, connection: Any, queue_size: int) -> None:
        """Wrap a connection; `queue_size` messages may wait, 0: any number."""
        self._begun = b''  # the rest of a message of which a part was sent
        self._is_relaying = False
        with contextlib.suppress(OSError, AttributeError):  # it was closed already
            connection.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        super().__init__(connection, queue_size)

    def write_data(self, data: bytes) -> bool:
        """Send a message, or have it wait.

        Raises:
            Exception: what happened to a message that had to wait.
        """
        with self._lock:
            error, self._error = self._error, None
            if error is not None:
                raise error
            if self._is_relaying or self._queue or self._begun:
                if 0 < self._queue_size <= len(self._queue):
                    del self._queue[0]
                self._queue.append(data)
            else:
                self._begun = data[self._send(data):]
            if self._begun or self._queue:
                self._cond_data_available.notify()
        return True

    def _send(self, data: bytes) -> int:
        """Send as much as the socket takes; returns how many bytes that are."""
        connection, sent = self._connection, 0
        if connection.socket is not None and not connection.done:
            with contextlib.suppress(OSError):  # the thread will get the same error
                sent = connection.socket.send(data, socket.MSG_DONTWAIT)
                connection.stat_bytes += sent
                connection.stat_num_msg += sent == len(data)
        return sent

    def _run(self) -> None:
        """Send what waits, in a thread of this connection."""
        while not self._connection.done:
            with self._lock:
                self._is_relaying = False
                while not (self._begun or self._queue or self._connection.done):
                    self._cond_data_available.wait()
                waiting = [self._begun, *self._queue] if self._begun else self._queue
                self._begun, self._queue, self._is_relaying = b'', [], True
            for data in waiting:
                try:
                    self._connection.write_data(data)
                except Exception as error:  # the next publisher gets it, as in rospy, but not one that follows from it
                    with self._lock:
                        self._error = error
                    break
