"""One browser or program on the other end of a websocket: what it may send, and what waits for it if it is slow."""

import asyncio
import collections
import json
import socket
import struct
from typing import Any, Deque, Dict, Optional, Union

from tornado.iostream import StreamClosedError
from tornado.web import HTTPError
from tornado.websocket import WebSocketHandler, WebSocketProtocol13

from rumba_viewer.page.allow_list import Rights, Tokens, is_origin_allowed
from rumba_viewer.page.messages.errors import Hostile, Refusal
from rumba_viewer.page.protocol import Session
from rumba_viewer.page.turns import Bucket

BROKEN, REFUSED, TOO_BIG = 1002, 1008, 1009  # codes of RFC 6455 for an end because of what the client did
MASKED = 0x80  # bit of the second byte of a frame
BURST = 2.0  # [s] of its rate that a client may send at once
FRAME, PIECE = 1e-4, 1e-4  # [s] of CPU time to read a frame, and a piece of a message that is thrown away
NEW = 1.0  # [s] of CPU time that a new client counts as having used: those that are there go first
SLOW, SLOW_SHARE = 0.5, 0.05  # [s] to wait, and share of its time, with which a client is told that it is slowed down
SLOW_PERIOD = 10.0  # [s] until it is told again
LARGEST_OF_WATCHERS = 8192  # [bytes] of a message of a client that can only watch
DELAY = 1.0  # [s] until a wrong token is answered
REASON = 120  # [bytes] of the reason of a close: RFC 6455, section 5.5
MOST_REPLIES = 200  # that wait for a slow client; a client for which more would wait is disconnected
MOST_REPLY_BYTES = 4_000_000  # the same for all of them together
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


class Patient(WebSocketProtocol13):
    """Ends so that a client that sends too much can still read why."""

    _is_too_much = False
    _begins_frame = False

    async def _receive_frame(self) -> None:
        """Receive one frame, and then wait for the next turn: a single packet may bring thousands of them."""
        self._begins_frame = True
        await super()._receive_frame()
        client: Any = self.handler
        await client.spend(FRAME)

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
            self._draining = asyncio.ensure_future(self._drain())  # else it might be collected
        else:
            super()._abort()

    async def _drain(self) -> None:
        end = asyncio.get_event_loop().time() + LINGER
        try:
            while asyncio.get_event_loop().time() < end:
                await asyncio.wait_for(self.stream.read_bytes(SEND_BUFFER, partial=True), LINGER)
                client: Any = self.handler
                await client.wind_up(PIECE)
        except (asyncio.TimeoutError, StreamClosedError):
            pass
        super()._abort()


