"""Messages as anybody could send them: each field with values that make no sense, as they come off the wire."""

import copy
import io
import math
import random
import unittest.mock

import genpy
import numpy as np

NUMBERS = (math.nan, math.inf, -math.inf, 1e300, -1e300, 3e38, 5e-324, -1.0, 0.0, 0.5, 1e9, 127, 255, -128, 2 ** 31 - 1,
           2 ** 32 - 1, 2 ** 63 - 1)
TEXTS = ('', '\0', 'two\nlines\x1b[2J', 'x' * 100_000, '/', '/dev/zero', 'a b', '\u202e\U0001f600', '/' * 300)
LENGTHS = (0, 1, 7, 5000)
BATCH = 200  # of messages in which several fields are odd


def all_of(good, seed):
    """A good message with each field odd in turn, then with several fields odd, drawn from a seed."""
    places = list(_places(good))
    for place, values in places:
        for value in values:
            yield from _received(_changed(good, {place: value}))
    chance = random.Random(seed)
    for _ in range(BATCH if places else 0):
        chosen = chance.sample(places, chance.randint(2, max(len(places) // 2, 2)) if len(places) > 1 else 1)
        yield from _received(_changed(good, {place: chance.choice(values) for place, values in chosen}))


def _places(message, path=()):
    """Each field of a message by its path, with odd values for it."""
    for name, kind in zip(message.__slots__, message._slot_types):
        value = getattr(message, name)
        if isinstance(value, genpy.Message):
            yield from _places(value, (*path, name))
        elif kind == 'time':
            yield (*path, name), [genpy.Time(0, 0), genpy.Time(2 ** 32 - 1, 999_999_999)]
        elif kind == 'duration':
            yield (*path, name), [genpy.Duration(0, 0), genpy.Duration(2 ** 31 - 1, 999_999_999)]
        elif kind == 'string':
            yield (*path, name), TEXTS
        elif kind == 'bool':
            yield (*path, name), (False, True)
        elif kind.endswith(']') and '/' in kind:  # of messages
            yield (*path, name), [[], *([odd] for odd in (all_of(value[0], 0) if value else ()))]
        elif kind.endswith(']'):
            number = 0 if kind.startswith(('int', 'uint')) else math.nan
            arrays = [length * [number] for length in (LENGTHS if kind.endswith('[]') else [len(value)])]
            is_array = isinstance(value, np.ndarray)
            yield (*path, name), [np.array(array, value.dtype) if is_array else array for array in arrays]
        else:
            is_whole = kind.startswith(('int', 'uint'))
            yield (*path, name), [number for number in NUMBERS if not is_whole or isinstance(number, int)]


def _changed(good, values):
    message = copy.copy(good)
    for path, value in values.items():
        part = message
        for name in path[:-1]:  # what is changed is copied; the rest is only read
            setattr(part, name, copy.copy(getattr(part, name)))
            part = getattr(part, name)
        setattr(part, path[-1], value)
    return message


def _received(message):
    """The message as a subscriber gets it; nothing if it cannot be sent."""
    data, received = io.BytesIO(), type(message)()
    try:
        with unittest.mock.patch.object(genpy.Message, '__str__', object.__repr__):  # genpy writes it into its errors
            _write(message, data)
        if _is_numpy(message):
            received.deserialize_numpy(data.getvalue(), np)
        else:
            received.deserialize(data.getvalue())
    except (genpy.SerializationError, OverflowError, ValueError):
        return
    yield received


def _write(message, data):
    if _is_numpy(message):
        message.serialize_numpy(data, np)
    else:
        message.serialize(data)


def _is_numpy(message):
    return type(message).__name__.startswith('Numpy')
