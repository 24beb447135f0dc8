"""Keys that go down and up, without those that only repeat."""

from typing import Any, Callable, Dict, NamedTuple

from PyQt5.QtCore import Qt, QTimer
from PyQt5.QtGui import QKeySequence

REPEAT = 20  # [ms] within which a key that repeats goes down again: an X server takes less than 1, no finger so little
ALONE = (Qt.Key_Shift, Qt.Key_Control, Qt.Key_Alt, Qt.Key_Meta, Qt.Key_AltGr, Qt.Key_unknown)  # say nothing yet


class _Press(NamedTuple):
    """One of the times that a key went down: its name when it began to be held, and a mark of its own."""

    key: str
    mark: object


class Keyboard:
    """X11 lets a key that repeats go up in between, and Qt does not always see that it repeats: a key is up when it has
    been so for a moment."""

    def __init__(self, on_press: Callable[[str], None], on_release: Callable[[str], None]) -> None:
        """Call these with the name of a key, such as `Ctrl+S`, when it goes down and when it is up again."""
        self._on_press, self._on_release = on_press, on_release
        self._down: Dict[int, _Press] = {}

    @property
    def is_idle(self) -> bool:
        """Whether no key is down."""
        return not self._down

    def forget(self) -> None:
        """What happens to the keys from now on is for another window; those that are down are up."""
        down, self._down = self._down, {}
        for press in down.values():
            self._on_release(press.key)

    def press(self, event: Any) -> None:
        """Qt says that a key went down."""
        place = _place(event)
        before = self._down.get(place)
        key = before.key if before is not None else name(event)
        self._down[place] = _Press(key, object())
        if before is None and key:
            self._on_press(key)

    def release(self, event: Any) -> None:
        """Qt says that a key went up."""
        place = _place(event)
        press = self._down.get(place)
        if press is not None:
            QTimer.singleShot(REPEAT, lambda: self._let_go(place, press))

    def _let_go(self, place: int, press: _Press) -> None:
        now = self._down.get(place)
        if now is not None and now.mark is press.mark:
            del self._down[place]
            self._on_release(press.key)


def name(event: Any) -> str:
    """A key, with Ctrl where that is held beside it, as Qt names it in English; empty where it says nothing alone."""
    if event.key() in ALONE:
        return ''
    control = int(Qt.ControlModifier) if event.modifiers() & Qt.ControlModifier else 0
    return str(QKeySequence(event.key() | control).toString(QKeySequence.PortableText))


def _place(event: Any) -> int:
    """Which key it is, whatever is held beside it."""
    return int(event.nativeScanCode() or event.key())
