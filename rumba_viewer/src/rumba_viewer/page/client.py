"""One browser or program on the other end of a websocket: what it may send, and what waits for it if it is slow."""

import asyncio
import collections
import json
import socket
import struct
from typing import Any, Callable, Deque, Dict, Optional, Union

from tornado.iostream import StreamClosedError
from tornado.websocket import WebSocketHandler, WebSocketProtocol13

from rumba_viewer.page.allow_list import Rights, is_origin_allowed
from rumba_viewer.page.errors import Hostile, Refusal
from rumba_viewer.page.protocol import Session

BROKEN, REFUSED, TOO_BIG = 1002, 1008, 1009  # codes of RFC 6455 for an end because of what the client did
MASKED = 0x80  # bit of the second byte of a frame
BURST = 2.0  # [s] of its rate that a client may send at once
MOST_REPLIES = 200  # that wait for a slow client; a client for which more would wait is disconnected
SEND_BUFFER = 65536  # [bytes] in the kernel for each client: what it holds grows old
LINGER = 5.0  # [s] in which the rest of a message that is too big is read and thrown away
TEXT, BINARY = 0x81, 0x82  # first byte of a frame that is a whole text, or whole data: RFC 6455, section 5.2


def framed(content: Union[str, bytes]) -> bytes:
    """The frame of a websocket in which a server sends a text or data; it is the same for all clients."""
    first, data = (TEXT, content.encode()) if isinstance(content, str) else (BINARY, content)
    if len(data) < 126:
        return struct.pack('!BB', first, len(data)) + data
    if len(data) < 1 << 16:
        return struct.pack('!BBH', first, 126, len(data)) + data
    return struct.pack('!BBQ', first, 127, len(data)) + data


class Bucket:
    """Says whether messages come too fast: a token bucket."""

    def __init__(self, rate: float, now: float) -> None:
        """Allow so many messages per second [1/s]."""
        self._rate, self._before = rate, now
        self._left = rate * BURST

    def takes(self, now: float) -> bool:
        """Whether one more message may come at a time [s]."""
        self._left = min(self._left + (now - self._before) * self._rate, self._rate * BURST)
        self._before = now
        self._left -= 1.0
        return self._left >= 0.0


class Patient(WebSocketProtocol13):
    """Ends so that a client that sends too much can still read why."""

    _is_too_much = False
    _begins_frame = False

    async def _receive_frame(self) -> None:
        self._begins_frame = True
        await super()._receive_frame()

    async def _read_bytes(self, n: int) -> bytes:
        """Read; the second byte of a frame must say that the client has masked it."""
        data = await super()._read_bytes(n)
        begins, self._begins_frame = self._begins_frame, False
        if begins and not data[1] & MASKED:
            client: Any = self.handler
            client.tell_and_drop('a client must mask its frames: RFC 6455, section 5.1', BROKEN)
            raise StreamClosedError
        return data

    def _handle_message(self, opcode: int, data: bytes) -> Any:
        try:
            return super()._handle_message(opcode, data)
        except UnicodeDecodeError:  # the reason of a close is no text
            return self._abort()

    def close(self, code: Optional[int] = None, reason: Optional[str] = None) -> None:
        """Say it in a status first."""
        if code == TOO_BIG:
            self._is_too_much = True
            client: Any = self.handler
            client.tell_and_drop(f'the message is too big: at most {self.params.max_message_size} bytes')
        super().close(code, reason)

    def _abort(self) -> None:
        if self._is_too_much and not self.stream.closed():  # else the status would be lost with the connection
            self._is_too_much = False
            self.client_terminated = True  # else what is drained would be taken for frames
            asyncio.ensure_future(self._drain())
        else:
            super()._abort()

    async def _drain(self) -> None:
        end = asyncio.get_event_loop().time() + LINGER
        try:
            while asyncio.get_event_loop().time() < end:
                await asyncio.wait_for(self.stream.read_bytes(SEND_BUFFER, partial=True), LINGER)
        except (asyncio.TimeoutError, StreamClosedError):
            pass
        super()._abort()


