"""Buttons and lists that Tab reaches, and that leave the keys of the window to the window."""

from typing import Any, Sequence

from PyQt5.QtCore import Qt
from PyQt5.QtWidgets import QComboBox, QPushButton

NARROWEST = 40  # [pixels]
ENTER = (Qt.Key_Return, Qt.Key_Enter)
CHOOSE = (Qt.Key_Up, Qt.Key_Down, Qt.Key_Space, *ENTER)  # of a list


class Button(QPushButton):
    """A button that Space and Enter press; all other keys do what they do without it, and a click leaves the focus."""

    def __init__(self, text: str) -> None:
        """Show a text."""
        super().__init__(text)
        self.setFocusPolicy(Qt.TabFocus)
        self.setMinimumWidth(NARROWEST)

    def keyPressEvent(self, event: Any) -> None:  # noqa: N802 (Qt's name)
        """Be pressed, or leave the key to the window."""
        if event.key() == Qt.Key_Space:
            super().keyPressEvent(event)
        elif event.key() in ENTER:
            self.click()
        else:
            event.ignore()


class Choice(QComboBox):
    """A list in which arrows choose, and which Space and Enter open; all other keys do what they do without it."""

    def __init__(self, texts: Sequence[str] = ()) -> None:
        """Offer texts."""
        super().__init__()
        self.addItems(texts)
        self.setFocusPolicy(Qt.TabFocus)
        self.setMinimumWidth(NARROWEST)

    def keyPressEvent(self, event: Any) -> None:  # noqa: N802 (Qt's name)
        """Choose, open, or leave the key to the window."""
        if event.key() in ENTER:
            self.showPopup()
        elif event.key() in CHOOSE:
            super().keyPressEvent(event)
        else:
            event.ignore()
