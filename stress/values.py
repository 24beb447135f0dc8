"""Hostile values: messages of any type filled with what nobody should send, and bytes that are no message at all."""

import math
import struct

import genpy
import roslib.message

FLOATS = (math.nan, math.inf, -math.inf, 1e308, -1e308, 5e-324, -0.0, 0.0, 1.0, -1.0, 1e9, -1e9, 3.5, 1e-9)
FLOATS_32 = (math.nan, math.inf, -math.inf, 3e38, -3e38, 1e-45, -0.0, 0.0, 1.0, -1.0, 1e9, 3.5)
TEXTS = ('', ' ', '/', '//', '~', '..', '../../../../tmp/x', '/dev/zero', 'rumba/', 'a b', 'a\nb', '\x1b[2J\x1b[31m',
         '\0', '%s%n', "'; --", 'ü', '\u202e\u2028', '-1', 'nan', '{}', '$(id)', 'x' * 300, 'y' * 100_000)
INTEGERS = {f'{sign}int{bits}': ((0, 2 ** bits - 1) if sign else (-2 ** (bits - 1), 2 ** (bits - 1) - 1))
            for bits in (8, 16, 32, 64) for sign in ('', 'u')}
INTEGERS.update(byte=INTEGERS['int8'], char=INTEGERS['uint8'])
TIMES = {'time': (genpy.Time, (0, 1, 10 ** 9 - 1, 2 ** 31, 2 ** 32 - 1)),
         'duration': (genpy.Duration, (-2 ** 31, -1, 0, 1, 2 ** 31 - 1))}
DOUBLES = tuple(struct.pack('<d', value) for value in FLOATS) + (b'\xff' * 8, b'\xff' * 4, b'\0' * 4, b'\x7f', b'\x80')
COUNTS = (0, 0, 1, 2, 3, 7, 50)


def hostile(kind, chance):
    """A message of a class with hostile values in its fields, sometimes in one of them, sometimes in all."""
    message = kind()
    share = chance.choice((0.2, 0.5, 1.0))
    for name, field in zip(message.__slots__, message._slot_types):
        if chance.random() < share:
            setattr(message, name, _value(field, chance))
    return message


def _value(field, chance):
    if field.endswith(']'):
        element, _, size = field[:-1].rpartition('[')
        count = int(size) if size else chance.choice(COUNTS)
        if element in ('uint8', 'char'):
            return bytes(chance.randrange(256) for _ in range(count))
        return [_value(element, chance) for _ in range(count)]
    if field in ('float64', 'float32'):
        return chance.choice(FLOATS if field == 'float64' else FLOATS_32)
    if field == 'string':
        return chance.choice(TEXTS)
    if field == 'bool':
        return chance.random() < 0.5
    if field in TIMES:
        kind, values = TIMES[field]
        value = kind()
        value.secs, value.nsecs = chance.choice(values), chance.choice(values)
        return value
    if field in INTEGERS:
        low, high = INTEGERS[field]
        return chance.choice((low, high, 0, 1, low + 1, high // 2))
    return hostile(roslib.message.get_message_class('std_msgs/Header' if field == 'Header' else field), chance)


def mutated(data, chance):
    """Bytes with some of them overwritten, often by a hostile number."""
    changed = bytearray(data)
    for _ in range(chance.choice((1, 1, 2, 4))):
        if not changed:
            break
        patch = chance.choice(DOUBLES) if chance.random() < 0.7 else noise(chance, 8)
        where = chance.randrange(len(changed))
        changed[where:where + len(patch)] = patch[:len(changed) - where]
    return bytes(changed)


def noise(chance, most):
    """Random bytes, up to so many."""
    size = chance.randint(0, most)
    return chance.getrandbits(8 * size).to_bytes(size, 'little') if size else b''