class Client(WebSocketHandler):
    """A websocket; `hub` is the server to which it belongs."""

    def initialize(self, hub: Any, rights_of: Callable[[Optional[str]], Rights]) -> None:
        """Belong to a server; `rights_of` tells what a token permits."""
        self._hub, self._rights_of = hub, rights_of
        self._session: Optional[Session] = None
        self._waiting: Dict[Optional[str], Deque[bytes]] = {}  # frames by topic; None: answers
        self._bucket = Bucket(hub.bounds.rate, hub.now())
        self._is_dropped = False
        self.lost = 0  # messages that it did not get because it was slow

    def check_origin(self, origin: str) -> bool:
        """Whether a page of this origin may connect."""
        return is_origin_allowed(origin, self.request.host, self._hub.origins)

    def get_websocket_protocol(self) -> Any:
        """A protocol that ends patiently."""
        found: Any = super().get_websocket_protocol()
        return found and Patient(self, False, found.params)

    def open(self, *_: str, **__: str) -> None:
        """Begin a session, or say why not and close."""
        self.set_nodelay(True)
        self.ws_connection.stream.socket.setsockopt(  # type: ignore[union-attr]
            socket.SOL_SOCKET, socket.SO_SNDBUF, SEND_BUFFER)
        try:
            rights = self._rights_of(self.get_query_argument('token', None))
            self._hub.enter(self)
        except Refusal as refusal:
            self.tell_and_drop(str(refusal))
            return
        self._session = self._hub.session(self, rights)

    def on_message(self, message: Any) -> None:
        """Carry out an operation."""
        if self._session is None or self._is_dropped:
            return
        try:
            if not self._bucket.takes(self._hub.now()):
                raise Hostile(f'too many messages: at most {self._hub.bounds.rate:g} in a second')
            self._session.receive(message)
        except Hostile as error:
            self.tell_and_drop(str(error))

    def on_close(self) -> None:
        """Give back what the client has asked for."""
        self._waiting.clear()
        if self._session is not None:
            self._session.close()
            self._session = None
        self._hub.leave(self)

    # --- to the client ------------------------------------------------------------------------------------------------

    def reply(self, operation: Dict[str, Any]) -> None:
        """Send an operation that must not be lost."""
        if len(self._waiting.get(None, ())) >= MOST_REPLIES:
            self.tell_and_drop('too many answers wait for this client')
        else:
            self.push(None, framed(json.dumps(operation, separators=(',', ':'))), MOST_REPLIES)
            self.deliver()

    def tell_and_drop(self, line: str, code: int = REFUSED) -> None:
        """Send a status, and close the connection."""
        if not self._is_dropped:
            self._is_dropped = True
            self._write(framed(json.dumps({'op': 'status', 'level': 'error', 'msg': line})))
            self.close(code, 'refused')

    def push(self, topic: Optional[str], frame: bytes, most: int) -> None:
        """Have a message of a topic sent with the next `deliver`; at most so many wait, and the newest win."""
        waiting = self._waiting.setdefault(topic, collections.deque())
        waiting.append(frame)
        while len(waiting) > most:
            waiting.popleft()
            self.lost += 1
        self._hub.has_mail(self)

    def deliver(self) -> bool:
        """Send what waits, if the client has taken what was sent before; returns whether nothing is left."""
        stream = getattr(self.ws_connection, 'stream', None)
        if self._is_dropped or stream is None or stream.closed():
            self._waiting.clear()
        if not self._waiting:
            return True
        if stream is None or stream.writing():
            return False
        frames = b''.join(frame for waiting in self._waiting.values() for frame in waiting)
        self._waiting.clear()
        self._write(frames)
        return True

    def _write(self, frames: bytes) -> None:
        """Send whole frames: tornado would make each again for each client, in a task of its own."""
        try:
            self.ws_connection.stream.write(frames)  # type: ignore[union-attr]
        except (AttributeError, StreamClosedError):
            pass  # it has left
