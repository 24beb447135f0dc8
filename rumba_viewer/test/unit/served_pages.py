"""A page with real sockets and without ROS, and its clients."""

import asyncio
import json
import pathlib
import struct
import time

import pytest

pytest.importorskip('tornado', reason='the page needs python3-tornado')

from tornado.httpclient import HTTPRequest  # noqa: E402
from tornado.websocket import websocket_connect  # noqa: E402

from rumba_viewer.page.allow_list import AllowList, Tokens  # noqa: E402
from rumba_viewer.page.client import framed  # noqa: E402
from rumba_viewer.page.feeds import Arrival  # noqa: E402
from rumba_viewer.page.server import Bounds, Hub, serve, sockets  # noqa: E402

FOLDER = pathlib.Path(__file__).resolve().parents[2] / 'page'
TIMEOUT = 30.0  # [s]
GREETING = (b'GET / HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n'
            b'Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n')
TEXT, CLOSE, PING, FINAL = 0x1, 0x8, 0x9, 0x80


class Topics:
    """Lets clients subscribe to what `arrive` brings."""

    def __init__(self, hub):
        self._hub = hub

    def subscribe(self, client, topic, reason, demand):
        self._hub.listen(client, topic, reason, demand)

    def unsubscribe(self, client, topic, reason):
        self._hub.feed(topic).remove(client, reason)

    def kind(self, topic):
        return ''

    def leave(self, client):
        pass


class Page:
    """A server at a free port."""

    def __init__(self, tokens=Tokens(), **bounds):
        self.noted = []
        self.hub = Hub('/', AllowList(), [], Bounds(**bounds),
                       lambda arrival, name, _: framed(json.dumps({'op': 'publish', 'topic': name,
                                                                   'msg': arrival.data.decode()})),
                       time.thread_time, self.noted.append)
        self.hub.ros = Topics(self.hub)
        where = sockets('127.0.0.1', 0)
        self.at = f'127.0.0.1:{where[0].getsockname()[1]}'
        self._server = serve(self.hub, tokens, FOLDER, where)

    def arrive(self, data):
        """Let a message of /map arrive."""
        self.hub.feed('/map').arrivals.append(Arrival(data, 'a/B', '*', '/n', False))

    async def open(self, query='', **headers):
        """A client."""
        return await websocket_connect(HTTPRequest(f'ws://{self.at}/{query}', headers=headers))


async def read(client):
    """The next operation that a client gets; None if its connection has ended."""
    message = await asyncio.wait_for(client.read_message(), TIMEOUT)
    return message and json.loads(message)


async def until(condition):
    """Wait until a condition holds."""
    for _ in range(int(TIMEOUT / 0.01)):
        if condition():
            return
        await asyncio.sleep(0.01)
    raise AssertionError('waited in vain')


async def is_told_and_ended(client, words):
    """A client gets a status, and then its connection ends."""
    status = await read(client)
    assert status['op'] == 'status' and words in status['msg']
    assert await read(client) is None


async def is_served(page, client):
    """A client still gets what arrives."""
    page.arrive(b'still here')
    assert (await read(client))['msg'] == 'still here'


async def listener(page, **headers):
    """A client that listens to /map."""
    client = await page.open(**headers)
    await client.write_message('{"op": "subscribe", "topic": "/map"}')
    await until(lambda: '/map' in page.hub.feeds and page.hub.feeds['/map'].has_listeners)
    return client


def run(act):
    """Run a test in a loop of its own."""
    asyncio.run(asyncio.wait_for(act(), 4 * TIMEOUT))


def frame(opcode, data, is_masked=True):
    """A frame of a client; the mask is zero."""
    return struct.pack('!BB', FINAL | opcode, len(data) | (FINAL if is_masked else 0)) + 4 * is_masked * b'\0' + data


async def answer(page, data):
    """All that the server sends until it closes the connection."""
    reader, writer = await asyncio.open_connection(*page.at.split(':'))
    writer.write(data)
    try:
        return await asyncio.wait_for(reader.read(), TIMEOUT)
    finally:
        writer.close()
