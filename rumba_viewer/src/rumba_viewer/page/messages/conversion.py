"""Messages of ROS as values of JSON and CBOR, by the rules of rosbridge v2.

Lists of bytes (uint8[], char[]) are base64 texts, NaN and infinities are null, a time has `secs` and `nsecs`. A message
is any object with `__slots__` and `_slot_types`, as genpy makes them; its lists may be arrays of NumPy.
"""

import base64
import functools
import json
import math
import re
from typing import Any, NamedTuple, Optional

import numpy as np

INTEGERS = {f'{sign}int{bits}': (-(1 << bits - 1), (1 << bits - 1) - 1) if not sign else (0, (1 << bits) - 1)
            for sign in ('', 'u') for bits in (8, 16, 32, 64)}
INTEGERS.update(byte=INTEGERS['int8'], char=INTEGERS['uint8'])
FLOATS = ('float32', 'float64')
BYTES = ('uint8', 'char')
NUMBERS = {**{base: base for base in (*INTEGERS, *FLOATS)}, 'byte': 'int8', 'char': 'uint8'}  # as NumPy calls them
TIMES = {'time': (0, (1 << 32) - 1), 'duration': (-(1 << 31), (1 << 31) - 1)}  # [s] that fit
WIDEST = 5  # characters of the text of an int8 with a comma
SMALL = np.array([list(f'{number - 256 if number > 127 else number},'.encode().ljust(WIDEST, b'\0'))
                  for number in range(256)], np.uint8)  # by the byte of the int8; filled up with zeros


class Kind(NamedTuple):
    """The type of a field.

    Attributes:
        base: the type of one element.
        is_list: whether it is an array.
        length: of an array of fixed length.
    """

    base: str
    is_list: bool
    length: Optional[int]


@functools.lru_cache(maxsize=4096)
def kind(text: str) -> Kind:
    """The type of a field, as a definition writes it: `float64`, `float64[]`, `float64[36]`."""
    found = re.fullmatch(r'([\w/]+)(\[(\d*)\])?', text)
    if found is None:
        raise ValueError(f'{text!r} is no type of a field')
    return Kind(found.group(1), found.group(2) is not None, int(found.group(3)) if found.group(3) else None)


def to_json(message: Any) -> Any:
    """What `json.dumps` makes the text of a message from."""
    return {name: _value(getattr(message, name), kind(of))
            for name, of in zip(message.__slots__, message._slot_types)}


def to_text(message: Any) -> str:
    """The JSON of a message; for the cells of a map, `json.dumps` would take twenty times as long."""
    return '{' + ','.join(f'"{name}":{_text(getattr(message, name), kind(of))}'
                          for name, of in zip(message.__slots__, message._slot_types)) + '}'


def to_packed(message: Any) -> Any:
    """What `cbor.encoded` makes the bytes of a message from: numbers keep what JSON cannot express."""
    return {name: _packed(getattr(message, name), kind(of))
            for name, of in zip(message.__slots__, message._slot_types)}


def _packed(value: Any, of: Kind) -> Any:
    if of.is_list and of.base in BYTES:
        return bytes(value)
    if of.is_list and of.base in NUMBERS:
        return np.asarray(value, NUMBERS[of.base])
    if of.is_list:
        return [_packed(one, Kind(of.base, False, None)) for one in value]
    if of.base in FLOATS:
        return float(value)
    if hasattr(value, '_slot_types'):
        return to_packed(value)
    return _single(value, of.base)


def _text(value: Any, of: Kind) -> str:
    if of.is_list and of.base == 'int8':
        characters = SMALL[np.asarray(value, np.int8).view(np.uint8)].ravel()
        return f'[{characters[characters != 0].tobytes()[:-1].decode()}]'
    return json.dumps(_value(value, of), separators=(',', ':'), allow_nan=False)


def _value(value: Any, of: Kind) -> Any:
    if not of.is_list:
        return _single(value, of.base)
    if of.base in BYTES:
        return base64.b64encode(bytes(value)).decode('ascii')
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if of.base in FLOATS:  # x - x is NaN for all that JSON cannot express
        return [number if number - number == 0.0 else None for number in value]
    if of.base in INTEGERS:
        return list(value)
    return [_single(one, of.base) for one in value]


def _single(value: Any, base: str) -> Any:
    if base in FLOATS:
        return value if math.isfinite(value) else None
    if base == 'string':
        return value if isinstance(value, str) else bytes(value).decode('utf-8', 'replace')
    if base == 'bool':
        return bool(value)
    if base in INTEGERS:
        return value
    if base in TIMES:
        return {'secs': value.secs, 'nsecs': value.nsecs}
    return to_json(value)
