"""Keys that go down and up, without the repetitions of a key that is held."""

import functools
from typing import Any, Callable, Dict, NamedTuple

from PyQt5.QtCore import Qt, QTimer
from PyQt5.QtGui import QKeySequence

REPEAT = 20  # [ms] within which a repeated key goes down again: an X server needs less than 1, a finger more than 20
ALONE = (Qt.Key_Shift, Qt.Key_Control, Qt.Key_Alt, Qt.Key_Meta, Qt.Key_AltGr, Qt.Key_unknown)  # no keys of their own


class _Press(NamedTuple):
    """A key that went down: its name at that time, and an object that identifies this press."""

    key: str
    mark: object


class Keyboard:
    """Tells when keys go down and up.

    X11 reports a release before each repetition of a held key, and Qt does not always recognise it as a repetition.
    Therefore a key counts as up only if it stays up for a moment.
    """

    def __init__(self, on_press: Callable[[str], None], on_release: Callable[[str], None]) -> None:
        """Call these with the name of a key, such as `Ctrl+S`, when it goes down and when it goes up."""
        self._on_press, self._on_release = on_press, on_release
        self._down: Dict[int, _Press] = {}

    @property
    def is_idle(self) -> bool:
        """Whether no key is down."""
        return not self._down

    def forget(self) -> None:
        """Release all keys: from now on another window gets their events."""
        down, self._down = self._down, {}
        for press in down.values():
            self._on_release(press.key)

    def press(self, event: Any) -> None:
        """Take an event of Qt: a key went down."""
        code = _code(event)
        before = self._down.get(code)
        key = before.key if before is not None else name(event)
        self._down[code] = _Press(key, object())
        if before is None and key:
            self._on_press(key)

    def release(self, event: Any) -> None:
        """Take an event of Qt: a key went up."""
        code = _code(event)
        press = self._down.get(code)
        if press is not None:
            QTimer.singleShot(REPEAT, functools.partial(self._let_go, code, press))

    def _let_go(self, code: int, press: _Press) -> None:
        now = self._down.get(code)
        if now is not None and now.mark is press.mark:
            del self._down[code]
            self._on_release(press.key)


def name(event: Any) -> str:
    """A key as Qt names it in English, with Ctrl if that is held too; empty for a modifier alone."""
    if event.key() in ALONE:
        return ''
    control = int(Qt.ControlModifier) if event.modifiers() & Qt.ControlModifier else 0
    return str(QKeySequence(event.key() | control).toString(QKeySequence.PortableText))


def _code(event: Any) -> int:
    """Which key it is, whatever else is held."""
    return int(event.nativeScanCode() or event.key())
