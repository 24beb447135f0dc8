"""Hostile inputs of the page: requests, frames of websockets, and operations of rosbridge with fields of every type."""

import base64
import json
import re

import genmsg.msgs
import genpy.dynamic
import roslib.message
import rosmsg
import rospkg
from common.websockets import BINARY, CLOSE, CONTINUATION, FINAL, HOST, MASKED, PING, PONG, TEXT, frame, greeting

from stress.values import TEXTS, noise

LARGEST = 60_000  # characters of an operation
PACKAGES = ('std_msgs', 'geometry_msgs', 'nav_msgs', 'sensor_msgs', 'actionlib_msgs', 'diagnostic_msgs', 'tf2_msgs',
            'rosgraph_msgs', 'trajectory_msgs', 'visualization_msgs', 'rumba_msg')
NAMES = ('/rumba/cmd_vel', '/rumba/odom', '/rumba/scan', '/map', '/tf', '/rumba/clean/goal', '/rumba/clean/cancel',
         'rumba/coverage', '/rosout', '/rosapi/topics', '/rosapi/get_time', '/rosapi/get_param',
         '/rosapi/message_details', '/rosapi/services', '/rosapi/service_type', '/simulator/get_loggers',
         '/rumba/set_brushes_up', '/hostile/a', '/hostile/b', '/tf2_web_republisher/goal')
OPERATIONS = ('advertise', 'unadvertise', 'publish', 'subscribe', 'unsubscribe', 'call_service', 'advertise_service',
              'unadvertise_service', 'service_response', 'set_level', 'status', 'fragment', 'png', 'auth',
              'send_action_goal', 'nothing', '')
KEYS = ('topic', 'type', 'id', 'msg', 'service', 'args', 'values', 'result', 'latch', 'level', 'compression',
        'throttle_rate', 'queue_length', 'fragment_size', 'timeout', 'newest')
OWN = {'topic': NAMES, 'service': NAMES, 'level': ('none', 'error', 'warning', 'info'),
       'compression': ('none', 'png', 'cbor', 'cbor-raw')}
BUILTIN = (*genmsg.msgs.BUILTIN_TYPES, 'std_msgs/Header', 'geometry_msgs/Point32')
# Installed messages have no field of some types, such as bool[].
EVERYTHING = genpy.dynamic.generate_dynamic('hostile/Everything', '\n'.join(
    f'{kind}{ending} {re.sub("[^a-z0-9]", "_", kind.lower())}_{number}' for kind in BUILTIN
    for number, ending in enumerate(('', '[]', '[3]'))) + ''.join(
        f'\n{80 * "="}\nMSG: {kind}\n{roslib.message.get_message_class(kind)._full_text}' for kind in BUILTIN[-2:]))[
            'hostile/Everything']
NUMBERS = (0, 1, -1, 255, 256, 2 ** 31, 2 ** 32 - 1, -2 ** 63, 2 ** 64, 10 ** 400, 0.5, -0.0, 1e308, 1e-320,
           float('nan'), float('inf'), -float('inf'))
LONE = '\ud83d'
PATHS = ('/', '/app.js', '/style.css', '/..%2fpackage.xml', '/%00', '/' + 3000 * 'a', '/?token=x', '/?token=%ff', '//',
         '*', 'http://evil.example/', '/app.js/..', '/.')
HEADERS = ('Host', 'Origin', 'Upgrade', 'Connection', 'Sec-WebSocket-Version', 'Sec-WebSocket-Key', 'Range', 'Cookie',
           'Sec-WebSocket-Extensions', 'Sec-WebSocket-Protocol', 'If-Modified-Since', 'If-None-Match',
           'Accept-Encoding', 'Expect', 'Content-Length', 'Transfer-Encoding', 'Content-Type', 'X-Forwarded-For',
           'Authorization')
