"""CBOR (RFC 8949), as rosbridge compresses: arrays of numbers are packed (RFC 8746), so that nobody parses them."""

import struct
from typing import Any

import numpy as np

UNSIGNED, NEGATIVE, BYTES, TEXT, ARRAY, MAP, TAG = range(7)  # major types
SIMPLE = {False: b'\xf4', True: b'\xf5', None: b'\xf6'}
DOUBLE = struct.Struct('>Bd')
PACKED = {'uint8': 64, 'uint16': 69, 'uint32': 70, 'uint64': 71, 'int8': 72, 'int16': 77, 'int32': 78, 'int64': 79,
          'float32': 85, 'float64': 86}  # tags of little-endian arrays


def encoded(value: Any) -> bytes:
    """A value of JSON, in which there may also be bytes and arrays of NumPy of one dimension."""
    found = bytearray()
    _put(value, found)
    return bytes(found)


def _put(value: Any, to: bytearray) -> None:
    if value is None or isinstance(value, bool):
        to += SIMPLE[value]
    elif isinstance(value, int):
        to += _head(UNSIGNED, value) if value >= 0 else _head(NEGATIVE, -1 - value)
    elif isinstance(value, float):
        to += DOUBLE.pack(0xfb, value)
    elif isinstance(value, str):
        data = value.encode()
        to += _head(TEXT, len(data)) + data
    elif isinstance(value, bytes):
        to += _head(BYTES, len(value)) + value
    elif isinstance(value, np.ndarray):
        data = value.astype(value.dtype.newbyteorder('<')).tobytes()
        to += _head(TAG, PACKED[value.dtype.name]) + _head(BYTES, len(data)) + data
    elif isinstance(value, dict):
        to += _head(MAP, len(value))
        for key, one in value.items():
            _put(key, to)
            _put(one, to)
    else:
        to += _head(ARRAY, len(value))
        for one in value:
            _put(one, to)


def _head(major: int, number: int) -> bytes:
    """The first bytes of an item: what it is, and its value or length."""
    first = major << 5
    if number < 24:
        return bytes([first | number])
    for extra, form in ((24, '>BB'), (25, '>BH'), (26, '>BI')):
        if number < 1 << 8 * (struct.calcsize(form) - 1):
            return struct.pack(form, first | extra, number)
    return struct.pack('>BQ', first | 27, number)
