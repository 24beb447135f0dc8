"""Which packages of ROS are installed, as far as their folders tell."""

import difflib
import os
import pathlib
from typing import Collection, List, Set

SYSTEM = '/usr'  # where Debian has its packages of ROS


def names() -> Set[str]:
    """The packages that are installed, or in a workspace of the environment."""
    prefixes = os.environ.get('CMAKE_PREFIX_PATH', '').split(os.pathsep)
    shares = [pathlib.Path(prefix, 'share') for prefix in (*prefixes, SYSTEM) if prefix]
    found = {entry.parent.name for share in shares for each in ('*/package.xml', '*/cmake')
             for entry in share.glob(each)}
    return found | {entry.parent.name for folder in _sources()
                    for each in ('package.xml', '*/package.xml', '*/*/package.xml') for entry in folder.glob(each)}


def _sources() -> List[pathlib.Path]:
    return [pathlib.Path(folder) for folder in os.environ.get('ROS_PACKAGE_PATH', '').split(os.pathsep) if folder]


def nearest(name: str, installed: Collection[str]) -> str:
    """The installed package with the most similar name; empty if none is similar."""
    near = difflib.get_close_matches(name[:100], sorted(installed), 1, 0.75)
    return near[0] if near else ''
