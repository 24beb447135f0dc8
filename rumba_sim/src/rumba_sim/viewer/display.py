"""Whether a window can be opened here."""

import os
import subprocess
import sys

WITHOUT_DISPLAY = ('offscreen', 'minimal', 'vnc', 'linuxfb', 'eglfs')  # platforms of Qt that need none
PATIENCE = 20.0  # [s]
TRY = 'from python_qt_binding.QtWidgets import QApplication; QApplication([])'


def trouble() -> str:
    """Why no window can be opened, in one line; empty where one can.

    Qt ends the process where it cannot reach a display: another one tries.
    """
    platform = os.environ.get('QT_QPA_PLATFORM', '').split(':')[0]
    if platform not in WITHOUT_DISPLAY and not (os.environ.get('DISPLAY') or os.environ.get('WAYLAND_DISPLAY')):
        return 'there is no display: neither DISPLAY nor WAYLAND_DISPLAY is set'
    try:
        tried = subprocess.run([sys.executable, '-c', TRY], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                               universal_newlines=True, timeout=PATIENCE)
    except subprocess.TimeoutExpired:
        return f'the display does not answer for {PATIENCE:g} s'
    if tried.returncode == 0:
        return ''
    if 'ModuleNotFoundError' in tried.stderr or 'ImportError' in tried.stderr:
        return 'python_qt_binding or PyQt5 is not installed: python3-python-qt-binding and python3-pyqt5 of Debian'
    return f'the display {os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")} cannot be opened'
