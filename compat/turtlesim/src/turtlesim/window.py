"""The window, where there is a display; imports Qt only where it is opened."""

import importlib.util
import os
import subprocess
import sys
from typing import Any, List

from PIL import Image

DISPLAYS = ('DISPLAY', 'WAYLAND_DISPLAY', 'QT_QPA_PLATFORM')
PATIENCE = 20.0  # [s] with Qt; it takes a tenth of a second
# Qt ends the process that it cannot serve: let that be another one.
PROBE = 'from PyQt5.QtWidgets import QApplication; QApplication([])'


class Window:
    """Shows pictures, all of one size.

    Attributes:
        is_open: whether nobody has closed it.
    """

    def __init__(self, title: str) -> None:
        """Open it, in the main thread, where `why_none` has nothing to say."""
        from PyQt5 import QtGui, QtWidgets
        self._gui: Any = QtGui
        self._application: Any = QtWidgets.QApplication([title])
        self._label: Any = QtWidgets.QLabel()
        self._label.setWindowTitle(title)
        self.is_open = True
        self._label.closeEvent = self._on_close

    def _on_close(self, _: Any) -> None:
        self.is_open = False

    def show(self, picture: Image.Image) -> None:
        """Show an RGB image from now on."""
        width, height = picture.size
        image = self._gui.QImage(picture.tobytes(), width, height, 3 * width, self._gui.QImage.Format_RGB888)
        self._label.setPixmap(self._gui.QPixmap.fromImage(image))
        self._label.setFixedSize(width, height)
        self._label.show()

    def poll(self) -> None:
        """Let Qt do what is due."""
        self._application.processEvents()


def why_none() -> str:
    """Why there can be no window: a few words, or none where there can be one."""
    if not any(os.environ.get(name) for name in DISPLAYS):
        return 'there is no display'
    if importlib.util.find_spec('PyQt5') is None:
        return 'PyQt5 is not installed'
    probe = subprocess.run([sys.executable, '-c', PROBE], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                           timeout=PATIENCE)
    return f'Qt cannot use the display {os.environ.get("DISPLAY", "")}'.rstrip() if probe.returncode else ''


def is_unseen() -> bool:
    """Whether Qt was told to show windows to nobody."""
    return os.environ.get('QT_QPA_PLATFORM', '').partition(':')[0] in ('offscreen', 'minimal')


def take_platform(arguments: List[str]) -> None:
    """Take Qt's `-platform NAME` off a command line: some tests of students run turtlesim so."""
    if '-platform' in arguments[:-1]:
        place = arguments.index('-platform')
        os.environ['QT_QPA_PLATFORM'] = arguments[place + 1]
        del arguments[place:place + 2]
