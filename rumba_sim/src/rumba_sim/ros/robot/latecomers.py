"""What a new subscriber of a topic is sent at once."""

import contextlib
from typing import Any, Callable

import rospy

from rumba_sim.ros.participants.requests import Requests


class Latecomers(rospy.SubscribeListener):
    """Sends a message to each new subscriber, as a latched topic does, but as it is at that time."""

    def __init__(self, requests: Requests, message: Callable[[], Any],
                 newest: Callable[[], Any] = lambda: None) -> None:
        """Have the owner of `requests` make each message.

        Args:
            requests: to the owner of the world.
            message: makes the message; None: nothing is sent.
            newest: tells apart what is published: nothing is sent if something was published since the subscriber came,
                for then it has that already.
        """
        self._requests = requests
        self._message = message
        self._newest = newest

    def peer_subscribe(self, topic_name: str, topic_publish: Any, peer_publish: Callable[[Any], None]) -> None:
        """There is a new subscriber."""
        newest = self._newest()

        def send() -> None:
            message = self._message() if self._newest() is newest else None
            if message is not None:
                with contextlib.suppress(rospy.ROSException):  # the topic was closed meanwhile
                    peer_publish(message)
        self._requests.post(send)
