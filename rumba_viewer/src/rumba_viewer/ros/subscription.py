"""A topic that is read: values instead of messages, and a warning instead of an error if a message makes no sense."""

import time
from typing import Any, Callable, Generic, Type, TypeVar

import rospy

from rumba_viewer.ros.readings import OddMessage

WARNING_PERIOD = 10.0  # [s] of the wall clock between two warnings about a topic
Value = TypeVar('Value')


class Subscription(Generic[Value]):
    """Subscribes to a topic, and passes on what is read of each message, in a thread of rospy."""

    def __init__(self, topic: str, kind: Type[Any], read: Callable[[Any], Value], take: Callable[[Value], Any],
                 queue_size: int = 1) -> None:
        """Begin to listen.

        Args:
            topic: its name.
            kind: class of its messages.
            read: makes a value of a message, or raises OddMessage.
            take: is called with each value.
            queue_size: how many messages wait at most.
        """
        self._topic, self._read, self._take = topic, read, take
        self._warned: float = -WARNING_PERIOD
        self._subscriber = rospy.Subscriber(topic, kind, self._on_message, queue_size=queue_size)

    def _on_message(self, message: Any) -> None:
        try:
            value = self._read(message)
        except OddMessage as error:
            self._warn(str(error))
        else:
            self._take(value)

    def _warn(self, what: str) -> None:
        now = time.monotonic()
        if now - self._warned >= WARNING_PERIOD:
            self._warned = now
            rospy.logwarn(f'{self._topic}: a message is ignored: {what}')

    @property
    def is_connected(self) -> bool:
        """Whether a node publishes the topic."""
        impl = self._subscriber.impl  # None if another thread has unregistered it
        return impl is not None and impl.get_num_connections() > 0

    def close(self) -> None:
        """Stop listening; a message that is read at this moment is still passed on."""
        self._subscriber.unregister()
