"""The window: floor and panel, keys, buttons and mouse; it asks for snapshots, and passes on what is to be done."""

import dataclasses
import math
import time
from typing import Any, Callable, Dict, NamedTuple, Optional, Sequence, Tuple

from PyQt5.QtCore import QEvent, Qt, QTimer
from PyQt5.QtWidgets import QHBoxLayout, QWidget

from rumba_sim.model.common.geometry import Pose
from rumba_viewer.scene.acts import ACTS, BY_NAME, Act, Steering, next_speed, robot, way
from rumba_viewer.scene.map_frame import SAME, on_map
from rumba_viewer.scene.snapshot import Point, Snapshot
from rumba_viewer.window.floor_view import FloorView
from rumba_viewer.window.keyboard import Keyboard
from rumba_viewer.window.notices import Notices
from rumba_viewer.window.panel import Panel
from rumba_viewer.window.pictures import Pictures
from rumba_viewer.window.recorder import RATE
from rumba_viewer.window.reports import Reports

PERIOD = 33  # [ms] from one picture to the next, at least
COMMAND_PERIODS = (0.02, 0.1)  # [s] of the wall clock from one command to the next: least, usual
COMMAND_AGE = 0.25  # [s] of simulated time that a command may be old: half of what stops a robot
CONFIRM = 4.0  # [s] within which a person must ask a second time for what loses something
KEYS = {**{act.key: act.name for act in ACTS}, 'Return': 'go_there', '?': 'legend',
        '=': 'faster'}  # = is + without Shift
TARGET = 'Target'  # with this begins the notice about one
CLOSE = ('Ctrl+Q', 'Ctrl+W')


class Options(NamedTuple):
    """Settings of the window.

    Attributes:
        linear, angular: speeds at which keys drive [m/s], [rad/s].
        folder: where pictures are saved; empty: the default of `new_file`.
        strategies: cleaning strategies to offer.
        shows_laser: whether the laser is shown at first.
    """

    linear: float
    angular: float
    folder: str
    strategies: Sequence[str]
    shows_laser: bool


