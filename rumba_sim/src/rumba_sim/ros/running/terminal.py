"""A terminal that returns single keys as they are typed, shows one live line, and is restored at the end."""

import os
import re
import select
import shutil
import signal
import sys
import termios
import tty
from typing import List, Tuple

from rumba_sim.model.common.errors import RumbaError

CTRL_C = '\x03'
CTRL_D = '\x04'
ESCAPE = '\x1b'
# What a terminal sends for an arrow key: this depends on its mode.
ARROWS = {introducer + letter: name for introducer in ('\x1b[', '\x1bO')
          for letter, name in zip('ABCD', ('up', 'down', 'right', 'left'))}

ONE_KEY = re.compile(r'\x1b\[[0-?]*[ -/]*[@-~]|\x1bO[@-~]|\x1b[^\x1b\[O]|.', re.DOTALL)
UNFINISHED = re.compile(r'\x1b(\[[0-?]*[ -/]*|O)?\Z')
# [s] The rest of an escape sequence may come this late over a slow line; a single Esc counts only after this time.
ESCAPE_WAIT = 0.05

TO_LINE_START_AND_ERASE = '\r\x1b[K'
HIDE_CURSOR = '\x1b[?25l'
SHOW_CURSOR = '\x1b[?25h'


def split_keys(text: str) -> Tuple[List[str], str]:
    """Split the input of a terminal into keys, and a rest that may be the beginning of another key.

    Arrow keys are `up`, `down`, `left` and `right`; every other key is what the terminal sends for it.
    """
    unfinished = UNFINISHED.search(text)
    rest = unfinished.group() if unfinished else ''
    keys = ONE_KEY.findall(text[:len(text) - len(rest)])
    return [ARROWS.get(key, key) for key in keys], rest


def width() -> int:
    """Columns of the terminal; 80 if they are not known (Python before 3.10 then returns 0)."""
    return shutil.get_terminal_size().columns or 80


class Terminal:
    """The terminal of standard input and output; the context changes its mode and restores it at the end.

    Ctrl-C and Ctrl-Z still send their signals. Lines can be printed as usual: `\\n` is still a complete line end.

    Raises:
        RumbaError: standard input or output is not a terminal.
    """

    def __init__(self) -> None:
        if not (sys.stdin.isatty() and sys.stdout.isatty()):
            raise RumbaError('needs a terminal for its input and output: start it with rosrun, or from a launch file '
                             'with output="screen"')
        self._fd = sys.stdin.fileno()
        self._found = termios.tcgetattr(self._fd)
        self._shown = ''

    def __enter__(self) -> 'Terminal':
        self._take()
        return self

    def __exit__(self, *_: object) -> None:
        self._give_back()

    def keys(self, timeout: float) -> List[str]:
        """The keys typed since the last call; waits at most `timeout` [s] if there are none.

        A terminal that was closed returns Ctrl-D.
        """
        keys, rest = split_keys(self._read(timeout))
        while rest:
            more = self._read(ESCAPE_WAIT)
            if not more:
                return keys + [rest]
            more_keys, rest = split_keys(rest + more)
            keys += more_keys
        return keys

    def show(self, line: str) -> None:
        """Put a text on the live line."""
        line = line[:width() - 1]
        if line != self._shown:
            self._write(TO_LINE_START_AND_ERASE + line)
            self._shown = line

    def print(self, text: str) -> None:
        """Print lines that stay, above the live line."""
        self._write(f'{TO_LINE_START_AND_ERASE}{text}\n')
        self._shown = ''

    def suspend(self) -> None:
        """Stop the process as Ctrl-Z does; returns when the shell continues it."""
        self._give_back()
        handler = signal.signal(signal.SIGTSTP, signal.SIG_DFL)
        os.kill(os.getpid(), signal.SIGTSTP)
        signal.signal(signal.SIGTSTP, handler)
        self._take()

    def _take(self) -> None:
        attributes = termios.tcgetattr(self._fd)
        # Ctrl-S and Ctrl-Q count as keys: otherwise Ctrl-S would stop the output while the robot drives on.
        attributes[tty.IFLAG] &= ~termios.IXON
        attributes[tty.LFLAG] &= ~(termios.ICANON | termios.ECHO | termios.IEXTEN)
        # Otherwise Ctrl-\ would end the program without restoring the terminal.
        attributes[tty.CC][termios.VQUIT] = os.fpathconf(self._fd, 'PC_VDISABLE')
        attributes[tty.CC][termios.VMIN], attributes[tty.CC][termios.VTIME] = 1, 0
        termios.tcsetattr(self._fd, termios.TCSAFLUSH, attributes)
        self._write(HIDE_CURSOR)
        self._shown = ''

    def _give_back(self) -> None:
        try:
            self._write(SHOW_CURSOR + '\n')
            # Keys that were not read yet are for the robot: the shell must not get them.
            termios.tcsetattr(self._fd, termios.TCSAFLUSH, self._found)
        except termios.error:
            pass  # the terminal was closed

    def _read(self, timeout: float) -> str:
        if not select.select([self._fd], [], [], timeout)[0]:
            return ''
        try:
            # One character per byte: all keys with a meaning are ASCII, and any other byte is a key without one.
            return os.read(self._fd, 1000).decode('latin-1') or CTRL_D
        except OSError:
            return CTRL_D

    @staticmethod
    def _write(text: str) -> None:
        try:
            print(text, end='', flush=True)
        except OSError:
            pass  # the terminal was closed, as the next read will show