VALUES = ('localhost', HOST, 'evil.example', 'websocket', 'Upgrade', 'keep-alive', '13', '-1', '0', '5', 'chunked',
          'gzip', 'permessage-deflate; client_max_window_bits=99', 'Mon, 01 Jan 99999 00:00:00 GMT', 'bytes=0-0',
          'bytes=-9999', 'bytes=5-1', 'bytes=x-', '"' + 200 * 'e' + '"', '100-continue', '[::1', 'null', '', '\x7f',
          'a=b; c=%ff')


def find(kind):
    """The class of a type of message; None if it is not installed."""
    return EVERYTHING if kind == EVERYTHING._type else roslib.message.get_message_class(kind)


def types():
    """Names of the messages of common packages: between them, they have fields of every type."""
    pack = rospkg.RosPack()
    return sorted(f'{package}/{name}' for package in PACKAGES if package in pack.list()
                  for _, folder in rosmsg.iterate_packages(pack, '.msg') if folder.endswith(f'/{package}/msg')
                  for name in rosmsg.list_msgs(package, rospack=pack) for name in [name.partition('/')[2]])


def operation(chance, kinds):
    """The text of an operation, of which each part may be wrong; `kinds` are names of messages."""
    choice = chance.random()
    if choice < 0.02:
        return _spoilt(chance, chance.choice(TEXTS))
    fields = {'op': chance.choice(OPERATIONS)}
    for key in chance.sample(KEYS, chance.randint(2, 7)):
        fields[key] = chance.choice(OWN[key]) if key in OWN and chance.random() < 0.8 else anything(chance)
    if fields['op'] in ('publish', 'advertise') or choice < 0.3:
        kind = chance.choice(kinds)
        fields.update(type=kind, msg=message(chance, kind))
        fields.setdefault('topic', chance.choice(NAMES))
    text = json.dumps(fields, ensure_ascii=chance.random() < 0.5)[:LARGEST]
    return _spoilt(chance, text) if choice > 0.95 else text


def _spoilt(chance, text):
    """A text with a piece left out or doubled."""
    start, size = chance.randint(0, len(text)), chance.randint(1, 20)
    piece = chance.choice(('', 2 * text[start:start + size], '[' * 500, '{"a":' * 300))
    return text[:start] + piece + text[start + size:]


def anything(chance, depth=0):
    """Any value of JSON."""
    choice = chance.randrange(8 if depth < 3 else 5)
    if choice == 0:
        return chance.choice((None, True, False))
    if choice == 1:
        return chance.choice(NUMBERS)
    if choice < 5:
        return chance.choice((*TEXTS[:-1], LONE, 'a' + LONE, *NAMES))
    if choice == 5:
        return [anything(chance, depth + 1) for _ in range(chance.choice((0, 1, 3, 30)))]
    if choice == 6:
        return {chance.choice((*KEYS, '', 'x', 'secs')): anything(chance, depth + 1)
                for _ in range(chance.randint(0, 4))}
    nested = anything(chance, depth + 1)
    for _ in range(chance.choice((1, 30, 30 if depth else 850))):
        nested = [nested]
    return nested


def message(chance, kind):
    """Values of a type of message, mostly of the right type, often at the edge of what fits."""
    found = find(kind)
    return {name: anything(chance) if chance.random() < 0.1 else _field(chance, of)
            for name, of in zip(found.__slots__, found._slot_types) if chance.random() < 0.7}


def _field(chance, of):
    base, is_list, size = genmsg.msgs.parse_type(of)
    if is_list:
        if base in ('uint8', 'char') and chance.random() < 0.7:
            return base64.b64encode(noise(chance, 20)).decode()
        return [_field(chance, base) for _ in range(chance.choice((size or 0, size or 3, 1, 12)))]
    if base in ('time', 'duration'):
        parts = chance.choice((('secs', 'nsecs'), ('sec', 'nanosec'), ('secs', 'nanosec')))
        return {part: chance.choice(NUMBERS[:9]) for part in parts}
    if base == 'string':
        return chance.choice((*TEXTS[:-1], LONE))
    if base == 'bool':
        return chance.choice((True, False, 0, 1))
    if genmsg.msgs.is_builtin(base):
        return chance.choice((None, *NUMBERS)) if base.startswith('float') else chance.choice((*NUMBERS[:5], 7))
    return message(chance, 'std_msgs/Header' if base == 'Header' else base)


