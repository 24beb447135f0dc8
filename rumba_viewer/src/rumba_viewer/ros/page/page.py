"""page: a web page that shows Rumbas and lets people drive them, and a websocket in rosbridge's protocol for programs.

Open http://127.0.0.1:8080 in a browser. It serves the protocol rosbridge v2 (JSON) at the same address, for roslib and
roslibpy: advertise, publish, subscribe, call_service and so on, for messages of every installed package.
docs/page.md describes it, what clients can reach, and how to let a class use it.

Subscribes, publishes and calls what clients ask for, if its allow-list names it.

Parameters, as in `rosrun rumba_viewer page _port:=9090`:
"""

import dataclasses
import functools
import pathlib
import resource
import sys
import time
from typing import Any, Callable, List, Optional

import rospkg
import rospy
from tornado.ioloop import IOLoop

from rumba_sim.model.config import setting
from rumba_sim.ros.common import node
from rumba_viewer.page.allow_list import AllowList, Tokens, robot_tokens
from rumba_viewer.page.errors import Refusal
from rumba_viewer.page.feeds import Demand
from rumba_viewer.page.filling import Filler, serialised
from rumba_viewer.page.ros import Done, Ros
from rumba_viewer.page.server import MOST_TOPICS, Bounds, Hub, check_address, serve, sockets
from rumba_viewer.ros.page import types
from rumba_viewer.ros.page.api import Api
from rumba_viewer.ros.page.clock import Clock
from rumba_viewer.ros.page.frames import Frames
from rumba_viewer.ros.page.graph import Graph
from rumba_viewer.ros.page.listening import Listening
from rumba_viewer.ros.page.services import Services
from rumba_viewer.ros.page.serving import Serving
from rumba_viewer.ros.page.talking import Talking
from rumba_viewer.ros.page.wire import Encoder

REMEMBERED = 5.0  # [s] for which a topic stays subscribed to without a client, as while a page is loaded again
SWITCH = 0.001  # [s] for which the loop waits for a thread that is at work


@dataclasses.dataclass(frozen=True)
class Settings:
    """The node's private parameters."""

    address: str = setting('127.0.0.1', 'address at which to serve; 0.0.0.0: all of this machine, needs a token')
    port: int = setting(8080, 'port; 0: any free one, which a line tells', '', 0, 65535)
    token: str = setting('', 'text that permits changes; empty: everybody may change everything')
    robot_tokens: str = setting('', 'texts that permit to drive one robot, as in rumba:blue,rumba2:green')
    read: str = setting('', 'further topics that can be subscribed to, separated by commas; * stands for a robot')
    write: str = setting('', 'further topics that can be published to')
    call: str = setting('', 'further services that can be called')
    serve: str = setting('', 'services that clients can serve')
    get: str = setting('', 'parameters that can be read')
    set: str = setting('', 'parameters that can be set and deleted')
    defaults: bool = setting(True, 'whether what the page itself needs can be reached')
    origins: str = setting('', 'further origins of web pages that may connect, as in http://example.org; * matches any')
    connections: int = setting(200, 'clients at the same time', '', 1, 10000)
    rate: float = setting(100.0, 'messages of one client', '1/s', 1.0, 10000.0)
    size: int = setting(65536, 'size of a message of a client', 'bytes', 1024, 16777216)
    bandwidth: int = setting(524288, 'what one client may send', 'bytes/s', 1024, 1073741824)
    elements: int = setting(20000, 'values in a message of a client, and in all of a second', '', 100, 100000000)
    share: float = setting(0.05, 'share of a core that one client may use', '', 0.001, 1.0)


def main() -> None:
    """Run the node."""
    node.run('page', Settings, run, own_clock=True)


def run(settings: Settings) -> None:
    """Serve until ROS shuts down.

    Raises:
        ConfigError: it is not possible with these settings.
    """
    namespace = rospy.get_namespace()
    tokens = Tokens(settings.token, robot_tokens(settings.robot_tokens, namespace))
    check_address(settings.address, tokens)
    allowed = AllowList(namespace, settings.defaults, **{
        what: _parts(getattr(settings, what)) for what in ('read', 'write', 'call', 'serve', 'get', 'set')})
    where = sockets(settings.address, settings.port)
    _raise_limit_of_files()
    sys.setswitchinterval(SWITCH)
    loop = IOLoop.current()
    clock = Clock()
    hub = Hub(namespace, allowed, _parts(settings.origins),
              Bounds(**{field.name: getattr(settings, field.name) for field in dataclasses.fields(Bounds)}),
              Encoder(rospy.logwarn, clock.now).encode, time.thread_time, rospy.logwarn)
    later = functools.partial(_later, loop)
    link = RosLink(hub, allowed, clock, later)
    hub.ros = Frames(link, hub, link.listening, later)
    serve(hub, tokens, pathlib.Path(rospkg.RosPack().get_path('rumba_viewer')) / 'page', where)
    rospy.on_shutdown(lambda: loop.add_callback(loop.stop))
    rospy.loginfo(f'the page is at http://{_shown(settings.address)}:{where[0].getsockname()[1]}'
                  + (' (add #token=TOKEN to change anything)' if tokens.are_needed else ''))
    loop.start()
    link.close()


class RosLink(Ros):
    """What clients ask of ROS. Its methods are called in the thread of the loop, and never block.

    Attributes:
        listening: the subscriptions.
    """

    def __init__(self, hub: Hub, allowed: AllowList, clock: Clock, later: Callable[..., Any]) -> None:
        """Serve the clients of a hub; call functions in the loop `later`, after a time [s], from any thread."""
        self._hub, self._later = hub, later
        self._graph = Graph(lambda: hub.clients > 0, clock)
        self._filler = Filler(types.of_message, clock.now)
        self.listening = Listening(later)
        self._talking = Talking(later)
        self._serving = Serving(self._filler, later)
        api = Api(self._graph, allowed, self._talking.kinds, clock)
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

    def advertise(self, client: Any, topic: str, kind: Optional[str], latch: bool) -> None:
        """Prepare to publish messages of a type; None: that which the topic has."""
        known = self._graph.known.types.get(topic, '*')
        if kind is None and known == '*':
            raise Refusal(f'the type of {topic} is not known: advertise it first')
        if kind is not None and known not in (kind, '*'):
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


def _parts(text: str) -> List[str]:
    """The parts of a text between commas and spaces."""
    return text.replace(',', ' ').split()


def _shown(address: str) -> str:
    return {'0.0.0.0': 'THIS_MACHINE', '::': 'THIS_MACHINE'}.get(address, f'[{address}]' if ':' in address else address)


def _raise_limit_of_files() -> None:
    """Allow as many open sockets as the system does; 1024 would be too few for a crowd."""
    _, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (hard, hard))
