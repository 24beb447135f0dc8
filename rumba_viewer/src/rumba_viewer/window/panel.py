"""The panel beside the floor: the card of the selected robot, and buttons."""

from typing import Any, Callable, Dict, List, Sequence

from PyQt5.QtCore import QRectF, QSize, Qt
from PyQt5.QtGui import QPainter
from PyQt5.QtWidgets import QComboBox, QGridLayout, QPushButton, QScrollArea, QVBoxLayout, QWidget

from rumba_viewer.painting.paint_status import paint_status, status_height
from rumba_viewer.scene.acts import BY_NAME, SPEEDS, simulated
from rumba_viewer.scene.snapshot import Snapshot
from rumba_viewer.window.floor_view import theme_of

WIDTH = 276  # [pixels]
EDGE = 8  # [pixels]
LONG = 12  # letters of a label that needs a wider button
ROWS = (  # of buttons, by name; an empty name stands for a list
    ('clean', ''), ('resume_cleaning', 'go_there'), ('dock', 'undock', 'cancel'), ('pause', 'step', ''),
    ('brushes', 'reset'), ('laser', 'path', 'field'), ('fit', 'next_robot'), ('save', 'record'), ('legend',))
SWITCHES = ('laser', 'path', 'field', 'record', 'legend')  # buttons that stay pressed


class StatusCard(QWidget):
    """The state of the selected robot."""

    def __init__(self, snapshot: Snapshot) -> None:
        """Show a snapshot."""
        super().__init__()
        self._snapshot = snapshot
        self.setFixedHeight(status_height(self.font()))

    def show_snapshot(self, snapshot: Snapshot) -> None:
        """Show a new snapshot."""
        self._snapshot = snapshot
        self.update()

    def paintEvent(self, _: Any) -> None:  # noqa: N802 (Qt's name)
        """Paint it."""
        painter = QPainter(self)
        painter.setFont(self.font())
        paint_status(painter, QRectF(self.rect()), self._snapshot, theme_of(self.palette()))


class Panel(QScrollArea):
    """The card and the buttons; scrolls if the window is too low.

    Attributes:
        buttons: by the names of ACTS.
        strategies: list of cleaning strategies; the first is the default of the cleaner.
        speeds: list of speeds.
    """

    def __init__(self, snapshot: Snapshot, strategies: Sequence[str], act: Callable[[str], None],
                 set_speed: Callable[[float], None]) -> None:
        """Show a snapshot; `act` is called with one of the names of ACTS."""
        super().__init__()
        inside = QWidget()
        self.card = StatusCard(snapshot)
        self.buttons: Dict[str, QPushButton] = {}
        self.strategies = _list(['default', *strategies])
        self.speeds = _list([_speed_text(speed) for speed in SPEEDS])
        self.speeds.activated.connect(lambda index: set_speed(SPEEDS[index]))
        column = QVBoxLayout(inside)
        column.setContentsMargins(EDGE, EDGE, EDGE, EDGE)
        column.setSpacing(6)
        column.addWidget(self.card)
        lists = [self.strategies, self.speeds]
        for row in ROWS:
            column.addLayout(self._row(row, lists, act))
        column.addStretch(1)
        self.setWidget(inside)
        self.setWidgetResizable(True)
        self.setFrameShape(QScrollArea.NoFrame)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarAlwaysOff)
        self.setFocusPolicy(Qt.NoFocus)
        self.setFixedWidth(WIDTH + 2 * EDGE)

    def sizeHint(self) -> QSize:  # noqa: N802 (Qt's name)
        """High enough not to scroll."""
        size: QSize = self.widget().sizeHint()
        return size

    def _row(self, names: Sequence[str], lists: List[QComboBox], act: Callable[[str], None]) -> QGridLayout:
        row = QGridLayout()
        row.setSpacing(6)
        for index, name in enumerate(names):
            row.addWidget(self._button(name, act) if name else lists.pop(0), 0, index)
            row.setColumnStretch(index, 3 if name and len(BY_NAME[name].label) > LONG else 2)
        return row

    def _button(self, name: str, act: Callable[[str], None]) -> QPushButton:
        button = QPushButton(BY_NAME[name].label)
        button.setFocusPolicy(Qt.NoFocus)  # the arrow keys are for the robot
        button.setCheckable(name in SWITCHES)
        button.setMinimumWidth(40)
        button.clicked.connect(lambda: act(name))
        self.buttons[name] = button
        return button

    def show_snapshot(self, snapshot: Snapshot, checked: Dict[str, bool]) -> None:
        """Show a new snapshot.

        Args:
            snapshot: what to show.
            checked: whether a switch is on, by its name.
        """
        self.card.show_snapshot(snapshot)
        for name, button in self.buttons.items():
            act = BY_NAME[name]
            lacks = act.lacks(snapshot)
            button.setEnabled(not lacks)
            button.setToolTip(f'{act.label}: {lacks}' if lacks else f'{act.tip} [{act.key}]')
            if button.isCheckable():
                button.setChecked(checked[name])
                button.setText(f'\u2713 {act.label}' if checked[name] else act.label)
        self.buttons['pause'].setText('Unpause' if snapshot.simulation.is_paused else 'Pause')
        self.strategies.setEnabled(self.buttons['clean'].isEnabled())
        self.strategies.setToolTip('cleaning strategy')
        lacks = simulated(snapshot)
        self.speeds.setEnabled(not lacks)
        self.speeds.setToolTip(f'speed: {lacks}' if lacks else 'times real time [- +]')
        wanted = snapshot.simulation.wanted
        self.speeds.setCurrentIndex(SPEEDS.index(wanted) if wanted in SPEEDS else -1)

    @property
    def strategy(self) -> str:
        """The chosen strategy; empty: the default of the cleaner."""
        return self.strategies.currentText() if self.strategies.currentIndex() > 0 else ''


def _list(texts: Sequence[str]) -> QComboBox:
    box = QComboBox()
    box.addItems(texts)
    box.setFocusPolicy(Qt.NoFocus)
    box.setMinimumWidth(40)
    return box


def _speed_text(speed: float) -> str:
    return f'{speed:g} \u00d7' if speed else 'maximum'
