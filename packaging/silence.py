"""Runs a command in a terminal of its own, passes on what it prints, and says when it was silent longest.

The exit code is that of the command, or 0 if Ctrl-C ended it since a pattern was found.
"""

import argparse
import contextlib
import fcntl
import math
import os
import pty
import re
import struct
import subprocess
import sys
import termios
import time
from typing import Callable, Dict, List, NamedTuple, Optional, TextIO

LISTED = 3  # silences
ROWS, COLUMNS = 24, 80
CTRL_C = b'\x03'


class Piece(NamedTuple):
    """What a command printed at once, and when [s since it was started]."""

    time: float
    text: str


class Recording(NamedTuple):
    """The output of a command, when it ended [s since it was started], and its exit code."""

    pieces: List[Piece]
    end: float
    code: int

    @property
    def text(self) -> str:
        """All that was printed."""
        return ''.join(piece.text for piece in self.pieces)

    def silences(self) -> List[Piece]:
        """For how long nothing was printed [s], each with what was printed before it; the longest first."""
        begins = [Piece(0.0, ''), *self.pieces]
        ends = [*(piece.time for piece in self.pieces), self.end]
        return sorted((Piece(end - begin.time, begin.text) for begin, end in zip(begins, ends)), reverse=True)


def record(command: List[str], environment: Optional[Dict[str, str]] = None, is_terminal: bool = True,
           on_piece: Callable[[Piece], bool] = lambda piece: False) -> Recording:
    """Run a command until it ends; `on_piece` returns whether to press Ctrl-C, which needs a terminal."""
    ours, theirs = pty.openpty() if is_terminal else os.pipe()
    if is_terminal:
        fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack('HHHH', ROWS, COLUMNS, 0, 0))
        command = ['setsid', '--ctty', *command]
    begin = time.monotonic()
    process = subprocess.Popen(command, stdin=theirs if is_terminal else subprocess.DEVNULL, stdout=theirs,
                               stderr=subprocess.STDOUT, env=environment)
    os.close(theirs)
    pieces: List[Piece] = []
    with contextlib.suppress(OSError):  # raised for a terminal that all have closed
        while True:
            text = os.read(ours, 65536)
            if not text:
                break
            pieces.append(Piece(time.monotonic() - begin, text.decode(errors='replace')))
            if on_piece(pieces[-1]):
                os.write(ours, CTRL_C)
    code = process.wait()
    os.close(ours)
    return Recording(pieces, time.monotonic() - begin, code)


def main() -> None:
    """Run the command of the arguments."""
    parser = argparse.ArgumentParser(description=__doc__.split('\n\n')[0])
    parser.add_argument('--log', metavar='FILE', type=argparse.FileType('w'), default=os.devnull,
                        help='gets the time of each piece of output [s]')
    parser.add_argument('--until', metavar='PATTERN', default='',
                        help='a regular expression: Ctrl-C is pressed as soon as the output has it')
    parser.add_argument('--at-most', metavar='SECONDS', type=float, default=math.inf,
                        help='if nothing is printed for longer, exit with code 1')
    parser.add_argument('command', nargs=argparse.REMAINDER)
    given = parser.parse_args()
    watch = Watch(given.until, given.log)
    done = record(given.command, on_piece=watch.take)
    until = f', {watch.found:.1f} s until {given.until!r}' if watch.found is not None else ''
    print(f'\nsilence: {done.end:.1f} s in all{until}')
    longest = done.silences()[:LISTED]
    for length, before in longest:
        print(f'silence: {length:.1f} s after {before[-60:]!r}')
    code = done.code if watch.found is None else 0
    sys.exit(code or int(longest[0].time > given.at_most))


class Watch:
    """Passes on what a command prints, and waits for a pattern in it.

    Attributes:
        found: when the pattern was there [s since the command was started]; None before.
    """

    def __init__(self, pattern: str, log: TextIO) -> None:
        """Wait for a regular expression; empty: for nothing."""
        self._pattern, self._log, self._text = pattern, log, ''
        self.found: Optional[float] = None

    def take(self, piece: Piece) -> bool:
        """Take what was printed; returns whether the pattern is there for the first time."""
        sys.stdout.write(piece.text)
        sys.stdout.flush()
        self._log.write(f'{piece.time:8.2f} {piece.text!r}\n')
        self._log.flush()
        self._text += piece.text
        if not self._pattern or self.found is not None or not re.search(self._pattern, self._text):
            return False
        self.found = piece.time
        return True


if __name__ == '__main__':
    main()
