"""Kinds of hostile input that the page has withstood, so that it goes on doing so."""

import asyncio
import struct

import pytest
from served_pages import (
    CLOSE, FINAL, FOLDER, GREETING, PING, TEXT, TIMEOUT, Page, answer, frame, is_served, listener, run, until)

from rumba_viewer.page.turns import AT_ONCE, OF_CONNECTIONS

CONTINUATION, BINARY, PONG = 0x0, 0x2, 0xA
HOSTS = ('localhost', 'LOCALHOST:8080', '127.0.0.1', '127.9.9.9:1', '[::1]:80')
STRANGE_HOSTS = ('evil.example', 'localhost.evil.example', '127.0.0.1.evil.example', 'localhost@evil.example', '', '0',
                 '[::2]', 'local host', '127.0.0.1:80:80')
TRAVERSALS = ('/../package.xml', '/..%2fpackage.xml', '/%2e%2e/package.xml', '/..\\package.xml', '/..%5cpackage.xml',
              '/....//package.xml', '//etc/passwd', '/%2fetc/passwd', '/etc/passwd', '/app.js/../../package.xml',
              '/app.js%00.css', '/./app.js/', '/app.js/', '/.git/config', '/index.html', '/%252e%252e/package.xml')


def request(path='/', host='localhost', *lines):
    """A request after which the connection ends."""
    return '\r\n'.join((f'GET {path} HTTP/1.1', f'Host: {host}', 'Connection: close', *lines, '', '')).encode()


@pytest.mark.parametrize('host', HOSTS + STRANGE_HOSTS)
def test_who_calls_this_machine_by_another_name_gets_nothing(host):
    async def act():
        told = await answer(Page(), request('/', host))
        assert told.startswith(b'HTTP/1.1 200 ' if host in HOSTS else (b'HTTP/1.1 403 ', b'HTTP/1.1 400 '))
    run(act)


@pytest.mark.parametrize('origin', ['http://evil.example', 'https://localhost.evil.example', 'null', 'file://', '',
                                    'http://localhost:1', 'http://localhost@evil.example'])
def test_no_page_of_another_origin_opens_a_websocket(origin):
    async def act():
        greeting = GREETING.replace(b'\r\nUpgrade', f'\r\nOrigin: {origin}\r\nUpgrade'.encode(), 1)
        told = await answer(Page(), greeting.replace(b'HTTP/1.1', b'HTTP/1.0'))  # after which the connection ends
        assert told.startswith(b'HTTP/1.1 403 ')
    run(act)


@pytest.mark.parametrize('path', TRAVERSALS)
def test_no_path_leads_to_other_files(path):
    async def act():
        told = await answer(Page(), request(path))
        assert told.startswith((b'HTTP/1.1 404 ', b'HTTP/1.1 400 ', b'HTTP/1.1 403 '))
        assert (FOLDER.parent / 'package.xml').read_bytes()[-40:] not in told
    run(act)


@pytest.mark.parametrize('data', [
    bytes([FINAL | 0x40 | TEXT]), frame(0x3, b'{}'), frame(0xB, b''), frame(CONTINUATION, b'x'), frame(TEXT, b'\xff'),
    bytes([TEXT]) + frame(TEXT, b'{')[1:] + frame(TEXT, b'}'), bytes([PING]) + frame(PING, b'x')[1:],
    bytes([FINAL | PING, FINAL | 126]) + struct.pack('!H', 200) + 204 * b'x', frame(BINARY, b'\0\1'),
    bytes([FINAL | TEXT, FINAL | 127]) + 8 * b'\xff', bytes([FINAL | TEXT, FINAL | 127]) + struct.pack('!Q', 10 ** 9),
    frame(CLOSE, b''), frame(CLOSE, b'\x03'), frame(CLOSE, b'\0\0'), frame(TEXT, b'')], ids=range(15))
def test_a_frame_that_nobody_may_send_ends_its_own_client_alone(data, caplog):
    async def act():
        page = Page()
        good = await listener(page)
        _, writer = await asyncio.open_connection(*page.at.split(':'))
        writer.write(GREETING)
        await until(lambda: page.hub.clients == 2)
        writer.write(data)
        writer.write_eof()
        await until(lambda: page.hub.clients == 1)
        await is_served(page, good)
        writer.close()
    run(act)
    assert not caplog.records


