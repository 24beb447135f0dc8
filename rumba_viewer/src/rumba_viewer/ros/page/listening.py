"""Subscriptions to ROS: one for each topic to which any client listens. Threads of rospy only store what arrives."""

import concurrent.futures
from typing import Any, Callable, Dict, Tuple

import rospy

from rumba_viewer.page.feeds import Arrival, Feed

QUEUE = 100  # messages that rospy keeps of what came at once
AGAIN = 1.0  # [s] after which what the master refused is tried once more


class Listening:
    """Subscribes to the topics that are wanted. Its methods are called in the thread of the loop, and never block."""

    def __init__(self, later: Callable[..., Any]) -> None:
        """Call functions in the loop `later`, after a time [s]."""
        self._later = later
        self._wanted: Dict[str, Feed] = {}
        self._subscribed: Dict[str, Tuple[Feed, Any]] = {}  # that only the thread of the executor uses
        self._executor = concurrent.futures.ThreadPoolExecutor(1)  # for what waits for the master

    def want(self, feed: Feed) -> None:
        """Subscribe to the topic of a feed."""
        if feed.topic not in self._wanted:
            self._wanted[feed.topic] = feed
            self._settle(feed.topic)

    def drop(self, topic: str) -> None:
        """No longer subscribe to a topic."""
        self._wanted.pop(topic, None)
        self._settle(topic)

    def close(self) -> None:
        """Begin nothing more."""
        self._wanted.clear()
        self._executor.shutdown(wait=False)

    def _settle(self, topic: str) -> None:
        """Make the subscription what is wanted, and try again if that fails."""
        def done(future: Any) -> None:
            if future.exception() is not None and not rospy.is_shutdown():
                self._later(AGAIN, lambda: self._settle(topic))
        try:
            self._executor.submit(self._change, topic).add_done_callback(done)
        except RuntimeError:
            pass  # closed

    def _change(self, topic: str) -> None:
        feed = self._wanted.get(topic)
        before, subscriber = self._subscribed.get(topic, (None, None))
        if feed is before:
            return
        if subscriber is not None:
            del self._subscribed[topic]
            subscriber.unregister()
        if feed is not None:
            arrivals = feed.arrivals
            self._subscribed[topic] = feed, rospy.Subscriber(
                topic, rospy.AnyMsg, lambda message: arrivals.append(arrival(message)), queue_size=QUEUE,
                tcp_nodelay=True)


def arrival(message: Any) -> Arrival:
    """A message of any type, as rospy hands it over."""
    header = message._connection_header
    return Arrival(message._buff, header.get('type', ''), header.get('md5sum', ''), header.get('callerid', ''),
                   header.get('latching') == '1')
