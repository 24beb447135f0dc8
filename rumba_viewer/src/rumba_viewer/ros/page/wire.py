"""From serialised messages to the texts that clients get."""

import base64
import json
import math
import struct
import zlib
from typing import Any, Callable, Dict, Optional, Tuple

import numpy as np

from rumba_sim.model.common.errors import one_line
from rumba_viewer.page.client import framed
from rumba_viewer.page.feeds import Arrival
from rumba_viewer.page.messages import cbor, conversion
from rumba_viewer.ros.page.rosapi import types

LARGEST = 4_000_000  # [bytes] of a serialised message; a larger one is not handed on
FAST = 1  # level of zlib: of the coverage of the map apartment, 450 kB, it leaves 20 kB in 1 ms; Pillow takes 3 to 5 ms


class _Numpy:
    """NumPy as genpy expects it: `bool` was missing in some versions, and genpy asks for it."""

    def __getattr__(self, name: str) -> Any:
        return np.bool_ if name == 'bool' else getattr(np, name)


NUMPY = _Numpy()


class Encoder:
    """Makes frames of messages, and tells of each trouble once."""

    def __init__(self, warn: Callable[[str], object], now: Callable[[], Tuple[int, int]]) -> None:
        """Tell of what cannot be made by `warn`; `now` gives seconds and nanoseconds."""
        self._warn, self._now = warn, now
        self._told: Dict[str, str] = {}  # by topic

    def encode(self, arrival: Arrival, topic: str, compression: str) -> Optional[bytes]:
        """The frame with a message of a topic; None if it cannot be made."""
        trouble = self._trouble(arrival, compression)
        if not trouble:
            try:
                return self._frame(arrival, topic, compression)
            except Exception as error:  # whatever a publisher sent
                trouble = f'{type(error).__name__}: {error}'
        if self._told.get(topic) != trouble:
            self._told[topic] = trouble
            self._warn(one_line(f'{topic} is not shown: {trouble}'))
        return None

    def _frame(self, arrival: Arrival, topic: str, compression: str) -> bytes:
        if compression == 'cbor-raw':
            seconds, rest = self._now()
            return packed(topic, {'secs': seconds, 'nsecs': rest, 'bytes': arrival.data})
        message = types.of_message(arrival.type)().deserialize_numpy(arrival.data, NUMPY)
        if compression == 'cbor':
            return packed(topic, conversion.to_packed(message))
        return written(topic, conversion.to_text(message), compression)

    def _trouble(self, arrival: Arrival, compression: str) -> str:
        if len(arrival.data) > LARGEST:
            return f'a message has {len(arrival.data)} bytes: at most {LARGEST} can be handed on'
        if compression == 'cbor-raw':
            return ''
        found = types.of_message(arrival.type)
        if found is None:
            return f'the type {arrival.type} is not installed here'
        if arrival.md5 not in ('*', found._md5sum):
            return f'{arrival.publisher} has another definition of {arrival.type} than this machine'
        return ''


def framed_values(topic: str, values: Any, compression: str) -> bytes:
    """The frame with a message that is no message of ROS, but values of JSON."""
    if compression.startswith('cbor'):
        return packed(topic, values)
    return written(topic, json.dumps(values, separators=(',', ':')), compression)


def packed(topic: str, values: Any) -> bytes:
    """The frame with a message in CBOR."""
    return framed(cbor.encoded({'op': 'publish', 'topic': topic, 'msg': values}))


def written(topic: str, values: str, compression: str) -> bytes:
    """The frame with a message of which there is the JSON."""
    text = f'{{"op":"publish","topic":{json.dumps(topic)},"msg":{values}}}'
    return framed(json.dumps({'op': 'png', 'data': png(text)}) if compression == 'png' else text)


def png(text: str) -> str:
    """A text as rosbridge compresses it: its bytes are the colours of a picture, filled up with line ends; base64."""
    data = text.encode()
    width = max(math.isqrt(len(data) // 3), 1)
    height = math.ceil(len(data) / (3 * width))
    data = data.ljust(3 * width * height, b'\n')
    rows = b''.join(b'\0' + data[start:start + 3 * width] for start in range(0, len(data), 3 * width))
    head = struct.pack('!IIBBBBB', width, height, 8, 2, 0, 0, 0)
    picture = _chunk(b'IHDR', head) + _chunk(b'IDAT', zlib.compress(rows, FAST)) + _chunk(b'IEND', b'')
    return base64.b64encode(b'\x89PNG\r\n\x1a\n' + picture).decode()


def _chunk(kind: bytes, data: bytes) -> bytes:
    """A chunk of a PNG file: its specification, section 5.3."""
    return struct.pack('!I', len(data)) + kind + data + struct.pack('!I', zlib.crc32(kind + data))
