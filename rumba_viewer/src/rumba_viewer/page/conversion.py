"""Messages of ROS as values of JSON and back, by the rules of rosbridge v2.

Lists of bytes (uint8[], char[]) are base64 texts, NaN and infinities are null, a time has `secs` and `nsecs`. A message
is any object with `__slots__` and `_slot_types`, as genpy makes them; its lists may be arrays of NumPy.
"""

import base64
import binascii
import functools
import json
import math
import re
from typing import Any, Callable, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np

from rumba_sim.model.errors import quoted
from rumba_viewer.page.errors import Refusal

Find = Callable[[str], Any]  # the class of a type, None if it is not installed
INTEGERS = {f'{sign}int{bits}': (-(1 << bits - 1), (1 << bits - 1) - 1) if not sign else (0, (1 << bits) - 1)
            for sign in ('', 'u') for bits in (8, 16, 32, 64)}
INTEGERS.update(byte=INTEGERS['int8'], char=INTEGERS['uint8'])
FLOATS = ('float32', 'float64')
BYTES = ('uint8', 'char')
TIMES = ('time', 'duration')
HEADERS = ('Header', 'std_msgs/Header', 'roslib/Header')
WIDEST = 5  # characters of the text of an int8 with a comma
SMALL = np.array([list(f'{number - 256 if number > 127 else number},'.encode().ljust(WIDEST, b'\0'))
                  for number in range(256)], np.uint8)  # by the byte of the int8; filled up with zeros
MOST_NESTED = 32  # levels of a message


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


# --- from ROS -------------------------------------------------------------------------------------------------------

def to_json(message: Any) -> Any:
    """What `json.dumps` makes the text of a message from."""
    return {name: _value(getattr(message, name), kind(of))
            for name, of in zip(message.__slots__, message._slot_types)}


def to_text(message: Any) -> str:
    """The JSON of a message; for the cells of a map, `json.dumps` would take twenty times as long."""
    return '{' + ','.join(f'"{name}":{_text(getattr(message, name), kind(of))}'
                          for name, of in zip(message.__slots__, message._slot_types)) + '}'


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


# --- to ROS ---------------------------------------------------------------------------------------------------------

class Filler:
    """Fills messages with values of JSON."""

    def __init__(self, find: Find, now: Callable[[], Tuple[int, int]]) -> None:
        """Look for classes with `find`; `now` gives seconds and nanoseconds for headers that have no stamp."""
        self._find, self._now = find, now

    def fill(self, message: Any, values: Any) -> Any:
        """Set the fields that are given; the others keep their defaults. Returns the message.

        Raises:
            Refusal: a field is unknown, or its value does not fit.
        """
        return self._fill(message, values, [])

    def _fill(self, message: Any, values: Any, path: List[str]) -> Any:
        if len(path) > MOST_NESTED:
            raise Refusal(f'{_at(path)} is nested too deeply')
        if not isinstance(values, dict):
            raise Refusal(f'{_at(path)} is {quoted(values)}: must be an object with the fields of {message._type}')
        types = dict(zip(message.__slots__, message._slot_types))
        for name in values:
            if name not in types:
                raise Refusal(f'{_at([*path, str(name)])} is no field of {message._type}: it has '
                              + (', '.join(types) or 'none'))
        if message._type in HEADERS and 'stamp' not in values:
            message.stamp.secs, message.stamp.nsecs = self._now()
        for name, of in types.items():
            if name in values:
                setattr(message, name, self._value(values[name], kind(of), getattr(message, name), [*path, name]))
            elif of in HEADERS:
                self._fill(getattr(message, name), {}, [*path, name])
        return message

    def _value(self, value: Any, of: Kind, default: Any, path: List[str]) -> Any:
        if not of.is_list:
            return self._single(value, of.base, default, path)
        if of.base in BYTES and isinstance(value, str):
            return _counted(_decoded(value, path), of, path)
        if not isinstance(value, list):
            raise Refusal(f'{_at(path)} is {quoted(value)}: must be a list of {of.base}')
        _counted(value, of, path)
        found = [self._single(one, of.base, None, [*path, str(number)]) for number, one in enumerate(value)]
        return bytes(found) if of.base in BYTES else found

    def _single(self, value: Any, base: str, default: Any, path: List[str]) -> Any:
        if base in FLOATS:
            return _float(value, base, path)
        if base in INTEGERS:
            return _integer(value, base, path)
        if base == 'bool':
            return _checked(value, isinstance(value, bool), 'true or false', path)
        if base == 'string':
            return _checked(value, isinstance(value, str), 'a text', path)
        made = default if default is not None else self._made(base, path)
        return _time(made, value, path) if base in TIMES else self._fill(made, value, path)

    def _made(self, base: str, path: Sequence[str]) -> Any:
        found = self._find(base)
        if found is None:
            raise Refusal(f'{_at(path)}: the type {base} is not installed here')
        return found()


def _at(path: Sequence[str]) -> str:
    return '.'.join(path) or 'msg'


def _checked(value: Any, fits: bool, wanted: str, path: Sequence[str]) -> Any:
    if not fits:
        raise Refusal(f'{_at(path)} is {quoted(value)}: must be {wanted}')
    return value


def _float(value: Any, base: str, path: Sequence[str]) -> float:
    if value is None:
        return math.nan
    _checked(value, isinstance(value, (int, float)) and not isinstance(value, bool), 'a number', path)
    try:
        number = float(value)
    except OverflowError:
        raise Refusal(f'{_at(path)} is too large for {base}') from None
    if base == 'float32' and math.isfinite(number) and abs(number) > 3.4028235e38:
        raise Refusal(f'{_at(path)} is too large for {base}')
    return number


def _integer(value: Any, base: str, path: Sequence[str]) -> int:
    low, high = INTEGERS[base]
    fits = isinstance(value, int) and not isinstance(value, bool) and low <= value <= high
    return int(_checked(value, fits, f'an integer from {low} to {high}', path))


def _time(made: Any, value: Any, path: Sequence[str]) -> Any:
    parts = (value.get('secs', 0), value.get('nsecs', 0)) if isinstance(value, dict) else (None, None)
    fits = all(isinstance(part, int) and not isinstance(part, bool) and abs(part) < 1 << 31 for part in parts)
    _checked(value, fits, 'an object with the integers secs and nsecs', path)
    made.secs, made.nsecs = parts
    return made


def _decoded(text: str, path: Sequence[str]) -> bytes:
    try:
        return base64.b64decode(text, validate=True)
    except (binascii.Error, ValueError):
        raise Refusal(f'{_at(path)} is {quoted(text)}: must be base64') from None


def _counted(values: Any, of: Kind, path: Sequence[str]) -> Any:
    if of.length is not None and len(values) != of.length:
        raise Refusal(f'{_at(path)} has {len(values)} elements: must have {of.length}')
    return values
