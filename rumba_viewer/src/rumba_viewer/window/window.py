"""The window: floor and panel, keys, buttons and mouse; asks for snapshots, and hands what is to be done on."""

import pathlib
import time
from typing import Any, Callable, Dict, NamedTuple, Optional, Sequence

from PyQt5.QtCore import QEvent, Qt, QTimer
from PyQt5.QtWidgets import QHBoxLayout, QWidget

from rumba_sim.model.geometry import Pose
from rumba_viewer.scene.acts import ACTS, BY_NAME, Steering, cleaner, next_speed, robot
from rumba_viewer.scene.snapshot import Snapshot
from rumba_viewer.window.files import new_file
from rumba_viewer.window.floor_view import FloorView
from rumba_viewer.window.keyboard import Keyboard
from rumba_viewer.window.panel import Panel
from rumba_viewer.window.recorder import RATE, Recorder

PERIOD = 33  # [ms] from one picture to the next, at least
COMMAND_PERIODS = (0.02, 0.1)  # [s] of the wall clock from one command to the next: least, usual
COMMAND_AGE = 0.25  # [s] of simulated time that a command may be old: half of what stops a robot
NOTICE = 6.0  # [s] for which a line is shown
KEYS = {**{act.key: act.name for act in ACTS}, '=': 'faster', '?': 'legend'}  # = is + without Shift
CLOSE = ('Ctrl+Q', 'Ctrl+W')


class Options(NamedTuple):
    """How the window works.

    Attributes:
        linear, angular: speeds at which keys drive [m/s], [rad/s].
        folder: where pictures are saved; empty: the user's.
        strategies: cleaning strategies to offer.
        shows_laser: whether to begin with the laser shown.
    """

    linear: float
    angular: float
    folder: str
    strategies: Sequence[str]
    shows_laser: bool


