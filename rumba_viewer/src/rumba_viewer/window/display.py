"""Whether a window can be opened on this machine."""

import contextlib
import os
import select
import subprocess
import sys
from typing import Iterator

WITHOUT_DISPLAY = ('offscreen', 'minimal', 'vnc', 'linuxfb', 'eglfs')  # platforms of Qt that need no display
PATIENCE = 20.0  # [s]
TRY = ('import sys; from PyQt5.QtWidgets import QApplication; '
       'application = QApplication([]); print(flush=True); sys.stdin.read()')


@contextlib.contextmanager
def reached() -> Iterator[str]:
    """Check that the display can be opened, and keep a connection to it during the block.

    Qt ends the process if it cannot open the display, so another process tries it. That one stays connected until
    this one is: an X server without clients resets itself, and refuses connections meanwhile.

    Yields:
        Why no window can be opened, in one line; empty if one can be opened.
    """
    platform = os.environ.get('QT_QPA_PLATFORM', '').split(':')[0]
    name = os.environ.get('DISPLAY') or os.environ.get('WAYLAND_DISPLAY')
    if platform not in WITHOUT_DISPLAY and not name:
        yield 'there is no display: neither DISPLAY nor WAYLAND_DISPLAY is set'
        return
    with subprocess.Popen([sys.executable, '-c', TRY], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE) as attempt:
        try:
            assert attempt.stdout is not None and attempt.stderr is not None
            if not select.select([attempt.stdout], [], [], PATIENCE)[0]:
                yield f'the display {name} has not answered for {PATIENCE:g} s'
            elif attempt.stdout.readline():
                yield ''
            else:
                yield _why(attempt.stderr.read(), platform or name or '')
        finally:
            attempt.kill()


def _why(errors: bytes, display: str) -> str:
    if b'ModuleNotFoundError' in errors or b'ImportError' in errors:
        return 'PyQt5 is not installed: apt-get install python3-pyqt5'
    return f'the display {display} cannot be opened'
