"""Topics and those who listen to them: each message is made into text once, however many clients there are.

Threads of ROS only store what arrives; `Feed.tick` hands it on, some twenty times a second.
"""

import collections
from typing import Any, Callable, Deque, Dict, List, NamedTuple, Optional, Tuple

MOST_ARRIVALS = 100  # messages of a topic between two ticks; of more, the oldest are dropped
MOST_KEPT = 20  # messages of a topic that wait for a slow client
SHARE = 0.1  # of a core that making the texts of one topic may take, if its listeners accept fewer messages


class Arrival(NamedTuple):
    """A message as it came from ROS.

    Attributes:
        data: its serialised form.
        type: of the message, such as `nav_msgs/Odometry`.
        md5: of the definition that its publisher has.
        publisher: name of the node.
        is_latched: whether new subscribers get it too.
    """

    data: bytes
    type: str
    md5: str
    publisher: str
    is_latched: bool


class Demand(NamedTuple):
    """How a client wants the messages of a topic.

    Attributes:
        throttle: [s] between two messages, at least; 0: every message.
        queue: messages that may wait while the client is slow; 0: as the server likes.
        compression: one of those of rosbridge: none, png, cbor, cbor-raw.
        name: of the topic, as the client wrote it; its messages carry this name.
        newest: whether to begin with the newest message that is known, even if the topic is not latched.
    """

    throttle: float = 0.0
    queue: int = 0
    compression: str = 'none'
    name: str = ''
    newest: bool = False

    @property
    def most(self) -> int:
        """How many messages wait at most while the client is slow."""
        return min(self.queue or (1 if self.throttle else MOST_KEPT), MOST_KEPT)


# Makes the frame of a message: of the arrival, the name of its topic, and its compression. None: impossible.
Encode = Callable[[Arrival, str, str], Optional[bytes]]


class Listener:
    """One client that listens to a topic, perhaps for several reasons, each with an id."""

    def __init__(self, client: Any) -> None:
        """Listen on behalf of a client, which has a method `push(topic, frame, most)`."""
        self.client = client
        self.demands: Dict[Any, Demand] = {}
        self.demand = Demand()  # all of them together
        self.due = 0.0  # when the next message may be sent
        self.seen = 0  # number of the last message that was sent

    def merge(self) -> None:
        """Take the shortest throttle and the longest queue of all reasons, as rosbridge does."""
        demands = list(self.demands.values())
        compressions = {one.compression for one in demands}
        self.demand = Demand(min(one.throttle for one in demands), max(one.queue for one in demands),
                             compressions.pop() if len(compressions) == 1 else 'none', demands[0].name,
                             any(one.newest for one in demands))


class Feed:
    """One topic."""

    def __init__(self, topic: str, clock: Callable[[], float]) -> None:
        """Feed the messages of a topic; `clock` tells the time [s]."""
        self.topic = topic
        self.arrivals: Deque[Arrival] = collections.deque(maxlen=MOST_ARRIVALS)
        self._clock = clock
        self._listeners: Dict[Any, Listener] = {}
        self._tap: Optional[Callable[[List[Arrival]], None]] = None
        self._latched: Dict[str, Arrival] = {}  # by publisher
        self._newest: Optional[Arrival] = None
        self._number = 0  # of the newest message
        self._made: Dict[Tuple[int, str, str], Optional[bytes]] = {}  # frames of what is kept for those who come
        self._has_made = False  # whether a frame was made in this tick
        self._affordable = 0.0  # when the next text may be made for those who accept fewer

    @property
    def has_listeners(self) -> bool:
        """Whether anybody listens."""
        return bool(self._listeners) or self._tap is not None

    @property
    def clients(self) -> List[Any]:
        """Those who listen."""
        return list(self._listeners)

    @property
    def has_news(self) -> bool:
        """Whether a tick may have something to hand on."""
        return bool(self.arrivals) or self._newest is not None and any(
            listener.seen < self._number for listener in self._listeners.values())

    def add(self, client: Any, reason: Any, demand: Demand, encode: Encode) -> None:
        """Let a client listen, and send it what it gets at once."""
        listener = self._listeners.get(client)
        is_new = listener is None or reason not in listener.demands
        if listener is None:
            listener = self._listeners[client] = Listener(client)
            listener.seen = self._number
        listener.demands[reason] = demand
        listener.merge()
        if is_new:
            self._greet(listener, encode)

    def tap(self, take: Optional[Callable[[List[Arrival]], None]]) -> None:
        """Have all arrivals handed to a function of the page itself, at first those that are latched; None: no more."""
        self._tap = take
        if take is not None:
            take(list(self._latched.values()))

    def _greet(self, listener: Listener, encode: Encode) -> None:
        first = list(self._latched.values())
        if not first and listener.demand.newest and self._newest is not None:
            first = [self._newest]
        for arrival in first:
            self._push(listener, self._frame(arrival, listener.demand, encode))

    def remove(self, client: Any, reason: Any = None) -> None:
        """Let a client no longer listen for a reason; None: for any."""
        listener = self._listeners.get(client)
        if listener is None:
            return
        if reason is not None:
            listener.demands.pop(reason, None)
        if reason is None or not listener.demands:
            del self._listeners[client]
        else:
            listener.merge()

    def tick(self, now: float, encode: Encode) -> None:
        """Hand on what has arrived to those for whom it is time."""
        arrived = []
        while self.arrivals:
            arrived.append(self.arrivals.popleft())
        for arrival in arrived:
            if arrival.is_latched:
                self._latched[arrival.publisher] = arrival
        if arrived and self._tap is not None:
            self._tap(arrived)
        if arrived:
            self._newest = arrived[-1]
            self._number += len(arrived)
        if self._newest is not None:
            self._hand_on(arrived, self._newest, now, encode)
        if arrived:
            kept = {id(arrival) for arrival in (self._newest, *self._latched.values())}
            self._made = {key: frame for key, frame in self._made.items() if key[0] in kept}

    def _hand_on(self, arrived: Any, newest: Arrival, now: float, encode: Encode) -> None:
        begin, self._has_made = self._clock(), False
        for listener in list(self._listeners.values()):
            demand = listener.demand
            if not demand.throttle:
                for arrival in arrived:
                    self._push(listener, self._frame(arrival, demand, encode))
                listener.seen = self._number
            elif listener.seen < self._number and now >= max(listener.due, self._affordable):
                self._push(listener, self._frame(newest, demand, encode))
                listener.seen = self._number
                listener.due = max(listener.due, now - demand.throttle / 2) + demand.throttle
        if self._has_made:
            self._affordable = now + (self._clock() - begin) / SHARE

    def _frame(self, arrival: Arrival, demand: Demand, encode: Encode) -> Optional[bytes]:
        """The frame of a message, which is made once for all who want it so."""
        key = id(arrival), demand.name, demand.compression
        if key not in self._made:
            self._made[key] = encode(arrival, demand.name, demand.compression)
            self._has_made = True
        return self._made[key]

    def _push(self, listener: Listener, frame: Optional[bytes]) -> None:
        if frame is not None:
            listener.client.push(self.topic, frame, listener.demand.most)
