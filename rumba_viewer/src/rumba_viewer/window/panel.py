"""The panel beside the floor: the card of the selected robot, and buttons."""

from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple

from PyQt5.QtCore import QEvent, QRectF, QSize, Qt, QTimer
from PyQt5.QtGui import QIcon, QPainter, QPalette
from PyQt5.QtWidgets import QGridLayout, QLabel, QPushButton, QScrollArea, QVBoxLayout, QWidget

from rumba_viewer.painting.paint_status import paint_status, status_height
from rumba_viewer.scene.acts import BY_NAME, simulated, speeds_with
from rumba_viewer.scene.snapshot import Snapshot
from rumba_viewer.scene.wording import span
from rumba_viewer.window.controls import Button, Choice
from rumba_viewer.window.floor_view import theme_of
from rumba_viewer.window.icons import icon

WIDTH = 322  # [pixels]
EDGE = 8  # [pixels]
SPACING = 5  # [pixels] between rows
ICON = 12  # [pixels] side of an icon
FRAME = 3  # letters that are as wide as the frame of a button
LIST = 7  # letters in a list
LETTERS = {'pause': 10, 'step': 6, 'record': 8, 'report': 8}  # as wide as the icon and the longest text
STRATEGIES, SPEED = 'strategies', 'speeds'  # lists among the buttons
GROUPS = (  # of buttons, by name, with their headings
    ('Mission', (('clean', STRATEGIES), ('resume_cleaning', 'go_there'), ('dock', 'undock', 'cancel'))),
    ('View and save', (('laser', 'path', 'fit', 'legend'), ('field', 'save'), ('record', 'report'))),
    ('', (('more',),)))
