"""Paths of the files that the window saves."""

import datetime
import pathlib


def new_file(folder: str, ending: str) -> pathlib.Path:
    """The path of a new file, named by the time.

    Args:
        folder: where to save it; empty: ~/Pictures, or the home directory if there is no such folder.
        ending: such as `png`.
    """
    home = pathlib.Path.home()
    parent = pathlib.Path(folder).expanduser() if folder else home / 'Pictures'
    if not folder and not parent.is_dir():
        parent = home
    name = f'rumba-{datetime.datetime.now():%Y%m%d-%H%M%S}'
    path, number = parent / f'{name}.{ending}', 1
    while path.exists():
        number += 1
        path = parent / f'{name}-{number}.{ending}'
    return path.resolve()