class Client(WebSocketHandler):
    """A websocket; `hub` is the server to which it belongs."""

    def initialize(self, hub: Any, tokens: Tokens) -> None:
        """Belong to a server; `tokens` tell what a client may change."""
        self._hub, self._tokens = hub, tokens
        self._session: Optional[Session] = None
        self._rights = Rights()
        self._waiting: Dict[Optional[str], Deque[bytes]] = {}  # frames by topic; None: answers
        now = hub.now()
        self._messages = Bucket(hub.bounds.rate, BURST * hub.bounds.rate, now, BURST * hub.bounds.rate)
        self.address = hub.addresses.find(str(self.request.remote_ip))
        self._account = hub.bounds.account(now, NEW + self.address.account.used(now))
        self._patience = Bucket(SLOW_SHARE, SLOW, now, SLOW)  # [s]
        self._told_slow = -SLOW_PERIOD  # when it was told last that it is slowed down
        self._is_dropped = self._has_left = False
        self.lost = 0  # messages that it did not get because it was slow

    def check_origin(self, origin: str) -> bool:
        """Whether a page of this origin may connect."""
        return is_origin_allowed(origin, self.request.host, self._hub.origins)

    def get_websocket_protocol(self) -> Any:
        """A protocol that ends patiently."""
        found: Any = super().get_websocket_protocol()
        return found and Patient(self, False, found.params)

    async def open(self, *_: str, **__: str) -> None:
        """Begin a session, or say why not and close."""
        stream: Any = self.ws_connection.stream  # type: ignore[union-attr]
        stream.keep()
        stream.set_nodelay(True)
        stream.socket.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, SEND_BUFFER)
        try:
            self._rights = await self._admitted()
            self._hub.enter(self, self._rights)
        except Refusal as refusal:
            self.tell_and_drop(str(refusal))
            return
        self._session = self._hub.session(self, self._rights)

    async def _admitted(self) -> Rights:
        """What the token of this client permits; a wrong one is answered late, and not many are tried."""
        try:
            token = self.get_query_argument('token', None)
        except HTTPError:
            raise Refusal('the token is no text') from None
        guesses = self.address.guesses
        if token is None or not self._tokens.are_needed:
            return self._tokens.rights(token)
        wait = guesses.wait(token, self._hub.now())
        if wait:
            raise Refusal(f'too many wrong tokens came from {self.address.name}: try again in {wait:.0f} s')
        try:
            return self._tokens.rights(token)
        except Refusal:
            guesses.add(token, self._hub.now())
            await asyncio.sleep(DELAY)
            raise

    async def on_message(self, message: Any) -> None:
        """Carry out an operation when it is the turn of this client."""
        text = message if isinstance(message, str) else message.decode(errors='replace')
        elements = sum(map(text.count, ',[{'))
        await self.spend(FRAME, bandwidth=len(message), elements=elements)
        if self._session is None or self._is_dropped:
            return
        begin = self._hub.cpu()
        try:
            if not self._messages.takes(self._hub.now()):
                raise Hostile(f'too many messages: at most {self._hub.bounds.rate:g} in a second')
            self._act(text, elements)
        except Hostile as error:
            self.tell_and_drop(str(error))
        await self.spend(self._hub.cpu() - begin)

    def _act(self, text: str, elements: int) -> None:
        """Carry out an operation; one that is too large is not even read."""
        session: Any = self._session
        if elements > self._hub.bounds.elements:
            session.refuse(f'a message can have {self._hub.bounds.elements} values at most')
        elif self._rights.are_none and len(text) > LARGEST_OF_WATCHERS:
            session.refuse(f'without a token a message can have {LARGEST_OF_WATCHERS} bytes at most')
        else:
            session.receive(text)

    async def spend(self, seconds: float, **others: float) -> None:
        """Pay CPU time [s] and others, and wait until this client may go on."""
        self._hub.turns.pay(self._account, seconds, **others)
        now = self._hub.now()
        self._patience.pay(self._account.wait(now), now)
        if self._session is not None and self._patience.wait(now) and now > self._told_slow + SLOW_PERIOD:
            self._told_slow = now
            self._session.refuse(f'you are slowed down: a client may use {self._account.bound(now)}')
        if not self._has_left:
            await self._hub.turn(self._account)

    async def wind_up(self, seconds: float) -> None:
        """Pay CPU time [s] when it is the turn of the address: for a client that is no longer one."""
        await self._hub.turn(self.address.account)
        self._hub.turns.pay(self.address.account, seconds)

    def charge(self, seconds: float) -> None:
        """Pay for what was done elsewhere [s of CPU time]."""
        self._hub.turns.pay(self._account, seconds)

    def lose(self, topic: str) -> None:
        """Take a topic from this client, for others that listen to less."""
        if self._session is not None:
            self._session.lose(topic)

    def on_close(self) -> None:
        """Give back what the client has asked for."""
        self._waiting.clear()
        self._has_left = True
        self._hub.turns.release(self._account)
        if self._session is not None:
            self._session.close()
            self._session = None
        self._hub.leave(self)

    def note(self, line: str) -> None:
        """Write a line about what was refused to this client."""
        self._hub.addresses.note(self.address, line)

    # --- to the client ------------------------------------------------------------------------------------------------

    def reply(self, operation: Dict[str, Any]) -> None:
        """Send an operation that must not be lost."""
        waiting = self._waiting.get(None, ())
        if len(waiting) >= MOST_REPLIES or sum(map(len, waiting)) > MOST_REPLY_BYTES:
            self.tell_and_drop('too many answers wait for this client')
        else:
            self.push(None, framed(json.dumps(operation, separators=(',', ':'))), MOST_REPLIES)
            self.deliver()

    def tell_and_drop(self, line: str, code: int = REFUSED) -> None:
        """Send a status, and close the connection with the same words: not every library shows a status."""
        if not self._is_dropped:
            self._is_dropped = True
            self.note(f'disconnected: {line}')
            self._write(framed(json.dumps({'op': 'status', 'level': 'error', 'msg': line})))
            self.close(code, line.encode()[:REASON].decode(errors='ignore'))

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
