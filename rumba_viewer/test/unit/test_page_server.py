"""The web server with real sockets and without ROS: files, origins, tokens, hostile and slow clients."""

import asyncio
import re
import socket

import pytest
from served_pages import (
    FOLDER, GREETING, PING, TIMEOUT, Page, frame, is_served, is_told_and_ended, listener, read, run, until)
from tornado.httpclient import AsyncHTTPClient, HTTPClientError

from rumba_sim.model.common.errors import ConfigError
from rumba_viewer.page.addresses import GUESSES
from rumba_viewer.page.allow_list import Tokens
from rumba_viewer.page.client import DELAY
from rumba_viewer.page.server import check_address, sockets
from rumba_viewer.page.turns import Turns


def test_every_file_that_the_page_names_is_served_with_its_type_and_nothing_else():
    async def act():
        page, fetch = Page(), AsyncHTTPClient().fetch
        index = (await fetch(f'http://{page.at}/')).body.decode()
        assert '<canvas id="floor"' in index and 'http' not in index
        for path in FOLDER.iterdir():
            if path.suffix != '.html':
                answer = await fetch(f'http://{page.at}/{path.name}')
                assert answer.body == path.read_bytes() and "default-src 'self'" in answer.headers[
                    'Content-Security-Policy']
        for path in ('/..%2fpackage.xml', '/package.xml', '/x.js', '/../setup.py'):
            with pytest.raises(HTTPClientError, match='404'):
                await fetch(f'http://{page.at}{path}')
    run(act)


def test_other_sites_and_other_names_of_this_machine_are_refused():
    async def act():
        page = Page()
        for headers in ({'Origin': 'http://evil.example'}, {'Host': 'evil.example', 'Origin': 'http://evil.example'}):
            with pytest.raises(HTTPClientError, match='403'):
                await page.open(**headers)
        (await page.open(Origin=f'http://{page.at}')).close()
    run(act)


@pytest.mark.parametrize('message, words', [
    ('{"op": ', 'is no JSON'), ('[1]', 'must be a JSON object'), (10_000_000 * 'x', 'too big'),
    (70_000 * 'x', 'too big')], ids=['no JSON', 'no operation', '10 MB', 'over the bound'])
def test_hostile_input_ends_its_own_client_with_a_status(message, words):
    async def act():
        page = Page()
        good, bad = await listener(page), await page.open()
        sending = asyncio.ensure_future(bad.write_message(message))
        sending.add_done_callback(lambda future: future.exception())
        await is_told_and_ended(bad, words)
        await is_served(page, good)
    run(act)


def test_a_flood_of_messages_ends_its_own_client():
    async def act():
        page = Page(rate=10.0)
        good, bad = await listener(page), await page.open()
        for _ in range(30):
            await bad.write_message('{"op": "status"}')
        await is_told_and_ended(bad, 'too many messages: at most 10 in a second')
        await is_served(page, good)
    run(act)


@pytest.mark.parametrize('tokens, message, words', [
    (Tokens(), '[' + 1001 * '0,' + '0]', 'a message can have 1000 values at most'),
    (Tokens('secret'), '"' + 9000 * '.' + '"', 'without a token a message can have 8192 bytes at most')],
    ids=['values', 'bytes of a watcher'])
def test_a_message_that_is_too_large_for_its_client_is_refused_and_not_even_read(tokens, message, words):
    async def act():
        page = Page(tokens, elements=1000)
        client = await listener(page)
        await client.write_message(message)
        assert words in (await read(client))['msg']
        await is_served(page, client)
        assert page.noted == [f'client at 127.0.0.1: {words}']
    run(act)


@pytest.mark.parametrize('bounds, words', [
    ({'elements': 100}, '100 values in a second'), ({'bandwidth': 2000}, '2000 bytes in a second'),
    ({'share': 1e-3}, '0.1 % of a core')], ids=lambda value: value if isinstance(value, str) else '')
def test_a_client_that_uses_more_than_it_may_is_slowed_down_and_told_which_bound_it_is(bounds, words):
    async def act():
        page = Page(**bounds)
        good, greedy = await listener(page), await page.open()
        for _ in range(150):
            await greedy.write_message('{"op": "status", "id": [' + 40 * '0,' + '0]}')
        assert (await read(greedy))['msg'] == f'you are slowed down: a client may use {words}'
        await is_served(page, good)
        assert page.hub.clients == 2
    run(act)


