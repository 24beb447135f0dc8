"""page: a web page that shows Rumbas and lets people drive them, and a websocket in rosbridge's protocol for programs.

Open http://127.0.0.1:8080 in a browser. It serves the protocol rosbridge v2 (JSON) at the same address, for roslib and
roslibpy: advertise, publish, subscribe, call_service and so on, for messages of every installed package.
docs/page.md describes it, what clients can reach, and how to let a class use it.

Subscribes, publishes and calls what clients ask for, if its allow-list names it.

Parameters, as in `rosrun rumba_viewer page _port:=9090`:
"""

import functools
import gc
import resource
import sys
from typing import Any, Callable, Optional

import rospy
from tornado.ioloop import IOLoop

from rumba_sim.ros.running import node
from rumba_viewer.page.feeds import Demand
from rumba_viewer.page.messages.errors import Refusal
from rumba_viewer.page.messages.filling import Filler, serialised
from rumba_viewer.page.ros import Done, Ros
from rumba_viewer.page.server import MOST_TOPICS, Hub, serve, sockets
from rumba_viewer.ros.page.early import Early
from rumba_viewer.ros.page.frames import Frames
from rumba_viewer.ros.page.listening import Listening
from rumba_viewer.ros.page.rosapi import types
from rumba_viewer.ros.page.rosapi.api import Api
from rumba_viewer.ros.page.rosapi.clock import Clock
from rumba_viewer.ros.page.rosapi.graph import Graph
from rumba_viewer.ros.page.services import Services
from rumba_viewer.ros.page.serving import Serving
from rumba_viewer.ros.page.settings import Settings, folder, hub_of, tokens_of, url
from rumba_viewer.ros.page.talking import Talking
from rumba_viewer.ros.page.wire import Encoder

REMEMBERED = 5.0  # [s] for which a topic stays subscribed to without a client, as while a page is loaded again
SWITCH = 0.001  # [s] for which the loop waits for a thread that is at work
COLLECT = 700, 10, 2  # when garbage is collected: more often than usual, so that clients wait for less of it at once


def main() -> None:
    """Run the node; while there is no master, the page is served, and says that it waits for one."""
    early = Early()
    node.run('page', Settings, lambda settings: run(settings, early), own_clock=True, before=early.begin)


def run(settings: Settings, early: Early) -> None:
    """Serve until ROS shuts down, with the sockets of the page that waited for a master, if it did.

    Raises:
        ConfigError: it is not possible with these settings.
    """
    tokens = tokens_of(settings)
    clock = Clock()
    hub = hub_of(settings, Encoder(rospy.logwarn, clock.now).encode, rospy.logwarn)
    where = early.end(settings) or sockets(settings.address, settings.port)
    _raise_limit_of_files()
    sys.setswitchinterval(SWITCH)
    loop = IOLoop.current()
    later = functools.partial(_later, loop)
    link = RosLink(hub, clock, later)
    hub.ros = Frames(link, hub, link.listening, later)
    serve(hub, tokens, folder(), where)
    rospy.on_shutdown(lambda: loop.add_callback(loop.stop))
    rospy.loginfo(f'the page is at {url(settings, where)}'
                  + (' (add #token=TOKEN to change anything)' if tokens.are_needed else ''))
    gc.collect()
    gc.freeze()  # otherwise each collection looks at all that was imported, while all clients wait
    gc.set_threshold(*COLLECT)
    loop.start()
    link.close()


class RosLink(Ros):
    """What clients ask of ROS. Its methods are called in the thread of the loop, and never block.

    Attributes:
        listening: the subscriptions.
    """

    def __init__(self, hub: Hub, clock: Clock, later: Callable[..., Any]) -> None:
        """Serve the clients of a hub; call functions in the loop `later`, after a time [s], from any thread."""
        self._hub, self._later = hub, later
        self._graph = Graph(lambda: hub.clients > 0, clock)
        self._filler = Filler(types.of_message, clock.now)
        self.listening = Listening(later)
        self._talking = Talking(later)
        self._serving = Serving(self._filler, later)
        api = Api(self._graph, hub.allowed, self._talking.kinds, clock)
        self._services = Services(api, self._serving, self._filler, later)
        self._graph.start()

    def close(self) -> None:
        """Begin nothing more."""
        self.listening.close()
        self._talking.close()
        self._serving.close()
        self._services.close()

    def subscribe(self, client: Any, topic: str, reason: Any, demand: Demand) -> None:
        """Send the messages of a topic to a client."""
        if topic not in self._hub.feeds and len(self._hub.feeds) >= MOST_TOPICS:
            self._forget(self._hub.topic_to_give_up(client))
        self._hub.listen(client, topic, reason, demand)
        self.listening.want(self._hub.feed(topic))

    def unsubscribe(self, client: Any, topic: str, reason: Any) -> None:
        """No longer send them; reason None: for no reason."""
        feed = self._hub.feed(topic)
        feed.remove(client, reason)
        if not feed.has_listeners:
            self._later(REMEMBERED, lambda: self._forget(topic))

    def _forget(self, topic: str) -> None:
        """No longer subscribe to a topic, unless somebody listens to it again."""
        feed = self._hub.feeds.get(topic)
        if feed is not None and not feed.has_listeners:
            del self._hub.feeds[topic]
            self.listening.drop(topic)

    def kind(self, topic: str) -> str:
        """The type of a topic; empty if it is not known."""
        return self._graph.known.types.get(topic, '').replace('*', '')

    def advertise(self, client: Any, topic: str, kind: Optional[str], latch: bool) -> None:
        """Prepare to publish messages of a type; None: that which the topic has."""
        known = self.kind(topic)
        if kind is None and not known:
            raise Refusal(f'the type of {topic} is not known: advertise it first')
        if kind is not None and known not in (kind, ''):
            raise Refusal(f'{topic} has the type {known} and not {kind}')
        self._talking.advertise(client, topic, kind or known, latch)

    def unadvertise(self, client: Any, topic: str) -> None:
        """The client no longer publishes."""
        self._talking.unadvertise(client, topic)

    def publish(self, client: Any, topic: str, values: Any) -> None:
        """Publish a message with these values."""
        outlet = self._talking.outlet(topic)
        outlet.publish(serialised(self._filler.fill(outlet.make(), values)))

    def call(self, client: Any, service: str, values: Any, done: Done, timeout: float) -> None:
        """Call a service."""
        self._services.call(client, service, values, done, timeout)

    def serve(self, client: Any, service: str, kind: str, ask: Callable[[str, Any], None],
              tell: Callable[[str, str], None]) -> None:
        """Serve a service on behalf of a client."""
        self._serving.serve(client, service, kind, ask, tell)

    def unserve(self, client: Any, service: str) -> None:
        """The client no longer serves it."""
        self._serving.unserve(client, service)

    def answer(self, client: Any, service: str, request: Any, worked: bool, values: Any) -> None:
        """Answer a request."""
        self._serving.answer(client, service, request, worked, values)

    def leave(self, client: Any) -> None:
        """Forget a client."""


def _later(loop: IOLoop, seconds: float, act: Callable[[], Any]) -> None:
    """Call a function in the loop after a time [s]; from any thread."""
    try:
        loop.add_callback(lambda: loop.call_later(seconds, act) if seconds else act())
    except RuntimeError:
        pass  # the loop has ended


def _raise_limit_of_files() -> None:
    """Allow as many open sockets as the system does; 1024 would be too few for a crowd."""
    _, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (hard, hard))