class Window(QWidget):
    """Shows the snapshots of a source, and makes an actor act.

    Attributes:
        snapshot: what is shown.
        pictures: saves what is shown.
        reports: records missions.
        tell: shows a line for a while.
    """

    def __init__(self, source: Any, actor: Any, options: Options, snapshot: Snapshot) -> None:
        """Start with a snapshot.

        Args:
            source: has `has_news`, `snapshot` and `select`, such as `Listener`.
            actor: has a method for each thing to do, such as `Actor`.
            options: settings of the window.
            snapshot: what to show until the source has news.
        """
        super().__init__()
        self.snapshot = snapshot
        self._source, self._actor, self._options = source, actor, options
        self._shows_laser = options.shows_laser
        self._steering = Steering()
        self.keyboard = Keyboard(self._on_press, self._on_release)
        self._asked: Tuple[str, float] = '', -math.inf  # what a person asked for once, and until when twice counts
        self.floor = FloorView(snapshot)
        self._notices = Notices(self.floor.show_notice)
        self.tell = self._notices.tell
        self.panel = Panel(snapshot, options.strategies, self.act, self._set_speed)
        self.pictures = Pictures(self, self.floor, options.folder, self.tell, actor.write)
        self.reports = Reports(options.folder, actor)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(0)
        row.addWidget(self.floor, 1)
        row.addWidget(self.panel)
        self.setWindowTitle('Rumba')
        self.setFocusPolicy(Qt.StrongFocus)
        self.setFocus()  # not a button
        self.floor.clicked.connect(self._choose_target)
        self.floor.double_clicked.connect(self._go_to)
        self.floor.robot_clicked.connect(self._select)
        self.floor.robot_put.connect(self._put)
        self._timers = [self._timer(PERIOD, self.update_picture), self._timer(1000 // RATE, self.pictures.add_frame)]
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
        """Show the news, if there are any."""
        now = time.monotonic()
        while not self._actor.notices.empty():
            self.tell(self._actor.notices.get())
        self._notices.expire()
        was_asked = self.reports.is_asked
        self.reports.follow(self.snapshot)
        if self.pictures.is_recording or was_asked:  # while nothing else happens, its time goes on
            self._show()
        if self._source.has_news(now):
            new = self._source.snapshot(now)
            is_same_map = _map_number(new) == _map_number(self.snapshot)
            self.snapshot = dataclasses.replace(new, target=self.snapshot.target if is_same_map else None)
            self._show()

    def _show(self) -> None:
        self.floor.hint = self.reports.hint
        self.floor.show_snapshot(self.snapshot)
        self.panel.show_snapshot(self.snapshot, {
            'laser': self._shows_laser, 'path': self.floor.scene.shows_path, 'field': self.floor.scene.shows_field,
            'record': self.pictures.is_recording, 'report': self.reports.is_asked,
            'legend': self.floor.shows_legend, 'more': self.panel.shows_more},
            {'record': self.pictures.recorded, 'report': self.reports.recorded})

    # --- what is done -------------------------------------------------------------------------------------------------

    def act(self, name: str) -> None:
        """Do what a key or a button stands for, or tell why it is not available."""
        act = BY_NAME[name]
        lacks = act.lacks(self.snapshot)
        if lacks:
            self.tell(f'{act.label}: {lacks}')
        elif self._is_confirmed(act):
            self._methods()[name]()
        self._show()

    def _is_confirmed(self, act: Act) -> bool:
        """Whether it may be done now: at once, or, if something is lost by it, when it is asked for twice."""
        now = time.monotonic()
        name, until = self._asked
        self._asked = '', -math.inf
        if not act.warning or act.name == name and now <= until:
            return True
        self._asked = act.name, now + CONFIRM
        self.tell(f'{act.label}: {act.warning}; press it again to confirm')
        return False

    def _methods(self) -> Dict[str, Callable[[], Any]]:
        """What to call, by the names of ACTS."""
        actor, snapshot = self._actor, self.snapshot
        simulator, is_paused = snapshot.simulation.node, snapshot.simulation.is_paused
        brushes_up = snapshot.robot is not None and bool(snapshot.robot.brushes_up)
        return {
            'clean': lambda: actor.clean(self.panel.strategy), 'resume_cleaning': actor.resume_cleaning,
            'go_there': lambda: self._go_to(*snapshot.target) if snapshot.target is not None else None,
            'dock': lambda: self._interrupt('dock', actor.dock),
            'undock': lambda: self._interrupt('undock', actor.undock),
            'cancel': lambda: self._interrupt('cancel', actor.cancel),
            'pause': lambda: actor.unpause(simulator) if is_paused else actor.pause(simulator),
            'step': lambda: actor.step(simulator), 'reset': lambda: actor.reset(simulator),
            'brushes': lambda: actor.set_brushes_up(not brushes_up),
            'slower': lambda: self._change_speed(-1), 'faster': lambda: self._change_speed(1),
            'laser': self._laser, 'path': self.floor.switch_path, 'field': self.floor.switch_field,
            'legend': self.floor.switch_legend, 'fit': self.floor.fit, 'more': self.panel.switch_more,
            'next_robot': self._next_robot,
            'save': self.pictures.save, 'record': self.pictures.switch_record,
            'report': lambda: self.reports.switch(snapshot)}

    def _interrupt(self, name: str, act: Callable[[], Any]) -> None:
        """Do what interrupts a cleaning, and tell how to continue that."""
        mission = self.snapshot.robot.mission if self.snapshot.robot is not None else None
        if mission is not None and mission.is_cleaning:
            resume = BY_NAME['resume_cleaning']
            self.tell(f'{BY_NAME[name].label}: {resume.label} [{resume.key}] continues the cleaning later')
        act()

    def _change_speed(self, direction: int) -> None:
        wanted = self.snapshot.simulation.wanted
        if wanted is not None:
            self._set_speed(next_speed(wanted, direction))

    def _set_speed(self, speed: float) -> None:
        self._actor.set_speed(self.snapshot.simulation.node, speed)

    def _laser(self) -> None:
        self._shows_laser = not self._shows_laser
        self._source.select(self.snapshot.selected, self._shows_laser)

    def _next_robot(self) -> None:
        names = [one.name for one in self.snapshot.robots]
        if names:
            index = names.index(self.snapshot.selected) if self.snapshot.selected in names else -1
            self._select(names[(index + 1) % len(names)])

    def _select(self, name: str) -> None:
        """Drive and describe another robot from now on."""
        self.keyboard.forget()
        self._source.select(name, self._shows_laser)
        self._actor.select(name)

    def _choose_target(self, x: float, y: float) -> None:
        """Show where the robot could go; nothing is sent yet."""
        if not self._can_go():
            return
        self._clear_target()
        self.tell(f'{TARGET} {x:.2f}, {y:.2f} m: double click or Enter sends {self.snapshot.selected} there, '
                  'Esc clears it')
        self._set_target(Point(x, y))

    def _set_target(self, target: Optional[Point]) -> None:
        self.snapshot = dataclasses.replace(self.snapshot, target=target)
        self._show()

    def _clear_target(self) -> bool:
        """Forget the target and how to go there; returns whether there was one."""
        had_one = self.snapshot.target is not None
        self._set_target(None)
        self._notices.retract(TARGET)
        return had_one

    def _go_to(self, x: float, y: float) -> None:
        if not self._can_go():
            return
        self._clear_target()
        target = on_map(Point(x, y), self.snapshot.map_frame or SAME)
        self.tell(f'Sent {self.snapshot.selected} to {x:.2f}, {y:.2f} m')
        self._interrupt('go_there', lambda: self._actor.go_to(*target))

    def _can_go(self) -> bool:
        """Whether the robot can be sent to a point; tells why if it cannot."""
        lacks = way(self.snapshot)
        if lacks:
            self.tell(f'Go there: {lacks}')
        return not lacks

    def _put(self, name: str, pose: Pose) -> None:
        self._actor.teleport(name, pose)

    # --- driving ------------------------------------------------------------------------------------------------------

    def keyPressEvent(self, event: Any) -> None:  # noqa: N802 (Qt's name)
        """A key went down, or repeats."""
        self.keyboard.press(event)

    def keyReleaseEvent(self, event: Any) -> None:  # noqa: N802
        """A key went up, or repeats."""
        self.keyboard.release(event)

    def _on_press(self, key: str) -> None:
        """Drive, or do what the key stands for."""
        if not robot(self.snapshot) and self._steering.press(key):
            self._tell_who_drives()
            self._command()
        elif key == 'Esc' and (self.floor.let_go() or self._clear_target() or self.floor.dismiss()):
            return
        elif key in CLOSE:
            self.close()
        elif key in KEYS:
            self.act(KEYS[key])

    def _tell_who_drives(self) -> None:
        shown = self.snapshot.robot
        if shown is not None and shown.has_fallen:
            self.tell(f'{shown.name} has fallen over a cliff and cannot drive: drag it elsewhere')
        elif shown is not None and shown.mission is not None and shown.mission.is_active:
            self.tell('You drive: the cleaner waits, and goes on when you let go')

    def _on_release(self, key: str) -> None:
        """Stop, unless another key drives."""
        if self._steering.release(key):
            self._command()

    def event(self, event: Any) -> bool:
        """Stop if another window comes to the front: it gets the release of the key."""
        if event.type() == QEvent.WindowDeactivate:
            self.keyboard.forget()
        return bool(super().event(event))

    def closeEvent(self, event: Any) -> None:  # noqa: N802
        """Stop the robot before the window closes."""
        self.keyboard.forget()
        super().closeEvent(event)

    def _command(self) -> None:
        """Publish the command of the keys, as often as the robot needs it to keep driving."""
        (linear, angular), is_due = self._steering.command()
        if is_due:
            self._actor.drive(linear * self._options.linear, angular * self._options.angular)
            least, usual = COMMAND_PERIODS
            speed = max(self.snapshot.simulation.speed or 1.0, 1.0)
            self._commands.setInterval(round(1000 * max(least, min(COMMAND_AGE / speed, usual))))


def _map_number(snapshot: Snapshot) -> Optional[int]:
    """The number of the map of a snapshot; None if it has none."""
    return snapshot.plan.number if snapshot.plan is not None else None
