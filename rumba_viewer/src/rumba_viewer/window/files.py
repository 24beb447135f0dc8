"""Where the window saves what it saves."""

import datetime
import pathlib


def new_file(folder: str, ending: str) -> pathlib.Path:
    """The path of a file that is not there yet, named by the time.

    Args:
        folder: where; empty: the user's folder for pictures, or home where there is none.
        ending: as `png`.
    """
    home = pathlib.Path.home()
    where = pathlib.Path(folder).expanduser() if folder else home / 'Pictures'
    if not folder and not where.is_dir():
        where = home
    name = f'rumba-{datetime.datetime.now():%Y%m%d-%H%M%S}'
    path, number = where / f'{name}.{ending}', 1
    while path.exists():
        number += 1
        path = where / f'{name}-{number}.{ending}'
    return path.resolve()
