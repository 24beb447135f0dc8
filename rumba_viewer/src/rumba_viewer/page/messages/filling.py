"""Values of JSON as messages of ROS, by the rules of rosbridge v2: `conversion` back.

All that a message cannot hold is refused before any bytes are made, so that nothing half written reaches ROS.
"""

import base64
import binascii
import io
import math
from typing import Any, Callable, List, Sequence, Tuple

from rumba_sim.model.common.errors import quoted
from rumba_viewer.page.messages.conversion import BYTES, FLOATS, INTEGERS, TIMES, Kind, kind
from rumba_viewer.page.messages.errors import Refusal
from rumba_viewer.page.messages.operations import MOST_NESTED

Find = Callable[[str], Any]  # the class of a type, None if it is not installed
HEADERS = ('Header', 'std_msgs/Header', 'roslib/Header')
PARTS = ('secs', 'nsecs'), ('sec', 'nanosec')  # of a time: as ROS 1 calls them, and as ROS 2 does
SECOND = 1_000_000_000  # [ns]


def serialised(message: Any) -> bytes:
    """The bytes of a message, in a buffer of their own: rospy would leave a half in the one that all messages share.

    Raises:
        Refusal: it cannot be serialised.
    """
    buffer = io.BytesIO()
    try:
        message.serialize(buffer)
    except Exception as error:  # whatever the class of a message does with odd values
        raise Refusal(f'msg is no {message._type}: {type(error).__name__}: {error}') from None
    return buffer.getvalue()


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

    def fill_any(self, message: Any, values: Any) -> Any:
        """Set fields by a mapping, or by a list of values in their order; None: none. Returns the message.

        Raises:
            Refusal: a field is unknown, or its value does not fit.
        """
        if isinstance(values, list):
            if len(values) > len(message.__slots__):
                raise Refusal(f'there are {len(values)} values: {message._type} has {len(message.__slots__)} fields')
            values = dict(zip(message.__slots__, values))
        return self.fill(message, {} if values is None else values)

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
            return _text(value, path)
        made = default if default is not None else self._made(base, path)
        return _time(made, value, base, path) if base in TIMES else self._fill(made, value, path)

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


def _text(value: Any, path: Sequence[str]) -> str:
    _checked(value, isinstance(value, str), 'a text', path)
    try:
        value.encode()
    except UnicodeEncodeError:  # JavaScript cuts texts in the middle of a character
        raise Refusal(f'{_at(path)} is {quoted(value)}: must be a text without halves of characters') from None
    return str(value)


def _time(made: Any, value: Any, base: str, path: Sequence[str]) -> Any:
    names = next((pair for pair in PARTS if isinstance(value, dict) and value.keys() <= set(pair)), ())
    parts = [value.get(name, 0) for name in names]
    fits = bool(parts) and all(isinstance(part, int) and not isinstance(part, bool) for part in parts)
    _checked(value, fits, 'an object with the integers secs and nsecs', path)
    seconds, rest = divmod(parts[0] * SECOND + parts[1], SECOND)
    low, high = TIMES[base]
    _checked(value, low <= seconds <= high, f'from {low} to {high} s', path)
    made.secs, made.nsecs = seconds, rest
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
