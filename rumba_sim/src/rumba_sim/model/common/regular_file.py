"""Files that a user names: only regular ones are opened, since a named pipe or a device could block for ever."""

import os
import stat
from typing import IO, Type

from rumba_sim.model.common.errors import RumbaError, quoted

KINDS = {stat.S_IFDIR: 'a directory', stat.S_IFIFO: 'a named pipe', stat.S_IFSOCK: 'a socket',
         stat.S_IFCHR: 'a device', stat.S_IFBLK: 'a device'}


def opened(path: str, error: Type[RumbaError]) -> IO[bytes]:
    """Open a regular file for reading.

    Args:
        path: path of the file; the value may come from a file or a parameter, and is checked to be text.
        error: class of the errors to raise.

    Raises:
        error: there is no such file, or it is not a regular one; the message begins with the path.
    """
    if not isinstance(path, str) or not path:
        raise error(f'the path of a file is {quoted(path)}: must be text')
    try:
        kind = stat.S_IFMT(os.stat(path).st_mode)
        if kind != stat.S_IFREG:
            raise error(f'{path}: is {KINDS.get(kind, "something else")}: must be a regular file')
        return open(path, 'rb', opener=_without_waiting)
    except OSError as exc:
        raise error(f'{path}: {exc.strerror}') from exc
    except ValueError as exc:  # the path has a null character or one that no file name can have
        raise error(f'{path}: is not a path: {exc}') from exc


def _without_waiting(path: str, flags: int) -> int:
    """Open a file; if it has become a named pipe in the meantime, do not wait for its other end."""
    return os.open(path, flags | os.O_NONBLOCK)
