"""Scratch folders, of which those are removed at the next start that a killed process has left behind."""

import contextlib
import fcntl
import os
import pathlib
import subprocess
import tempfile
from typing import Iterator, List

PREFIX = 'rumba_mark_'
LOCK = 'lock'  # in each: locked as long as it is used


@contextlib.contextmanager
def folder() -> Iterator[pathlib.Path]:
    """A new folder, which is gone after the block."""
    path = pathlib.Path(tempfile.mkdtemp(prefix=PREFIX))
    with open(path / LOCK, 'w', encoding='utf-8') as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        try:
            yield path
        finally:
            remove(path)


def remove_abandoned() -> List[str]:
    """Remove what nobody uses any more; returns the paths."""
    found = []
    for path in pathlib.Path(tempfile.gettempdir()).glob(f'{PREFIX}*'):
        with contextlib.suppress(OSError):
            if path.stat().st_uid == os.getuid() and not path.is_symlink():
                with open(path / LOCK, encoding='utf-8') as lock:
                    fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
                    remove(path)
                    found.append(str(path))
    return found


def remove(path: pathlib.Path) -> None:
    """Remove a folder, also one in which a program has taken away the right to do so, or has nested very many."""
    for command in (['chmod', '-R', 'u+rwx'], ['rm', '-rf']):
        subprocess.run([*command, str(path)], stderr=subprocess.DEVNULL, check=False)
