"""Blows on the page: requests, frames and operations that are spoilt, while a client that wants little is watched."""

import concurrent.futures
import contextlib
import json
import pathlib
import random
import socket
import subprocess
import sys
import time

from common import page_victim
from common.websockets import FINAL, HOST, PING, PONG, frame, greeting

from rumba_viewer.page.allow_list import AllowList, Rights
from rumba_viewer.page.conversion import to_text
from rumba_viewer.page.errors import Hostile, Refusal
from rumba_viewer.page.filling import Filler, serialised
from rumba_viewer.page.protocol import Session
from rumba_viewer.page.ros import Ros
from stress import page_inputs, wire
from stress.failure import Failure
from stress.scenarios import PAGE_PORT

HOSTILE = 10  # clients at the same time
CONNECTIONS = 60  # of each, one after the other
FRAMES, REQUESTS = 40, 15  # on one connection before one that ends it
OPERATIONS = 20_000  # without a socket
ENDS_WITHIN = 30.0  # [s] after the last byte of a connection
SLOWEST = 0.1  # [s] of CPU time for one operation
VICTIM_WITHIN = 2.0  # [s] for an answer to the victim, however busy this machine is
LAST = b'is this the last?'


def requests(ground, chance, blow):
    """Requests with broken heads, bodies and dates, many on one connection."""
    blow.say(f'{HOSTILE * CONNECTIONS} connections with spoilt requests')
    _attack(ground, chance, blow, _request)


def frames(ground, chance, blow):
    """Operations in frames of a websocket, whole and in pieces, and a frame that no client may send."""
    blow.say(f'{HOSTILE * CONNECTIONS} websockets with spoilt operations and frames')
    _attack(ground, chance, blow, _frames)


def _attack(ground, chance, blow, connect):
    """Let hostile clients connect again and again, and watch how long another client waits for its answers."""
    seeds = [chance.getrandbits(64) for _ in range(HOSTILE)]
    kinds = page_inputs.types()
    with _watched(blow), concurrent.futures.ThreadPoolExecutor(HOSTILE) as executor:
        for inputs in executor.map(lambda seed: _be_hostile(random.Random(seed), kinds, connect), seeds):
            blow.inputs += inputs


def _be_hostile(chance, kinds, connect):
    """Connect again and again; returns how many inputs that were."""
    inputs = 0
    for _ in range(CONNECTIONS):
        data, number, ends = connect(chance, kinds)
        inputs += number
        with wire.connect(HOST, PAGE_PORT) as connection, contextlib.suppress(ConnectionError):
            connection.sendall(data)
            _check_answer(_answer(connection, ends))
    return inputs


def _request(chance, _):
    """What is sent on a connection, how many inputs it is, and what the page sends last, if it does not end it."""
    good = [page_inputs.good_request(chance) for _ in range(REQUESTS)]
    return b''.join((*good, page_inputs.last_request(chance))), REQUESTS + 1, b''


def _frames(chance, kinds):
    good = [page_inputs.good_frames(chance, kinds) for _ in range(FRAMES)]
    data = b''.join((greeting(), *good, frame(LAST, PING), page_inputs.last_frames(chance)))
    return data, FRAMES + 1, bytes([FINAL | PONG, len(LAST)]) + LAST


def _answer(connection, ends):
    """What the page sends until it ends the connection, or has answered the last thing that can be answered."""
    answer, end = b'', time.monotonic() + ENDS_WITHIN
    connection.shutdown(socket.SHUT_WR)
    connection.settimeout(ENDS_WITHIN)
    with contextlib.suppress(ConnectionError):
        while not ends or ends not in answer[-100_000:]:
            part = connection.recv(1 << 18)
            if not part:
                break
            answer += part
            if time.monotonic() > end:
                raise Failure('answers', '/page', f'no end of a connection within {ENDS_WITHIN:g} s: {answer[-80:]!r}')
    return answer


