"""Lines that the window shows for a while."""

import time
from typing import Callable, List, Tuple

from rumba_sim.model.common.errors import one_line

DURATION = 6.0  # [s] for which a line is shown
MAX_LINES = 2  # that are shown at the same time


class Notices:
    """The last lines, each only once."""

    def __init__(self, show: Callable[[str], None]) -> None:
        """Start with no line; `show` is called with all lines when they change."""
        self._show = show
        self._lines: List[Tuple[str, float]] = []  # and until when they are shown

    def tell(self, line: str) -> None:
        """Show a line for a while, below the last one; a long one is cut."""
        line = one_line(line)
        others = [(text, until) for text, until in self._lines if text != line]
        self._replace([*others, (line, time.monotonic() + DURATION)][-MAX_LINES:])

    def retract(self, beginning: str) -> None:
        """Remove lines by their beginning."""
        self._replace([(text, until) for text, until in self._lines if not text.startswith(beginning)])

    def expire(self) -> None:
        """Remove lines whose time is over."""
        now = time.monotonic()
        self._replace([(text, until) for text, until in self._lines if now <= until])

    def _replace(self, lines: List[Tuple[str, float]]) -> None:
        if lines != self._lines:
            self._lines = lines
            self._show('\n'.join(text for text, _ in lines))
