"""Blows on the page: requests, frames and operations that are spoilt, while a client that wants little is watched."""

import concurrent.futures
import contextlib
import json
import os
import pathlib
import random
import socket
import subprocess
import sys
import time

from common import page_victim
from common.websockets import FINAL, HOST, PING, PONG, frame, greeting

from stress import page_inputs, page_session, wire
from stress.failure import Failure
from stress.scenarios import PAGE_PORT

HOSTILE = 10  # clients at the same time
CONNECTIONS = 60  # of each, one after the other
FRAMES, REQUESTS = 40, 15  # on one connection before one that ends it
OPERATIONS = 40_000  # without a socket
ENDS_WITHIN = 30.0  # [s] after the last byte of a connection
VICTIM_WITHIN = 2.0  # [s] for an answer to the victim, however busy this machine is
IMPORTS = [str(folder) for folder in (pathlib.Path(page_session.__file__).parents[1],
                                      pathlib.Path(page_victim.__file__).parents[1])]
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


def operations(ground, chance, blow):
    """Operations with fields of every type, in a process of its own without a socket: see `page_session`."""
    seed = chance.getrandbits(32)
    blow.say(f'{OPERATIONS} operations without a socket')
    path = os.pathsep.join([os.environ.get('PYTHONPATH', ''), *IMPORTS])  # what is first may plant a fault
    done = subprocess.run(
        [sys.executable, page_session.__file__, str(seed), str(OPERATIONS)], stdout=subprocess.PIPE,
        universal_newlines=True, env={**ground.environment, 'PYTHONPATH': path},
        timeout=ENDS_WITHIN + OPERATIONS * page_session.SLOWEST)
    lines = done.stdout.splitlines() or [f'ended with exit code {done.returncode}']
    if done.returncode:
        raise Failure('session', '/page', lines[-1])
    blow.inputs += int(lines[-1])
