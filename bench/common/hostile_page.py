"""Clients that do their worst to the page, each kind within its limits or beyond them; a process of its own.

The arguments are the port, the kind, how many clients, and what follows the `/` of the address.
"""

import asyncio
import itertools
import random
import sys

from common import websockets
from common.websockets import CONTINUATION, EIGHT, FINAL, HOST, MASKED, PING, TEXT, frame, greeting, text

RATE = 95.0  # messages of a client in a second: within the limits
LARGEST = 65000  # [bytes] of a message, within the limits
ROSAPI = ('topics', 'services', 'nodes', 'get_param_names', 'topics_and_raw_types')
ALLOWED = '/hostile'  # a topic that the page was told to allow


def filled(start, part, end=''):
    """A message as long as possible: a start, parts, and an end."""
    return frame((start + part * ((LARGEST - len(start) - len(end)) // len(part)) + end).encode())


LISTS = filled('{"op":"x","id":[', '[],', '0]}')
DEEP = frame(b'{"op":"publish","topic":"/rumba/cmd_vel","msg":' + 950 * b'[' + 950 * b']' + b'}')
NUMBERS = filled(f'{{"op":"publish","topic":"{ALLOWED}","msg":{{"data":[', '7,', '7]}}')
FEWER = frame(f'{{"op":"publish","topic":"{ALLOWED}","msg":{{"data":[{19990 * "7,"}7]}}}}'.encode())
KEYS = frame(('{"op":"x",' + ','.join(f'"{number}":{number}' for number in range(4500)) + '}').encode())
REPEATED = filled('{"op":"x"', ',"a":0', '}')
TEXTS = filled('{"op":"status","id":"', '\\u00e4', '"}')
MAPS = b''.join(text(op=op, topic='/map', newest=True, compression='png') for op in ('unsubscribe', 'subscribe'))
OTHERS = b''.join(text(op=op, topic='/rumba/cmd_vel', type='geometry_msgs/Twist')
                  for op in ('advertise', 'unadvertise'))
CALLS = b''.join(text(op='call_service', service=f'/rosapi/{name}', id='x') for name in ROSAPI)
PAGE = f'GET / HTTP/1.1\r\nHost: {HOST}\r\n\r\n'.encode()
HEADS = f'GET /app.js HTTP/1.1\r\nHost: {HOST}\r\n'.encode() + b''.join(b'a%d:0\r\n' % n for n in range(1000)) + b'\r\n'


def new_topics():
    """Subscriptions to topics that nobody publishes."""
    for number in itertools.count():
        yield b''.join(text(op='subscribe', topic=f'/robot{number}x{other}/scan') for other in range(10))


# By name: what is sent again and again, and how: `rate` messages in a second, or as fast as possible; on one connection
# until it ends, or each time on a new one; with or without reading what comes; as a websocket or not.
KINDS = {
    'lists of lists, within the rate': (LISTS, {'rate': RATE}),
    'lists of lists': (LISTS, {}),
    'deep lists': (DEEP, {'rate': RATE}),
    'a message of numbers, within the rate': (FEWER, {'rate': RATE}),
    'messages of numbers': (NUMBERS, {}),
    'objects of many fields': (KEYS, {'rate': RATE}),
    'one field many times': (REPEATED, {'rate': RATE}),
    'texts': (TEXTS, {'rate': RATE}),
    'pings': (200 * frame(b'', PING), {}),
    'pings without reading': (200 * frame(120 * b'x', PING), {'reads': False}),
    'frames without end': (frame(b'', TEXT, 0) + 1000 * frame(b'', CONTINUATION, 0), {}),
    'a message of ten megabytes': (frame(10 ** 7 * b' '), {'is_new': True}),
    'an announced exabyte': (bytes([FINAL | TEXT, MASKED | EIGHT]) + 8 * b'\x7f' + LARGEST * b'x', {'is_new': True}),
    'the map again and again': (MAPS, {'rate': RATE / 2}),
    'the map without reading': (MAPS, {'rate': RATE / 2, 'reads': False}),
    'new topics': (new_topics, {'rate': RATE / 10}),
    'topics advertised and taken back': (OTHERS, {'rate': RATE / 2}),
    'questions about topics': (CALLS, {'rate': RATE / len(ROSAPI)}),
    'new websockets': (LISTS, {'is_new': True}),
    'wrong tokens': (b'', {'is_new': True, 'guesses': True}),
    'requests': (100 * PAGE, {'is_websocket': False}),
    'new requests': (PAGE, {'is_websocket': False, 'is_new': True}),
    'long heads': (HEADS, {'is_websocket': False}),
    'noise': (b'', {'is_websocket': False, 'is_new': True, 'noise': 3000}),
}


async def attack(port, query, chance, data, rate=0.0, is_new=False, reads=True, is_websocket=True, noise=0,
                 guesses=False):
    """Be one hostile client for ever."""
    while True:
        try:
            reader, writer = await asyncio.open_connection(HOST, port)
        except OSError:
            await asyncio.sleep(0.01)
            continue
        reading = asyncio.ensure_future(read(reader)) if reads else None
        try:
            if is_websocket:
                writer.write(greeting(f'?token={chance.random()}' if guesses else query))
            for part in data() if callable(data) else itertools.repeat(data):
                writer.write(part or chance.getrandbits(8 * noise + 8).to_bytes(noise + 1, 'little'))
                await writer.drain()
                if is_new or reading is not None and reading.done():
                    break
                await asyncio.sleep(1.0 / rate if rate else 0.0)
            if is_new and reading is not None:
                await asyncio.wait([reading], timeout=0.05)
        except OSError:
            pass
        finally:
            writer.close()
            if reading is not None:
                reading.cancel()


async def read(reader):
    """Read until the end."""
    try:
        while await reader.read(1 << 16):
            pass
    except OSError:
        pass


async def main():
    """Attack until this process is ended."""
    port, kind, clients, query = int(sys.argv[1]), sys.argv[2], int(sys.argv[3]), sys.argv[4]
    data, options = KINDS[kind]
    if data is NUMBERS or data is FEWER:
        first = websockets.Client(port, query)
        first.send(op='advertise', topic=ALLOWED, type='std_msgs/Int32MultiArray')
    print('ready', flush=True)
    await asyncio.gather(*(attack(port, query, random.Random(number), data, **options) for number in range(clients)))


if __name__ == '__main__':
    asyncio.run(main())
