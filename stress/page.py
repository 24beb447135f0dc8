"""A client of the page: what a browser asks for, and a websocket in rosbridge's protocol."""

import base64
import http.client
import json
import os
import struct

from stress import wire

TEXT, FINAL, MASKED = 1, 0x80, 0x80
SHORT, MEDIUM = 126, 127  # lengths that say: the next two bytes, the next eight
NO_PAGE = (OSError, http.client.HTTPException, wire.WireError, ValueError, KeyError)


def get(port, path, timeout):
    """What a browser gets at a path, as text.

    Raises:
        OSError, http.client.HTTPException: nobody answers.
        ValueError: the answer is no success.
    """
    connection = http.client.HTTPConnection(wire.HOST, port, timeout=timeout)
    try:
        connection.request('GET', path)
        answer = connection.getresponse()
        if answer.status != http.client.OK:
            raise ValueError(f'GET {path}: {answer.status} {answer.reason}')
        return answer.read().decode()
    finally:
        connection.close()


class Client:
    """A websocket, as long as a block."""

    def __init__(self, port, timeout):
        """Connect.

        Raises:
            OSError, wire.WireError: it is not possible.
        """
        self._socket = wire.connect(wire.HOST, port, timeout)
        key = base64.b64encode(os.urandom(16)).decode()
        self._socket.sendall((
            f'GET / HTTP/1.1\r\nHost: {wire.HOST}:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n'
            f'Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: {key}\r\n\r\n').encode())
        head = b''
        while not head.endswith(b'\r\n\r\n'):
            head += wire.read_exactly(self._socket, 1)
        if b' 101 ' not in head.partition(b'\r\n')[0]:
            raise wire.WireError(f'no websocket: {head[:80]!r}')

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._socket.close()

    def send(self, **operation):
        """Send an operation."""
        data, mask = json.dumps(operation).encode(), os.urandom(4)
        head = bytes([FINAL | TEXT, MASKED | min(len(data), SHORT)])
        length = struct.pack('>H', len(data)) if len(data) >= SHORT else b''
        self._socket.sendall(head + length + mask + bytes(
            byte ^ mask[place % 4] for place, byte in enumerate(data)))

    def subscribe(self, topic, kind):
        """Ask for the messages of a topic."""
        self.send(op='subscribe', topic=topic, type=kind)

    def next(self):
        """The next message that is published.

        Raises:
            OSError, wire.WireError: none comes.
        """
        while True:
            head = wire.read_exactly(self._socket, 2)
            size = head[1]
            if size == SHORT:
                size, = struct.unpack('>H', wire.read_exactly(self._socket, 2))
            elif size == MEDIUM:
                size, = struct.unpack('>Q', wire.read_exactly(self._socket, 8))
            data = wire.read_exactly(self._socket, size)
            if head[0] == FINAL | TEXT and json.loads(data).get('op') == 'publish':
                return json.loads(data)