# --- frames -----------------------------------------------------------------------------------------------------------

def good_frames(chance, kinds):
    """Frames that a library could send, and that leave the connection open: one message, whole or in pieces."""
    data = operation(chance, kinds).encode(errors='surrogatepass').decode(errors='replace').encode()
    if chance.random() < 0.05:
        return frame(noise(chance, 100), chance.choice((PING, PONG)))
    if chance.random() < 0.9 or len(data) < 3:
        return frame(data)
    cut = chance.randint(1, len(data) - 1)
    return (frame(data[:cut], TEXT, 0) + (frame(b'x', PING) if chance.random() < 0.5 else b'')
            + frame(data[cut:], CONTINUATION))


def last_frames(chance):
    """Frames that nobody may send."""
    return chance.choice((
        lambda: frame(noise(chance, 500), TEXT), lambda: frame(noise(chance, 500), BINARY),
        lambda: frame(b'{}', TEXT, FINAL | 0x10 * chance.randint(1, 7)), lambda: frame(b'{}', chance.randint(3, 7)),
        lambda: frame(b'{}', TEXT, masked=0), lambda: frame(b'', CONTINUATION), lambda: frame(b'x' * 200, PING),
        lambda: frame(b'x', PING, 0), lambda: frame(b'{', TEXT, 0) + frame(b'}', TEXT),
        lambda: bytes([FINAL | TEXT, MASKED | 127]) + noise(chance, 20), lambda: noise(chance, 300),
        lambda: frame(chance.choice((b'', b'\x03', b'\x03\xe8', b'\x00\x00\xff', b'\xff\xff' + 123 * b'x')), CLOSE),
        lambda: frame(70_000 * b' '), lambda: bytes([FINAL | TEXT, MASKED | 126, 0xff])))()


# --- requests ---------------------------------------------------------------------------------------------------------

def good_request(chance):
    """A request that leaves the connection open, whatever its answer is."""
    headers = {'Host': 'localhost', **{chance.choice(HEADERS[6:11]): chance.choice(VALUES) for _ in range(3)}}
    headers.pop('Sec-WebSocket-Extensions', None)
    return _head('GET', chance.choice(PATHS[:8]), '1.1', headers)


def last_request(chance):
    """A request of which each part may be wrong."""
    if chance.random() < 0.1:
        return noise(chance, 2000)
    headers = {chance.choice((*HEADERS, TEXTS[chance.randrange(11)])): chance.choice((*VALUES, *TEXTS[:-1]))
               for _ in range(chance.choice((0, 3, 10, 500)))}
    head = _head(chance.choice(('GET', 'POST', 'HEAD', 'PUT', 'OPTIONS', 'CONNECT', '', 'get', 'X' * 300)),
                 chance.choice(PATHS), chance.choice(('1.1', '1.0', '0.9', '2.0', '')), headers)
    body = chance.choice((b'', b'-5\r\n', b'5\r\nhello\r\n0\r\n\r\n', noise(chance, 100)))
    spoilt = bytearray(head + body)
    if chance.random() < 0.3 and spoilt:
        spoilt[chance.randrange(len(spoilt))] = chance.randrange(256)
    return bytes(spoilt) if chance.random() < 0.9 else greeting('', 'localhost') + body


def _head(method, path, version, headers):
    lines = [f'{method} {path} HTTP/{version}', *(f'{name}: {value}' for name, value in headers.items()), '', '']
    return '\r\n'.join(lines).encode('latin-1', 'replace')
