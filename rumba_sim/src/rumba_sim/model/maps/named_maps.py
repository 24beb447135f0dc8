"""The maps of this package by name, wherever they were installed to: beside the sources, by catkin, or by pip."""

import os
import pathlib
from typing import Dict

from rumba_sim.model.common.errors import MapError, quoted

PACKAGE = pathlib.Path(__file__).parents[2]
FOLDERS = (
    PACKAGE / 'maps',  # installed by pip
    PACKAGE.parents[1] / 'maps',  # PACKAGE is rumba_sim/src/rumba_sim, also in a devel space of catkin
    PACKAGE.parents[3] / 'share' / 'rumba_sim' / 'maps')  # PACKAGE is lib/python3/dist-packages/rumba_sim: by catkin


def is_path(name: str) -> bool:
    """Whether a map is given by its path, and not by its name."""
    return '/' in name or os.sep in name or name.endswith(('.yaml', '.yml'))


def known() -> Dict[str, str]:
    """The path of each map by its name, in the order of the names."""
    for folder in FOLDERS:
        found = {path.stem: str(path) for path in sorted(folder.glob('*.yaml'))}
        if found:
            return found
    return {}


def path(name: str) -> str:
    """The absolute path of a map, given by its path or, if it is a map of this package, by its name.

    Raises:
        MapError: no map of this package has that name.
    """
    if is_path(name):
        return os.path.abspath(name)
    maps = known()
    if name not in maps:
        raise MapError(f'there is no map {quoted(name)}: give the path of a map_server YAML file, or one of '
                       + (', '.join(maps) or 'none: the maps are not installed'))
    return maps[name]