def test_pongs_and_pings_between_the_pieces_of_a_message_change_nothing():
    async def act():
        page = Page()
        text = b'{"op":"subscribe","topic":"/map"}'
        _, writer = await asyncio.open_connection(*page.at.split(':'))
        writer.write(GREETING + bytes([TEXT]) + frame(TEXT, text[:9])[1:] + frame(PING, b'x') + frame(PONG, b'')
                     + frame(CONTINUATION, text[9:]))
        await until(lambda: page.hub.feeds and page.hub.feeds['/map'].has_listeners)
        writer.close()
    run(act)


def test_idle_and_slow_connections_and_clients_that_do_not_read_keep_nobody_out():
    async def act():
        page = Page(connections=60)
        good = await listener(page)
        others = []
        deaf = GREETING + frame(TEXT, b'{"op":"subscribe","topic":"/map"}')
        for start in (*250 * [b''], *100 * [b'GET / HT'], *50 * [deaf]):
            _, writer = await asyncio.wait_for(asyncio.open_connection(*page.at.split(':')), TIMEOUT)
            writer.write(start)
            others.append(writer)
        await until(lambda: page.hub.clients == 51)
        assert (await answer(page, request())).startswith(b'HTTP/1.1 200 ')
        await is_served(page, good)
        for writer in others:
            writer.close()
        await until(lambda: page.hub.clients == 1)
    run(act)


def test_of_too_many_connections_the_oldest_that_ask_for_nothing_are_closed(monkeypatch):
    monkeypatch.setattr('rumba_viewer.page.door.MOST', 10)

    async def act():
        page = Page()
        good = await listener(page)
        idle = [await asyncio.open_connection(*page.at.split(':')) for _ in range(20)]
        assert (await answer(page, request())).startswith(b'HTTP/1.1 200 ')
        assert await asyncio.wait_for(idle[0][0].read(), TIMEOUT) == b''
        assert len(page.hub.addresses.find('127.0.0.1').streams) <= 10
        await is_served(page, good)
        for _, writer in idle:
            writer.close()
    run(act)


def test_new_connections_are_accepted_when_those_before_them_are_paid_for(monkeypatch):
    monkeypatch.setattr('rumba_viewer.page.door.CONNECTION', 0.2)

    async def act():
        page = Page()
        begin = page.hub.now()
        writers = [(await asyncio.open_connection(*page.at.split(':')))[1] for _ in range(5)]
        await until(lambda: len(page.hub.addresses.find('127.0.0.1').streams) == 5)
        assert page.hub.now() - begin > 0.9 * (0.2 - AT_ONCE) / OF_CONNECTIONS
        for writer in writers:
            writer.close()
    run(act)


def test_of_too_many_requests_that_wait_the_oldest_are_dropped_and_those_that_left_cost_nothing(monkeypatch):
    monkeypatch.setattr('rumba_viewer.page.door.MOST_ASKING', 10)

    async def act():
        page = Page()
        here = page.hub.addresses.find('127.0.0.1')
        here.account.pay(page.hub.now(), 0.7)
        connections = []
        for number in range(30):
            connections.append(await asyncio.open_connection(*page.at.split(':')))
            connections[-1][1].write(request())
            await until(lambda: len(here.asking) == min(number + 1, 10))
        assert await asyncio.wait_for(connections[0][0].read(), TIMEOUT) == b''
        for _, writer in connections[-9:]:
            writer.close()
        await until(lambda: len(here.asking) == 1)
        assert (await asyncio.wait_for(connections[-10][0].read(), TIMEOUT)).startswith(b'HTTP/1.1 200 ')
    run(act)


def test_what_is_thrown_away_is_paid_for_like_a_new_connection(monkeypatch):
    monkeypatch.setattr('rumba_viewer.page.client.PIECE', 0.1)

    async def act():
        page = Page()
        _, writer = await asyncio.open_connection(*page.at.split(':'))
        writer.write(GREETING)
        await until(lambda: page.hub.clients == 1)
        good = await listener(page)
        writer.write(bytes([FINAL | TEXT, FINAL | 127]) + struct.pack('!Q', 10 ** 7) + 10 ** 6 * b' ')
        await until(lambda: page.hub.turns.pause() > 0.2)
        await is_served(page, good)
        writer.close()
    run(act)