def test_frames_of_one_packet_are_read_one_in_a_turn(monkeypatch):
    """Ten thousand pings in one packet took half a second, in which nobody else was served."""
    asked = []
    monkeypatch.setattr(Turns, 'ask', lambda turns, account, begin: asked.append(begin))

    async def act():
        page = Page()
        _, writer = await asyncio.open_connection(*page.at.split(':'))
        writer.write(GREETING)
        await until(lambda: asked)
        asked.pop()()
        await until(lambda: page.hub.clients)
        writer.write(100 * frame(PING, b''))
        for _ in range(5):
            await until(lambda: asked)
            assert len(asked) == 1
            asked.pop()()
        writer.close()
    run(act)


def test_a_thousand_connections_are_told_that_there_are_too_many_and_the_first_is_served():
    async def act():
        page = Page(connections=20)
        good = await listener(page)
        served, refused = [await page.open() for _ in range(19)], []
        for _ in range(40):
            refused += await asyncio.gather(*(page.open() for _ in range(25)))
        for client in refused:
            await is_told_and_ended(client, 'has 20 clients already')
        await is_served(page, good)
        for client in served:
            client.close()
        await until(lambda: page.hub.clients == 1)
        assert (await listener(page)) is not None
    run(act)


def test_a_wrong_token_ends_the_connection_and_none_lets_watch():
    async def act():
        page = Page(Tokens('secret'))
        begin = page.hub.now()
        await is_told_and_ended(await page.open('?token=guess'), 'wrong token')
        assert page.hub.now() - begin >= DELAY
        await is_told_and_ended(await page.open('?token=%ff'), 'the token is no text')
        watching, driving = await listener(page), await page.open('?token=secret')
        await is_served(page, watching)
        await watching.write_message('{"op": "advertise", "topic": "/rumba/cmd_vel", "type": "geometry_msgs/Twist"}')
        assert 'needs a token' in (await read(watching))['msg']
        assert [re.sub('[:,].*', '', line.partition(': ')[2]) for line in page.noted] == [
            'disconnected', 'disconnected', '/rumba/cmd_vel needs a token']
        driving.close()
    run(act)


def test_after_many_wrong_tokens_not_even_the_right_one_is_tried():
    async def act():
        page = Page(Tokens('secret'))
        guesses = await asyncio.gather(*(page.open(f'?token=guess{number}') for number in range(GUESSES)))
        for client in guesses:
            await is_told_and_ended(client, 'wrong token')
        await is_told_and_ended(await page.open('?token=guess0'), 'wrong token')
        await is_told_and_ended(await page.open('?token=secret'), 'too many wrong tokens came from 127.0.0.1')
        assert await listener(page)
    run(act)


def test_a_client_that_does_not_read_loses_messages_and_slows_nobody():
    async def act():
        page = Page()
        good = await listener(page)
        [first] = page.hub.feeds['/map']._listeners
        slow = socket.create_connection(page.at.split(':'))
        slow.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        slow.sendall(f'GET / HTTP/1.1\r\nHost: {page.at}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-'
                     'Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n'.encode())
        text = b'{"op":"subscribe","topic":"/map"}'
        slow.sendall(bytes([0x81, 0x80 | len(text), 0, 0, 0, 0]) + text)
        await until(lambda: len(page.hub.feeds['/map']._listeners) == 2)
        [victim] = set(page.hub.feeds['/map']._listeners) - {first}
        for number in range(200):
            page.arrive(b'%06d' % number + 50_000 * b'.')
            assert int((await read(good))['msg'][:6]) == number
        assert victim.lost > 100 and sum(map(len, victim._waiting.values())) <= 20
        slow.close()
        await until(lambda: page.hub.clients == 1)
    run(act)


def test_others_can_reach_it_only_if_changes_need_a_token():
    check_address('127.0.0.1', Tokens())
    check_address('0.0.0.0', Tokens('secret'))
    with pytest.raises(ConfigError, match='address is 0.0.0.0, which others can reach: give a token:= too'):
        check_address('0.0.0.0', Tokens())
    with pytest.raises(ConfigError, match='must be an address of this machine'):
        check_address('http://x', Tokens())


def test_a_port_that_is_taken_is_named():
    taken, = sockets('127.0.0.1', 0)
    with pytest.raises(ConfigError, match='cannot serve at 127.0.0.1, port .*: choose another port:='):
        sockets('127.0.0.1', taken.getsockname()[1])
    taken.close()


def test_a_change_of_the_clock_of_the_system_moves_no_bound(monkeypatch):
    async def act():
        hub = Page().hub
        before = hub.now()
        monkeypatch.setattr('time.time', lambda: 0.0)
        assert 0.0 <= hub.now() - before < TIMEOUT
    run(act)
