"""The web server: static files and websockets on one port, all in one thread."""

import asyncio
import collections
import dataclasses
import pathlib
import re
import socket
from typing import Any, Callable, Dict, List, Sequence, Set

from tornado.httpserver import HTTPServer
from tornado.ioloop import IOLoop, PeriodicCallback
from tornado.netutil import bind_sockets

from rumba_sim.model.common.errors import ConfigError
from rumba_viewer.page.addresses import Address, Addresses
from rumba_viewer.page.allow_list import AllowList, Rights, Tokens, is_loopback
from rumba_viewer.page.client import Client
from rumba_viewer.page.door import Door
from rumba_viewer.page.feeds import Demand, Encode, Feed
from rumba_viewer.page.messages.errors import Refusal
from rumba_viewer.page.protocol import Session
from rumba_viewer.page.ros import Ros
from rumba_viewer.page.turns import Account, Limit, Turns
from rumba_viewer.page.web import Files, Guarded, Root

TICK = 0.05  # [s] between two looks at what has arrived from ROS
HEAD = 8192  # [bytes] of the head of a request, at most
AHEAD = 4  # messages of the largest size that are read before the first of them is understood
MOST_TOPICS = 1000  # to which all clients together listen
BURST, FIRST = 0.1, 0.02  # [s] of CPU time that a client may use at once, and when it has just come
IDLE = 30.0  # [s] after which a connection that asks for nothing is closed
PING, SILENT = 20.0, 60.0  # [s] between two pings of a websocket; without an answer, until it is closed


@dataclasses.dataclass(frozen=True)
class Bounds:
    """What clients may do at most.

    Attributes:
        connections: of all together.
        rate: messages of one client in a second.
        size: bytes of a message.
        bandwidth: bytes of one client in a second.
        elements: values in a message, and of one client in a second.
        share: of a core that one client may use.
    """

    connections: int = 200
    rate: float = 100.0
    size: int = 65536
    bandwidth: int = 524288
    elements: int = 20000
    share: float = 0.05

    def account(self, now: float, used: float) -> Account:
        """What one client may use, whose address used so much CPU time lately [s]."""
        return Account(
            now, Limit(self.share, BURST, FIRST, f'{100.0 * self.share:g} % of a core'), used,
            bandwidth=Limit(self.bandwidth, self.bandwidth, self.bandwidth, f'{self.bandwidth} bytes in a second'),
            elements=Limit(self.elements, self.elements, self.elements, f'{self.elements} values in a second'))