MORE = 'Time and robot', (('pause', 'step', SPEED), ('brushes', 'next_robot', 'reset'))  # shown when asked for
MAIN = 'clean'  # the most prominent button
RECORDS = ('record', 'report')  # buttons that show how long they are pressed
SWITCHES = ('laser', 'path', 'field', *RECORDS, 'legend', 'more')  # buttons that stay pressed


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
        robot = snapshot.robot
        self.setToolTip(robot.mission.message if robot is not None and robot.mission is not None else '')
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
        self.strategies = Choice(['default', *strategies])
        self.speeds = Choice()
        self._speeds: List[float] = []  # that the list offers
        self._icons: Dict[str, str] = {}
        self.speeds.activated.connect(lambda index: set_speed(self._speeds[index]))
        column = QVBoxLayout(inside)
        column.setContentsMargins(EDGE, EDGE, EDGE, EDGE)
        column.setSpacing(SPACING)
        column.addWidget(self.card)
        for group in GROUPS:
            self._add(column, group, act)
        self._more = QWidget()
        self._more.setVisible(False)
        hidden = QVBoxLayout(self._more)
        hidden.setContentsMargins(0, 0, 0, 0)
        hidden.setSpacing(SPACING)
        self._add(hidden, MORE, act)
        column.addWidget(self._more)
        column.addStretch(1)
        self.setWidget(inside)
        self.setWidgetResizable(True)
        self.setFrameShape(QScrollArea.NoFrame)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarAlwaysOff)
        self.setFocusPolicy(Qt.NoFocus)
        self.setFixedWidth(WIDTH + 2 * EDGE)
        self._emphasise()

    def sizeHint(self) -> QSize:  # noqa: N802 (Qt's name)
        """High enough not to scroll."""
        size: QSize = self.widget().sizeHint()
        return size

    def _add(self, column: QVBoxLayout, group: Tuple[str, Sequence[Sequence[str]]], act: Callable[[str], None]) -> None:
        """Add a heading, if there is one, and rows of buttons."""
        heading, rows = group
        if heading:
            column.addWidget(_heading(heading))
        for row in rows:
            column.addLayout(self._row(row, act))

    @property
    def shows_more(self) -> bool:
        """Whether the buttons of MORE are shown."""
        return not self._more.isHidden()

    def switch_more(self) -> None:
        """Show or hide the buttons of MORE."""
        self._more.setVisible(not self.shows_more)
        if self.shows_more:
            QTimer.singleShot(0, lambda: self.ensureWidgetVisible(self._more))  # once they have their place

    def keyPressEvent(self, event: Any) -> None:  # noqa: N802 (Qt's name)
        """Leave the arrows to the robot."""
        event.ignore()

    def _row(self, names: Sequence[str], act: Callable[[str], None]) -> QGridLayout:
        row = QGridLayout()
        row.setSpacing(6)
        lists = {STRATEGIES: self.strategies, SPEED: self.speeds}
        for index, name in enumerate(names):
            row.addWidget(lists[name] if name in lists else self._button(name, act), 0, index)
            letters = LIST if name in lists else LETTERS.get(name, len(BY_NAME[name].label))
            row.setColumnStretch(index, FRAME + letters)
        return row

    def _button(self, name: str, act: Callable[[str], None]) -> QPushButton:
        button = Button(BY_NAME[name].label)
        button.setCheckable(name in SWITCHES)
        button.clicked.connect(lambda: act(name))
        button.setIconSize(QSize(ICON, ICON))
        self.buttons[name] = button
        return button

    def changeEvent(self, event: Any) -> None:  # noqa: N802 (Qt's name)
        """Colour the main button and the icons as the palette is."""
        super().changeEvent(event)
        if event.type() == QEvent.PaletteChange:
            self._icons = {}
            self._emphasise()

    def _emphasise(self) -> None:
        theme = theme_of(self.palette())
        self.buttons[MAIN].setStyleSheet(
            f'QPushButton {{ background: {theme.main}; color: {theme.card}; font-weight: bold; border: none; '
            f'border-radius: 4px; padding: 6px; }} QPushButton:disabled {{ background: {theme.trough}; '
            f'color: {theme.faint_text}; }} QPushButton:pressed {{ background: {theme.text}; }} '
            f'QPushButton:focus {{ border: 2px solid {theme.text}; }}')

    def _show_icon(self, button: str, name: str) -> None:
        """Show an icon on a button; empty: none."""
        if self._icons.get(button) != name:
            self._icons[button] = name
            shown = self.buttons[button]
            shown.setIcon(icon(name, shown.palette().color(QPalette.ButtonText)) if name else QIcon())

    def show_snapshot(self, snapshot: Snapshot, checked: Dict[str, bool], recorded: Dict[str, float]) -> None:
        """Show a new snapshot.

        Args:
            snapshot: what to show.
            checked: whether a switch is on, by its name.
            recorded: how long each of RECORDS is by now [s].
        """
        self.card.show_snapshot(snapshot)
        for name, button in self.buttons.items():
            act = BY_NAME[name]
            lacks = act.lacks(snapshot)
            button.setEnabled(not lacks)
            button.setToolTip(f'{act.label}: {lacks}' if lacks else f'{act.tip} [{act.key}]')
            if button.isCheckable():
                button.setChecked(checked[name])
        is_paused = snapshot.simulation.is_paused
        self.buttons['pause'].setText('Unpause' if is_paused else 'Pause')
        self._show_icon('pause', 'play' if is_paused else 'pause')
        self._show_icon('step', 'step')
        for name in RECORDS:
            self.buttons[name].setText(span(recorded[name]) if checked[name] else BY_NAME[name].label)
            self._show_icon(name, 'stop' if checked[name] else 'record')
        self.strategies.setEnabled(self.buttons['clean'].isEnabled())
        self.strategies.setToolTip('cleaning strategy')
        lacks = simulated(snapshot)
        self.speeds.setEnabled(not lacks)
        self.speeds.setToolTip(f'speed: {lacks}' if lacks else 'times real time [- +]')
        self._show_speed(snapshot.simulation.wanted)

    def _show_speed(self, wanted: Optional[float]) -> None:
        """Offer the usual speeds and the present one, and show that."""
        offered = speeds_with(wanted)
        if offered != self._speeds:
            self._speeds = offered
            self.speeds.clear()
            self.speeds.addItems([_speed_text(speed) for speed in offered])
        self.speeds.setCurrentIndex(offered.index(wanted) if wanted is not None else -1)

    @property
    def strategy(self) -> str:
        """The chosen strategy; empty: the default of the cleaner."""
        return self.strategies.currentText() if self.strategies.currentIndex() > 0 else ''


def _heading(text: str) -> QLabel:
    label = QLabel(text)
    font = label.font()
    font.setPointSizeF(0.85 * font.pointSizeF())
    label.setFont(font)
    return label


def _speed_text(speed: float) -> str:
    return f'{speed:g} \u00d7' if speed else 'maximum'
