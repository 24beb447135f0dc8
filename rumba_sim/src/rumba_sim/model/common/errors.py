"""Errors of this package; each message says in one line what is wrong, where, and what would be right.

Text from files, parameters and other nodes becomes part of messages: `quoted` and `one_line` make it short and
harmless.
"""

import reprlib
from typing import Any

LONGEST = 300  # [characters] of a message
LONGEST_QUOTE = 80  # [characters]
OMITTED = '...'
LARGE = 10 ** 100  # a larger whole number is not written out: Python refuses to write more than 4300 digits
DIGITS_PER_BIT = 0.30103


def one_line(text: str, longest: int = LONGEST) -> str:
    """A text as one short line: control characters are escaped as in Python, the middle of a long text is left out."""
    text = _cut(text, longest)
    if text.isprintable():
        return text
    return _cut(''.join(char if char.isprintable() else repr(char)[1:-1] for char in text), longest)


def _cut(text: str, longest: int) -> str:
    if len(text) <= longest:
        return text
    tail = longest // 3
    return text[:longest - tail - len(OMITTED)] + OMITTED + text[-tail:]


def quoted(value: Any) -> str:
    """A value for a message, as Python writes it, but short; this takes no longer for a large or deep value."""
    return one_line(_SHORT.repr(value), LONGEST_QUOTE)


class _Short(reprlib.Repr):
    """Writes only the first elements and levels of a value."""

    def __init__(self) -> None:
        super().__init__()
        self.maxlevel = 2
        self.maxstring = self.maxother = LONGEST_QUOTE

    def repr_int(self, x: int, level: int) -> str:
        """A whole number, or how many digits it has."""
        return repr(x) if abs(x) < LARGE else f'a number of {x.bit_length() * DIGITS_PER_BIT:.0f} digits'


_SHORT = _Short()


class RumbaError(Exception):
    """Base class of all errors that this package raises on purpose."""

    def __init__(self, message: str) -> None:
        """Keep the message as one short line."""
        super().__init__(one_line(message))


class ConfigError(RumbaError):
    """A setting is unknown, of the wrong type, or out of its range."""


class MapError(RumbaError):
    """A map cannot be read, or a robot does not fit at a pose on it."""


class CommandError(RumbaError):
    """No robot can follow a command."""


class WorldError(RumbaError):
    """The world cannot do what was requested: a name is taken or unknown, or a position is not free."""


class StrategyError(RumbaError):
    """No cleaning strategy has this name, or more than one would have it."""
