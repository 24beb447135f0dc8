"""Websockets as bytes: what a library would never send must be sent, too."""

import base64
import json
import os
import socket
import struct

HOST = '127.0.0.1'
PATIENCE = 20.0  # [s]
FINAL, MASKED = 0x80, 0x80
CONTINUATION, TEXT, BINARY, CLOSE, PING, PONG = 0x0, 0x1, 0x2, 0x8, 0x9, 0xA
TWO, EIGHT = 126, 127  # lengths that say: it stands in the next two bytes, the next eight


def greeting(query='', host=HOST):
    """A request for a websocket."""
    key = base64.b64encode(os.urandom(16)).decode()
    return (f'GET /{query} HTTP/1.1\r\nHost: {host}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n'
            f'Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: {key}\r\n\r\n').encode()


def frame(data, opcode=TEXT, first=FINAL, masked=MASKED):
    """A frame as a client sends it, with a mask of zeros; `first` and `masked` are bits of its first two bytes."""
    size = len(data)
    if size < TWO:
        length = struct.pack('!B', masked | size)
    elif size < 1 << 16:
        length = struct.pack('!BH', masked | TWO, size)
    else:
        length = struct.pack('!BQ', masked | EIGHT, size)
    return bytes([first | opcode]) + length + (b'\0\0\0\0' if masked else b'') + data


def text(**operation):
    """The frame of an operation."""
    return frame(json.dumps(operation).encode())


class Client:
    """A client that waits for each answer.

    Raises:
        OSError: the page is not there, or does not answer in time; from each method.
        EOFError: it has ended the connection; from each method.
    """

    def __init__(self, port, query=''):
        """Connect."""
        self.socket = socket.create_connection((HOST, port), PATIENCE)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._stream = self.socket.makefile('rb')
        self.socket.sendall(greeting(query))
        head = self._stream.readline()
        if b' 101 ' not in head:
            raise EOFError(f'no websocket: {head!r}')
        while self._read_line().strip():
            pass

    def _read_line(self):
        line = self._stream.readline()
        if not line:
            raise EOFError
        return line

    def _read(self, size):
        data = self._stream.read(size)
        if len(data) < size:
            raise EOFError
        return data

    def send(self, **operation):
        """Send an operation."""
        self.socket.sendall(text(**operation))

    def receive(self):
        """The next operation; pings are answered."""
        while True:
            opcode, size = self._read(2)
            if size == TWO:
                size, = struct.unpack('!H', self._read(2))
            elif size == EIGHT:
                size, = struct.unpack('!Q', self._read(8))
            data = self._read(size)
            if opcode == FINAL | TEXT:
                return json.loads(data)
            if opcode == FINAL | PING:
                self.socket.sendall(frame(data, PONG))
            if opcode == FINAL | CLOSE:
                raise EOFError

    def close(self):
        """Disconnect."""
        self._stream.close()
        self.socket.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()