class Hub:
    """All clients and all topics to which they listen."""

    def __init__(self, namespace: str, allowed: AllowList, origins: Sequence[str], bounds: Bounds,
                 encode: Encode, cpu: Callable[[], float], warn: Callable[[str], object]) -> None:
        """Serve names of a namespace.

        Args:
            namespace: in which names begin.
            allowed: names that clients may reach.
            origins: patterns of further origins from which pages may connect.
            bounds: what clients may do at most.
            encode: makes the frame of an arrival on a topic.
            cpu: tells the CPU time of this thread [s].
            warn: writes a line of the log.
        """
        self.origins, self.bounds = origins, bounds
        self.feeds: Dict[str, Feed] = {}
        self.ros: Ros  # set before the first client comes
        self._namespace, self.allowed, self._encode = namespace, allowed, encode
        self._clients: Dict[Client, Rights] = {}  # the first that came first
        self._with_mail: Set[Client] = set()
        self.cpu = cpu
        self.turns = Turns(self.now, _later)
        self.addresses = Addresses(self.now, warn)

    async def turn(self, account: Account) -> None:
        """Wait for the turn of an account."""
        begun = asyncio.Event()
        self.turns.ask(account, begun.set)
        await begun.wait()

    @staticmethod
    def now() -> float:
        """A time [s] that no change of the system's clock moves."""
        loop: Any = IOLoop.current()
        return float(loop.asyncio_loop.time())

    # --- clients ------------------------------------------------------------------------------------------------------

    @property
    def clients(self) -> int:
        """How many clients there are."""
        return len(self._clients)

    def everybody(self) -> List[Client]:
        """All clients."""
        return list(self._clients)

    def enter(self, client: Client, rights: Rights) -> None:
        """Take in one more client; if there are too many, it can take the place of one that can only watch.

        Raises:
            Refusal: there are too many.
        """
        if len(self._clients) >= self.bounds.connections:
            self._give_place(client.address, rights)
        self._clients[client] = rights

    def _give_place(self, newcomer: Address, rights: Rights) -> None:
        """Disconnect a watcher of the address with most clients, for one with a token or from where fewer come."""
        of_each = collections.Counter(client.address for client in self._clients)
        watchers = [client for client, others in self._clients.items() if others.are_none]
        last = max(reversed(watchers), key=lambda client: of_each[client.address], default=None)
        if last is None or rights.are_none and of_each[last.address] <= of_each[newcomer] + 1:
            raise Refusal(f'this page has {self.bounds.connections} clients already: close one, or raise connections')
        last.tell_and_drop(f'this page has {self.bounds.connections} clients already, and another one came')
        self.leave(last)

    def leave(self, client: Client) -> None:
        """Forget a client."""
        self._clients.pop(client, None)
        self._with_mail.discard(client)

    def session(self, client: Client, rights: Rights) -> Session:
        """A session for a client."""
        return Session(self.ros, self.allowed, rights, self._namespace, client, client.reply,
                       client.note)

    def has_mail(self, client: Client) -> None:
        """Deliver what waits for a client at the end of the tick."""
        self._with_mail.add(client)

    # --- topics -------------------------------------------------------------------------------------------------------

    def feed(self, topic: str) -> Feed:
        """The feed of a topic; a new one if nobody listened to it yet."""
        if topic not in self.feeds:
            self.feeds[topic] = Feed(topic, self.now)
        return self.feeds[topic]

    def listen(self, client: Client, topic: str, reason: Any, demand: Demand) -> None:
        """Let a client listen to a topic."""
        self.feed(topic).add(client, reason, demand, self._encode)

    def topic_to_give_up(self, client: Client) -> str:
        """A topic that can make room for one more of a client, now that there are too many.

        The one that loses it listens to more than this client, or comes from an address that does.

        Raises:
            Refusal: nobody does.
        """
        free = next((feed.topic for feed in self.feeds.values() if not feed.has_listeners), None)
        if free is not None:
            return free
        of_each = collections.Counter(one for feed in self.feeds.values() for one in feed.clients)
        of_address: 'collections.Counter[Address]' = collections.Counter()
        for one, number in of_each.items():
            of_address[one.address] += number
        feed = max((feed for feed in self.feeds.values() if len(feed.clients) == 1), default=None,
                   key=lambda feed: (of_address[feed.clients[0].address], of_each[feed.clients[0]]))
        if feed is not None:
            loser = feed.clients[0]
            more = of_each[loser] - of_each[client] if loser.address is client.address else \
                of_address[loser.address] - of_address[client.address]
            if more > 1:
                loser.lose(feed.topic)
                return feed.topic
        raise Refusal(f'this page listens to {MOST_TOPICS} topics already, {of_each[client]} of them for you')

    def tick(self) -> None:
        """Hand on what has arrived."""
        now = self.now()
        for feed in list(self.feeds.values()):
            if feed.has_news:
                feed.tick(now, self._encode)
        for client in list(self._with_mail):
            if client.deliver():
                self._with_mail.discard(client)
        self.addresses.flush()


def _later(seconds: float, act: Callable[[], None]) -> None:
    """Call a function in this loop after a time [s]; 0: after all that is ready now."""
    loop = asyncio.get_event_loop()
    loop.call_later(seconds, act) if seconds else loop.call_soon(act)


def sockets(address: str, port: int) -> List[socket.socket]:
    """Sockets that listen at an address; port 0: any free one.

    Raises:
        ConfigError: it is not possible.
    """
    try:
        return bind_sockets(port, address, reuse_port=False)
    except OSError as error:
        raise ConfigError(f'cannot serve at {address}, port {port}: {error.strerror or error}: choose another port:= '
                          'or address:=') from None


def serve(hub: Hub, tokens: Tokens, folder: pathlib.Path, where: List[socket.socket]) -> HTTPServer:
    """Begin to serve in the loop of this thread; returns the server."""
    application = Guarded(
        [(r'/', Root, {'hub': hub, 'tokens': tokens}),
         (r'/([a-z_]+\.(?:js|css|svg))', Files, {'path': str(folder)})],
        folder=folder, log_function=lambda _: None, websocket_max_message_size=hub.bounds.size,
        websocket_ping_interval=PING, websocket_ping_timeout=SILENT)
    application.is_local = all(is_loopback(one.getsockname()[0]) for one in where)
    server = HTTPServer(application, idle_connection_timeout=IDLE, body_timeout=IDLE, max_header_size=HEAD)
    door = Door(hub.addresses, hub.turns, AHEAD * hub.bounds.size, server.handle_stream)
    for one in where:
        door.open(one)
    PeriodicCallback(hub.tick, 1000.0 * TICK).start()
    return server


def check_address(address: str, tokens: Tokens) -> None:
    """Check that others can reach the page only if changes need a token.

    Raises:
        ConfigError: they could change everything.
    """
    if not re.fullmatch(r'[\w.:-]+', address):
        raise ConfigError(f'address is {address!r}: must be an address of this machine, or 0.0.0.0 for all')
    if not is_loopback(address) and not tokens.are_needed:
        raise ConfigError(f'address is {address}, which others can reach: give a token:= too, without which they can '
                          'only watch')
