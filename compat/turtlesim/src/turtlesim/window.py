"""The window; imports Qt only to open it, so that machines without Qt can import this module."""

import importlib.util
import os
import subprocess
import sys
from typing import Any, List

from PIL import Image

DISPLAYS = ('DISPLAY', 'WAYLAND_DISPLAY', 'QT_QPA_PLATFORM')
PATIENCE = 20.0  # [s] for the probe, which usually takes 0.1 s
# Qt ends the process if it cannot use the display, so this runs in a process of its own.
PROBE = 'from PyQt5.QtWidgets import QApplication; QApplication([])'


class Window:
    """Shows pictures of one size.

    Attributes:
        is_open: false once the user has closed the window.
    """

    def __init__(self, title: str) -> None:
        """Open it in the main thread; call `why_none` before."""
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
        """Show an RGB image."""
        width, height = picture.size
        image = self._gui.QImage(picture.tobytes(), width, height, 3 * width, self._gui.QImage.Format_RGB888)
        self._label.setPixmap(self._gui.QPixmap.fromImage(image))
        self._label.setFixedSize(width, height)
        self._label.show()

    def poll(self) -> None:
        """Process the pending events of Qt."""
        self._application.processEvents()


def why_none() -> str:
    """Return the reason why no window can be opened, in a few words; empty if one can."""
    if not any(os.environ.get(name) for name in DISPLAYS):
        return 'there is no display'
    if importlib.util.find_spec('PyQt5') is None:
        return 'PyQt5 is not installed'
    probe = subprocess.run([sys.executable, '-c', PROBE], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                           timeout=PATIENCE)
    return f'Qt cannot use the display {os.environ.get("DISPLAY", "")}'.rstrip() if probe.returncode else ''


def is_unseen() -> bool:
    """Whether Qt is set to a platform that shows nothing."""
    return os.environ.get('QT_QPA_PLATFORM', '').partition(':')[0] in ('offscreen', 'minimal')


def take_platform(arguments: List[str]) -> None:
    """Remove the option `-platform NAME` of Qt from a command line and obey it; tests of courses use it."""
    if '-platform' in arguments[:-1]:
        index = arguments.index('-platform')
        os.environ['QT_QPA_PLATFORM'] = arguments[index + 1]
        del arguments[index:index + 2]