def _check_answer(answer):
    for code in (b' 500 ', b' 501 ', b' 502 ', b' 503 '):
        if answer.startswith(b'HTTP/1.1' + code) or b'\nHTTP/1.1' + code in answer:
            raise Failure('answers', '/page', f'an error of its own: {answer[answer.index(code) - 8:][:200]!r}')


@contextlib.contextmanager
def _watched(blow):
    """Watch the page as long as a block by another process; its waiting times are kept in the blow."""
    victim = subprocess.Popen(
        [sys.executable, '-m', 'common.page_victim', str(PAGE_PORT)], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
        cwd=str(pathlib.Path(page_victim.__file__).parents[1]), universal_newlines=True)
    try:
        victim.stdout.readline()
        yield
        seen = victim.communicate(timeout=ENDS_WITHIN)[0].splitlines()
    except subprocess.TimeoutExpired:
        raise Failure('victim', '/page', f'a client waits for an answer for {ENDS_WITHIN:g} s') from None
    finally:
        victim.kill()
        victim.wait()
    if not seen:
        raise Failure('victim', '/page', 'a client that asked for little was disconnected')
    blow.waits.append(json.loads(seen[-1]))
    if blow.waits[-1]['worst'] > VICTIM_WITHIN:
        raise Failure('victim', '/page', f'a client waited {blow.waits[-1]["worst"]:.1f} s for an answer')


# --- without a socket -------------------------------------------------------------------------------------------------

class _Sink(Ros):
    """Does with messages what the page does, and sends them nowhere."""

    def __init__(self):
        self._filler, self._kinds = Filler(page_inputs.find, lambda: (1, 2)), {}

    def subscribe(self, client, topic, reason, demand):
        pass

    def unsubscribe(self, client, topic, reason):
        pass

    def advertise(self, client, topic, kind, latch):
        kind = kind or self._kinds.get(topic, 'nothing/Such')
        if page_inputs.find(kind) is None:
            raise Refusal(f'the type {kind} is not installed here')
        self._kinds[topic] = kind

    def unadvertise(self, client, topic):
        pass

    def publish(self, client, topic, values):
        kind = page_inputs.find(self._kinds[topic])
        data = serialised(self._filler.fill(kind(), values))
        json.loads(to_text(kind().deserialize(data)), parse_constant=_no_constant)

    def call(self, client, service, values, done, timeout):
        done(True, {})

    def serve(self, client, service, kind, ask, failed):
        ask('1', {})

    def unserve(self, client, service):
        pass

    def answer(self, client, service, request, worked, values):
        pass

    def leave(self, client):
        pass


def _no_constant(name):
    raise ValueError(f'{name} is no JSON')


def operations(_, chance, blow):
    """Operations with fields of every type, in this process: what is understood, made into bytes, and answered."""
    blow.say(f'{OPERATIONS} operations without a socket')
    kinds, replies = [*page_inputs.types(), *20 * [page_inputs.EVERYTHING._type]], []
    allowed = AllowList(**{what: ['/hostile/*'] for what in ('read', 'write', 'call', 'serve', 'get', 'set')})
    for number in range(OPERATIONS):
        if number % 100 == 0:
            session = Session(_Sink(), allowed, Rights(everything=chance.random() < 0.9), '/', None, replies.append)
            session.receive(json.dumps({'op': 'advertise', 'topic': '/hostile/a', 'type': page_inputs.EVERYTHING._type}))
        text = page_inputs.operation(chance, kinds)
        begin = time.thread_time()
        try:
            with contextlib.suppress(Hostile):
                session.receive(text)
            json.dumps(replies, allow_nan=False).encode()
        except Exception as error:
            raise Failure('session', '/page', f'{type(error).__name__}: {error}: {text[:300]!r}') from error
        if time.thread_time() - begin > SLOWEST:
            raise Failure('session', '/page', f'{time.thread_time() - begin:.3f} s of CPU time: {text[:300]!r}')
        replies.clear()
        blow.inputs += 1
