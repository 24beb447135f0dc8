"""The last row of a terminal, kept for one live line while other processes print above it."""

import os
import shutil
from typing import List, Tuple

SAVE, RESTORE = '\x1b7', '\x1b8'  # the place of the cursor
ERASE_LINE, ERASE_REST = '\x1b[2K', '\x1b[K'
WHOLE = '\x1b[r'  # the whole terminal scrolls
FEWEST_ROWS = 4  # with fewer there is no live line


class BottomLine:
    """A live line that no log line is glued to: the rows above it scroll, it does not.

    Everything goes out in one write, since other processes write to the same terminal.
    """

    def __init__(self, fd: int) -> None:
        """Use the terminal of a file descriptor, as it is."""
        self._fd = fd
        self._size = (0, 0)  # columns and rows for which the rows above were set to scroll

    def show(self, lines: List[str]) -> None:
        """Show the first of these lines that fits the terminal; else the last, cut to its width."""
        columns, rows = size = _size()
        if rows < FEWEST_ROWS:
            return
        line = next((line for line in lines if len(line) < columns), lines[-1])
        begin = '' if size == self._size else self._reserve(rows)
        self._size = size
        self._write(f'{begin}{SAVE}\x1b[{rows};1H{ERASE_LINE}{line[:columns - 1]}{RESTORE}')

    def say(self, lines: List[str]) -> None:
        """Print lines that stay, above the live line."""
        self._write('\r' + ERASE_REST + ''.join(f'{line}\n' for line in lines))

    def close(self) -> None:
        """Give the row back."""
        if self._size != (0, 0):
            self._write(f'{SAVE}{WHOLE}\x1b[{self._size[1]};1H{ERASE_LINE}{RESTORE}')
        self._size = (0, 0)

    def _reserve(self, rows: int) -> str:
        """What has all rows but the last scroll; the cursor goes up by one, in case it is in the last one."""
        return f'\n{SAVE}\x1b[1;{rows - 1}r{RESTORE}\x1b[1A'

    def _write(self, text: str) -> None:
        try:
            os.write(self._fd, text.encode(errors='replace'))
        except OSError:
            pass  # the terminal was closed


def _size() -> Tuple[int, int]:
    """Columns and rows; 0 rows if they are not known."""
    columns, rows = shutil.get_terminal_size((80, 0))
    return columns or 80, rows
