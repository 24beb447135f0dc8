"""Whether a window can be opened here."""

import contextlib
import os
import select
import subprocess
import sys
import tempfile
from typing import Iterator

WITHOUT_DISPLAY = ('offscreen', 'minimal', 'vnc', 'linuxfb', 'eglfs')  # platforms of Qt that need none
PATIENCE = 20.0  # [s]
TRY = ('import sys; from PyQt5.QtWidgets import QApplication; '
       'application = QApplication([]); print(flush=True); sys.stdin.read()')


@contextlib.contextmanager
def reached() -> Iterator[str]:
    """Try to reach the display, and hold on to it as long as the block.

    Qt ends the process where it cannot: another one tries. That stays until this one is connected, since a bare X
    server starts anew when its last client goes, and refuses whoever comes meanwhile.

    Yields:
        Why no window can be opened, in one line; empty where one can.
    """
    platform = os.environ.get('QT_QPA_PLATFORM', '').split(':')[0]
    name = os.environ.get('DISPLAY') or os.environ.get('WAYLAND_DISPLAY')
    if platform not in WITHOUT_DISPLAY and not name:
        yield 'there is no display: neither DISPLAY nor WAYLAND_DISPLAY is set'
        return
    with tempfile.TemporaryFile('w+') as errors, subprocess.Popen(
            [sys.executable, '-c', TRY], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=errors) as attempt:
        try:
            if not select.select([attempt.stdout], [], [], PATIENCE)[0]:
                yield f'the display {name} does not answer for {PATIENCE:g} s'
            elif attempt.stdout.readline():
                yield ''
            else:
                errors.seek(0)
                yield _why(errors.read(), platform or name)
        finally:
            attempt.kill()


def _why(errors: str, where: str) -> str:
    if 'ModuleNotFoundError' in errors or 'ImportError' in errors:
        return 'PyQt5 is not installed: python3-pyqt5 of Debian'
    return f'the display {where} cannot be opened'
