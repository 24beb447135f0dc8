"""What is quoted from the files of a submission, or from its output: it may hold anything."""

import pathlib
import re
from typing import List

MOST = 200  # characters of a quotation
MOST_OUTPUT = 8_000_000  # characters
LONGEST_LINE = 4000  # characters
COLOUR = re.compile('\033\\[[0-9;]{0,20}m')
COPY = '/src/submission/'  # in paths of the copy of a submission that is built and run


def printable(text: str, most: int = MOST) -> str:
    r"""A text as a terminal can safely show it, on one line.

    Characters that cannot be seen, or that a terminal obeys, become escape sequences: a carriage return \r, a byte of a
    file name that is no text \xff. What is too long is cut.
    """
    shown = ''.join(map(_visible, text[:most + 1]))
    return shown if len(shown) <= most else shown[:most] + '...'


def _visible(character: str) -> str:
    if character.isprintable():
        return character
    code = ord(character)
    if 0xdc80 <= code <= 0xdcff:  # a byte that could not be decoded: surrogateescape
        return f'\\x{code - 0xdc00:02x}'
    return character.encode('unicode_escape').decode('ascii')


def within_copy(path: str) -> str:
    """A path of the copy of a submission, relative to the submission; empty if it is not in the copy."""
    return path.partition(COPY)[2]


def relative(path: pathlib.Path, folder: pathlib.Path) -> str:
    """A path below a folder, relative to it, as it can be shown."""
    return printable(str(path.relative_to(folder)))


def lines_of(output: str) -> List[str]:
    """The lines of an output, without colours, as far as they are looked at."""
    return [_plain(line[:LONGEST_LINE]) for line in output[:MOST_OUTPUT].split('\n')]


def _plain(line: str) -> str:
    return COLOUR.sub('', line).rstrip('\r')