class Window(QWidget):
    """Shows what a source tells, and has an actor act."""

    def __init__(self, source: Any, actor: Any, options: Options, snapshot: Snapshot) -> None:
        """Begin with a snapshot.

        Args:
            source: has `has_news`, `snapshot` and `attend`, as `Listener`.
            actor: has a method for each thing to do, as `Actor`.
            options: how to work.
            snapshot: to show until the source has one.
        """
        super().__init__()
        self.snapshot = snapshot
        self._source, self._actor, self._options = source, actor, options
        self._shows_laser = options.shows_laser
        self._steering = Steering()
        self.keyboard = Keyboard(self._on_press, self._on_release)
        self._recorder: Optional[Recorder] = None
        self._notice_until = 0.0
        self.floor = FloorView(snapshot)
        self.panel = Panel(snapshot, options.strategies, self.act, actor.set_speed)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(0)
        row.addWidget(self.floor, 1)
        row.addWidget(self.panel)
        self.setWindowTitle('Rumba')
        self.setFocusPolicy(Qt.StrongFocus)
        self.floor.clicked.connect(self._go_to)
        self.floor.robot_clicked.connect(self._take)
        self.floor.robot_put.connect(self._put)
        self._timers = [self._timer(PERIOD, self.update_picture), self._timer(1000 // RATE, self._record_picture)]
        self._commands = self._timer(round(1000 * COMMAND_PERIODS[1]), self._command)
        self._show()

    def _timer(self, period: int, act: Any) -> QTimer:
        """A timer of the wall clock [ms]."""
        timer = QTimer(self)
        timer.setTimerType(Qt.PreciseTimer)
        timer.timeout.connect(act)
        timer.start(period)
        return timer

    # --- what is shown ------------------------------------------------------------------------------------------------

    def update_picture(self) -> None:
        """Show what is the case now, where that is new."""
        now = time.monotonic()
        while not self._actor.notices.empty():
            self.tell(self._actor.notices.get())
        if self.floor.notice and now > self._notice_until:
            self.floor.show_notice('')
        if self._source.has_news(now):
            self.snapshot = self._source.snapshot(now)
            self._show()

    def _show(self) -> None:
        self.floor.show_snapshot(self.snapshot)
        self.panel.show_snapshot(self.snapshot, {
            'laser': self._shows_laser, 'path': self.floor.scene.shows_path, 'field': self.floor.scene.shows_field,
            'record': self._recorder is not None, 'legend': self.floor.shows_legend})

    def tell(self, notice: str) -> None:
        """Show a line for a while."""
        self._notice_until = time.monotonic() + NOTICE
        self.floor.show_notice(notice)

    # --- what is done -------------------------------------------------------------------------------------------------

    def act(self, name: str) -> None:
        """Do what a key or a button says, or tell why not."""
        lacks = BY_NAME[name].lacks(self.snapshot)
        if lacks:
            self.tell(f'{BY_NAME[name].label}: {lacks}')
        else:
            self._deeds()[name]()
        self._show()

    def _deeds(self) -> Dict[str, Callable[[], None]]:
        """What to do, by the names of ACTS."""
        actor, snapshot = self._actor, self.snapshot
        return {
            'clean': lambda: actor.clean(self.panel.strategy), 'dock': actor.dock, 'undock': actor.undock,
            'cancel': actor.cancel, 'pause': actor.resume if snapshot.simulation.is_paused else actor.pause,
            'step': actor.step, 'reset': actor.reset,
            'brushes': lambda: actor.set_brushes_up(not snapshot.robot.brushes_up),
            'slower': lambda: self._change_speed(-1), 'faster': lambda: self._change_speed(1),
            'laser': self._laser, 'path': self.floor.switch_path, 'field': self.floor.switch_field,
            'legend': self.floor.switch_legend, 'fit': self.floor.fit, 'next_robot': self._next_robot,
            'save': self._save, 'record': self._record}

    def _change_speed(self, direction: int) -> None:
        wanted = self.snapshot.simulation.wanted
        if wanted is not None:
            self._actor.set_speed(next_speed(wanted, direction))

    def _laser(self) -> None:
        self._shows_laser = not self._shows_laser
        self._source.attend(self.snapshot.selected, self._shows_laser)

    def _next_robot(self) -> None:
        names = [one.name for one in self.snapshot.robots]
        if names:
            place = names.index(self.snapshot.selected) if self.snapshot.selected in names else -1
            self._take(names[(place + 1) % len(names)])

    def _take(self, name: str) -> None:
        """Drive another robot from now on, and tell of it."""
        self.keyboard.forget()
        self._source.attend(name, self._shows_laser)
        self._actor.attend(name)

    def _go_to(self, x: float, y: float) -> None:
        lacks = cleaner(self.snapshot)
        if lacks:
            self.tell(f'Go there: {lacks}')
        else:
            self.tell(f'{self.snapshot.selected} goes to {x:.2f}, {y:.2f} m')
            self._actor.go_to(x, y)

    def _put(self, name: str, pose: Pose) -> None:
        self._actor.teleport(name, pose)

    # --- pictures -----------------------------------------------------------------------------------------------------

    def _save(self) -> None:
        try:
            self.tell(f'saved {self.save_anywhere()}')
        except OSError as error:
            self.tell(f'not saved: {error}')

    def save_anywhere(self) -> pathlib.Path:
        """Save a picture of the window under a name of its own; returns its path.

        Raises:
            OSError: it cannot be written.
        """
        path = new_file(self._options.folder, 'png')
        self.save_as(path)
        return path

    def save_as(self, path: pathlib.Path) -> None:
        """Save a picture of the window.

        Raises:
            OSError: it cannot be written.
        """
        self.floor.show_notice('')
        path.parent.mkdir(parents=True, exist_ok=True)
        if not self.grab().save(str(path), 'PNG'):
            raise OSError(f'{path}: cannot be written')

    def _record(self) -> None:
        if self._recorder is None:
            self._recorder = Recorder()
        else:
            self._end_record()

    def _record_picture(self) -> None:
        if self._recorder is not None:
            self._recorder.add(self.floor.grab().toImage())
            if self._recorder.is_full:
                self._end_record()

    def _end_record(self) -> None:
        recorder, self._recorder = self._recorder, None
        self._actor.write(recorder, new_file(self._options.folder, 'gif'))

    # --- driving ------------------------------------------------------------------------------------------------------

    def keyPressEvent(self, event: Any) -> None:  # noqa: N802 (Qt's name)
        """A key went down, or repeats."""
        self.keyboard.press(event)

    def keyReleaseEvent(self, event: Any) -> None:  # noqa: N802
        """A key went up, or repeats."""
        self.keyboard.release(event)

    def _on_press(self, key: str) -> None:
        """Drive, or do what the key says."""
        if not robot(self.snapshot) and self._steering.press(key):
            mission = self.snapshot.robot.mission
            if mission is not None and mission.is_active:
                self._actor.cancel()
                self.tell('you drive: the cleaner was told to stop')
            self._command()
        elif key == 'Esc' and self.floor.let_go():
            return
        elif key in CLOSE:
            self.close()
        elif key in KEYS:
            self.act(KEYS[key])

    def _on_release(self, key: str) -> None:
        """Stop, where no other key drives."""
        if self._steering.release(key):
            self._command()

    def focusNextPrevChild(self, _: bool) -> bool:  # noqa: N802
        """Tab is for the robots."""
        return False

    def event(self, event: Any) -> bool:
        """Stop when another window comes to the front: it gets the release of the key."""
        if event.type() == QEvent.WindowDeactivate:
            self.keyboard.forget()
        return super().event(event)

    def closeEvent(self, event: Any) -> None:  # noqa: N802
        """Leave no robot driving."""
        self.keyboard.forget()
        super().closeEvent(event)

    def _command(self) -> None:
        """Tell the wheels, as often as the robot needs to go on."""
        (linear, angular), is_due = self._steering.command()
        if is_due:
            self._actor.drive(linear * self._options.linear, angular * self._options.angular)
            least, usual = COMMAND_PERIODS
            speed = max(self.snapshot.simulation.speed or 1.0, 1.0)
            self._commands.setInterval(round(1000 * max(least, min(COMMAND_AGE / speed, usual))))
