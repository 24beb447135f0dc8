"""Between sessions and ROS: answers what clients ask in the way of tf2_web_republisher, and hands on all else."""

import math
from typing import Any, Callable, List, Optional

from tf2_msgs.msg import TFMessage

from rumba_viewer.page import republishing
from rumba_viewer.page.feeds import Arrival, Demand
from rumba_viewer.page.messages.transforms import Transform
from rumba_viewer.page.republishing import Republisher
from rumba_viewer.page.ros import Done, Ros
from rumba_viewer.page.server import TICK, Hub
from rumba_viewer.ros.page.listening import Listening
from rumba_viewer.ros.page.wire import framed_values

TOPICS = ('/tf', '/tf_static')


class Frames(Ros):
    """Answers what concerns frames."""

    def __init__(self, ros: Ros, hub: Hub, listening: Listening, later: Callable[..., Any]) -> None:
        """Hand on to `ros`; call functions in the loop `later`, after a time [s]."""
        self._ros, self._hub, self._listening, self._later = ros, hub, listening, later
        self._republisher = Republisher(_send, hub.now)
        self._is_running = False

    def subscribe(self, client: Any, topic: str, reason: Any, demand: Demand) -> None:
        """Send the messages of a topic to a client."""
        if republishing.is_ours('read', topic):
            self._republisher.subscribe(client, topic, reason, demand)
        else:
            self._ros.subscribe(client, topic, reason, demand)

    def unsubscribe(self, client: Any, topic: str, reason: Any) -> None:
        """No longer send them; reason None: for no reason."""
        if republishing.is_ours('read', topic):
            self._republisher.unsubscribe(client, topic, reason)
        else:
            self._ros.unsubscribe(client, topic, reason)

    def kind(self, topic: str) -> str:
        """The type of a topic; empty if it is not known."""
        return republishing.TYPES.get(topic) or self._ros.kind(topic)

    def advertise(self, client: Any, topic: str, kind: Optional[str], latch: bool) -> None:
        """Prepare to publish messages of a type; None: that which the topic has."""
        if not republishing.is_ours('write', topic):
            self._ros.advertise(client, topic, kind, latch)

    def unadvertise(self, client: Any, topic: str) -> None:
        """The client no longer publishes."""
        if not republishing.is_ours('write', topic):
            self._ros.unadvertise(client, topic)

    def publish(self, client: Any, topic: str, values: Any) -> None:
        """Publish a message with these values."""
        if republishing.is_ours('write', topic):
            self._republisher.publish(client, topic, values)
            self._run()
        else:
            self._ros.publish(client, topic, values)

    def call(self, client: Any, service: str, values: Any, done: Done, timeout: float) -> None:
        """Call a service."""
        if republishing.is_ours('call', service):
            done(True, self._republisher.answer(client, values))
            self._run()
        else:
            self._ros.call(client, service, values, done, timeout)

    def serve(self, client: Any, service: str, kind: str, ask: Callable[[str, Any], None],
              tell: Callable[[str, str], None]) -> None:
        """Serve a service on behalf of a client."""
        self._ros.serve(client, service, kind, ask, tell)

    def unserve(self, client: Any, service: str) -> None:
        """The client no longer serves it."""
        self._ros.unserve(client, service)

    def answer(self, client: Any, service: str, request: Any, worked: bool, values: Any) -> None:
        """Answer a request."""
        self._ros.answer(client, service, request, worked, values)

    def leave(self, client: Any) -> None:
        """Forget a client."""
        self._republisher.leave(client)
        self._ros.leave(client)

    def _run(self) -> None:
        """Listen to transforms, as long as anybody follows frames."""
        if self._republisher.is_busy and not self._is_running:
            self._is_running = True
            self._republisher.tree.clear()
            for topic in TOPICS:
                self._hub.feed(topic).tap(self._take)
                self._listening.want(self._hub.feed(topic))
            self._tick()

    def _tick(self) -> None:
        self._republisher.tick(self._hub.now())
        if self._republisher.is_busy:
            self._later(TICK, self._tick)
        else:
            self._is_running = False
            for topic in TOPICS:
                self._hub.feed(topic).tap(None)
                self._ros.unsubscribe(self, topic, None)  # which forgets the topic if nobody listens to it

    def _take(self, arrivals: List[Arrival]) -> None:
        for arrival in arrivals:
            if arrival.md5 == TFMessage._md5sum:
                for one in TFMessage().deserialize(arrival.data).transforms:
                    self._put(one)

    def _put(self, stamped: Any) -> None:
        """Take a transform, unless it makes no sense."""
        shift, turn = stamped.transform.translation, stamped.transform.rotation
        length = math.sqrt(turn.x ** 2 + turn.y ** 2 + turn.z ** 2 + turn.w ** 2)
        if length > 0.0 and math.isfinite(length + shift.x + shift.y + shift.z):
            transform = Transform(
                (shift.x, shift.y, shift.z), (turn.x / length, turn.y / length, turn.z / length, turn.w / length),
                (stamped.header.stamp.secs, stamped.header.stamp.nsecs))
            parent, child = (name.lstrip('/') for name in (stamped.header.frame_id, stamped.child_frame_id))
            self._republisher.tree.put(parent, child, transform)


def _send(client: Any, topic: str, demand: Demand, values: Any) -> None:
    client.push(topic, framed_values(demand.name, values, demand.compression), demand.most)
