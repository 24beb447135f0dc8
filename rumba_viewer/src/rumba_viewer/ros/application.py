"""The window as a program: waits for a master, runs until it is closed or ROS shuts down, saves pictures on request."""

import pathlib
import signal
import sys
import threading
import time
import traceback
from typing import Any, Callable, Optional

import rosgraph
import rospy
from PyQt5.QtCore import Qt, QTimer
from PyQt5.QtGui import QColor, QPalette
from PyQt5.QtWidgets import QApplication
from std_srvs.srv import Trigger, TriggerResponse

from rumba_cleaning import strategies
from rumba_sim.model.common.errors import WorldError
from rumba_sim.ros.participants.requests import Requests
from rumba_sim.ros.running import node
from rumba_viewer.ros.actor import Actor
from rumba_viewer.ros.listener import Listener, missing_master
from rumba_viewer.scene.snapshot import Snapshot
from rumba_viewer.scene.theme import DARK, LIGHT
from rumba_viewer.window.window import Options, Window

PERIOD = 50  # [ms] from one check for requests and for the end of ROS to the next
SETTLE = 0.5  # [s] from a complete snapshot until a picture is saved
AUTO, LIGHT_STYLE, DARK_STYLE = 'auto', 'light', 'dark'
STRATEGIES = sorted(strategies.OWN)  # that every cleaner knows


class Application:
    """Qt, and the one window."""

    def __init__(self) -> None:
        """Connect to the display, which must be there."""
        self._qt = QApplication.instance() or QApplication(['rumba'])
        self._qt.setApplicationDisplayName('Rumba')
        self._error: Optional[Exception] = None
        self._complete_since: Optional[float] = None
        self._service: Optional[rospy.Service] = None
        sys.excepthook = self._on_exception

    def _on_exception(self, kind: Any, error: Any, trace: Any) -> None:
        """End in order: PyQt aborts the process if a handler of an event raises."""
        if not rospy.core.is_shutdown_requested():  # else a topic may be closed already
            traceback.print_exception(kind, error, trace)
            self._error = error
        self._qt.quit()

    # --- before there is a master -------------------------------------------------------------------------------------

    def wait_for_master(self) -> None:
        """Show a window that tells what it waits for, until a master answers; exits if it is closed."""
        with node.prompt_sigint():
            if rosgraph.is_master_online():
                return
        is_over = threading.Event()  # whoever sees the window may end the program: it listens before it shows it
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, lambda *_: is_over.set())
        _set_style(self._qt, _given_style())
        window = Window(_Nobody(), _Nobody(), Options(0.0, 0.0, '', STRATEGIES, False),
                        Snapshot(missing=missing_master()))
        window.resize(1180, 720)
        window.show()
        print('viewer:', *missing_master().split('\n')[1:], file=sys.stderr, flush=True)
        look = threading.Thread(target=node.look_for_master, daemon=True)
        look.start()
        timer = self._timer(lambda: self._qt.quit() if is_over.is_set() or not look.is_alive() else None)
        self._qt.exec_()
        timer.stop()
        if is_over.is_set() or look.is_alive():
            sys.exit(0)
        window.deleteLater()

    def _timer(self, act: Callable[[], Any]) -> QTimer:
        timer = QTimer()
        timer.timeout.connect(act)
        timer.start(PERIOD)
        return timer

    # --- with a master ------------------------------------------------------------------------------------------------

    def run(self, settings: Any) -> None:
        """Show the window until it is closed or ROS shuts down; with save_png, until the picture is saved.

        Raises:
            WorldError: the picture cannot be saved.
        """
        _set_style(self._qt, settings.style)
        offered = [*STRATEGIES, *filter(None, (name.strip() for name in settings.strategies.split(',')))]
        options = Options(settings.linear, settings.angular, settings.folder, offered, settings.laser)
        listener = Listener(settings.robot, settings.laser)
        actor = Actor(settings.robot)
        window = Window(listener, actor, options, listener.snapshot(time.monotonic()))
        window.resize(settings.width, settings.height)
        requests = Requests()

        def register() -> None:
            if self._service is not None:
                self._service.shutdown('another master')
            self._service = rospy.Service('~save_png', Trigger, lambda _: _save(requests, window))
            actor.connect()
        listener.start(register)
        window.setAttribute(Qt.WA_DontShowOnScreen, bool(settings.save_png))
        window.show()
        timer = self._timer(lambda: self._look(requests, window, settings))
        self._qt.exec_()
        timer.stop()
        window.close()
        actor.close()
        if isinstance(self._error, OSError):
            raise WorldError(f'save_png: {self._error}')
        if self._error is not None:
            sys.exit(1)

    def _look(self, requests: Requests, window: Window, settings: Any) -> None:
        requests.serve(0.0)
        if rospy.is_shutdown():
            self._qt.quit()
        elif settings.save_png and self._is_complete(window.snapshot, settings.laser):
            try:
                window.pictures.save_as(pathlib.Path(settings.save_png).expanduser())
            except OSError as error:
                self._error = error
            self._qt.quit()

    def _is_complete(self, snapshot: Snapshot, needs_laser: bool) -> bool:
        """Whether the snapshot has been complete for a while."""
        robot = snapshot.robot
        now = time.monotonic()
        if not snapshot.is_complete or needs_laser and robot is not None and robot.beams is None:
            self._complete_since = None
        elif self._complete_since is None:
            self._complete_since = now
        return self._complete_since is not None and now - self._complete_since > SETTLE


class _Nobody:
    """A source without news and an actor that does nothing."""

    report = ''

    class notices:  # noqa: N801 (stands for a queue)
        """Always empty."""

        @staticmethod
        def empty() -> bool:
            return True

    @staticmethod
    def has_news(_: float) -> bool:
        return False

    def __getattr__(self, _: str) -> Callable[..., None]:
        return lambda *_: None


def _save(requests: Requests, window: Window) -> TriggerResponse:
    """Make the thread of the window save a picture."""
    try:
        return TriggerResponse(True, str(requests.call(window.pictures.save_anywhere)))
    except OSError as error:
        return TriggerResponse(False, str(error))


def _given_style() -> str:
    """The style on the command line, before there is a master with the parameters; else that of the desktop."""
    given = [argument.partition(':=')[2] for argument in sys.argv if argument.startswith('_style:=')]
    return given[-1] if given and given[-1] in (DARK_STYLE, LIGHT_STYLE) else AUTO


def _set_style(qt: QApplication, style: str) -> None:
    """Set a light or dark style; `auto` keeps that of the desktop."""
    if style == AUTO:
        return
    theme = DARK if style == DARK_STYLE else LIGHT
    qt.setStyle('Fusion')
    palette = QPalette(QColor(theme.line if theme.is_dark else theme.background), QColor(theme.background))
    for role, colour in ((QPalette.WindowText, theme.text), (QPalette.Text, theme.text),
                         (QPalette.ButtonText, theme.text), (QPalette.Base, theme.card),
                         (QPalette.ToolTipBase, theme.card), (QPalette.ToolTipText, theme.text),
                         (QPalette.Highlight, theme.main)):
        palette.setColor(role, QColor(colour))
    for role in (QPalette.WindowText, QPalette.Text, QPalette.ButtonText):
        faint = QColor(theme.faint_text)
        faint.setAlpha(130)
        palette.setColor(QPalette.Disabled, role, faint)
    qt.setPalette(palette)
