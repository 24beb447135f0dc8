"""Lets connections in: few at a time, each of its requests in turn, and of those that ask for nothing not too many."""

import asyncio
import operator
import socket
from typing import Any, Awaitable, Callable, Optional

from tornado.ioloop import IOLoop
from tornado.iostream import IOStream, StreamClosedError

from rumba_viewer.page.addresses import Address, Addresses
from rumba_viewer.page.turns import Turns

AT_ONCE = 4  # connections that are let in before others get their turn
PAUSE = 0.1  # [s] without new connections after the system refused one
MOST, MOST_ASKING = 2000, 200  # connections that are no websockets, and those of them whose request waits for its turn
CONNECTION, REQUEST, BYTE = 2e-4, 1e-3, 6e-7  # [s] of CPU time that each costs; a byte of the head of a request


class Stream(IOStream):
    """A connection, whose requests are parsed when it is its turn."""

    def __init__(self, connection: socket.socket, address: Address, turns: Turns, most: int) -> None:
        """Serve a connection; read up to so many bytes ahead."""
        self._address, self._turns = address, turns
        self._is_its_turn = asyncio.Event()
        super().__init__(connection, max_buffer_size=most)
        address.streams[self] = None

    def read_until_regex(self, regex: bytes, max_bytes: Optional[int] = None) -> Any:
        """Read the head of a request."""
        reading = asyncio.ensure_future(self._in_turn(super().read_until_regex(regex, max_bytes)))
        reading.add_done_callback(lambda _: reading.cancelled() or reading.exception())  # whoever waited may have gone
        return reading

    async def _in_turn(self, head: Awaitable[bytes]) -> bytes:
        data = await head
        self._is_its_turn.clear()
        self._address.asking[self] = None
        self._turns.ask(self._address.account, self._is_its_turn.set)
        await self._is_its_turn.wait()
        self._address.asking.pop(self, None)
        if self.closed():
            raise StreamClosedError
        self._turns.pay(self._address.account, REQUEST + BYTE * len(data))
        return data

    def keep(self) -> None:
        """Be a websocket, which is not closed for a new connection."""
        self._address.streams.pop(self, None)

    def close_fd(self) -> None:
        """Close the socket; a request that waits for its turn is forgotten."""
        self.keep()
        super().close_fd()
        self._address.asking.pop(self, None)
        self._is_its_turn.set()


class Door:
    """Accepts connections."""

    def __init__(self, addresses: Addresses, turns: Turns, most: int,
                 begin: Callable[[Stream, Any], None]) -> None:
        """Have each served by `begin`, and read up to so many bytes ahead of it."""
        self._addresses, self._turns, self._most, self._begin = addresses, turns, most, begin

    def open(self, listening: socket.socket) -> None:
        """Accept the connections of a socket."""
        IOLoop.current().add_handler(listening, self._accept, IOLoop.READ)

    def _accept(self, listening: Any, _: int) -> None:
        for _ in range(AT_ONCE):
            try:
                connection, where = listening.accept()
            except (BlockingIOError, ConnectionAbortedError):
                break
            except OSError:  # such as too many open files
                self._rest(listening, PAUSE)
                return
            address = self._addresses.find(where[0])
            self._turns.pay(address.account, CONNECTION)
            self._make_room()
            self._begin(Stream(connection, address, self._turns, self._most), where)
        pause = self._turns.pause()
        if pause:
            self._rest(listening, pause)

    def _rest(self, listening: Any, seconds: float) -> None:
        """Accept nothing for a while [s]."""
        IOLoop.current().remove_handler(listening)
        IOLoop.current().call_later(seconds, self.open, listening)

    def _make_room(self) -> None:
        """Close the oldest of too many connections of the address that has most of them."""
        for name, most in (('streams', MOST), ('asking', MOST_ASKING)):
            oldest = self._addresses.oldest(operator.attrgetter(name), most)
            if oldest is not None:
                oldest.close()
