"""Colours, light and dark; the palette of the desktop decides between them."""

import dataclasses
import zlib
from typing import Tuple

from rumba_sim.model.robot import FIRST


@dataclasses.dataclass(frozen=True)
class Theme:
    """Colours as #rrggbb, or #aarrggbb if they are transparent."""

    is_dark: bool
    background: str
    wall: str
    unknown: str
    out_of_reach: str
    to_sweep: str
    swept: str
    carpet: str  # over each of the three above, with its alpha
    cliff: str
    veil: str  # over what a robot's own map does not show, with its alpha
    text: str
    faint_text: str
    card: str
    line: str
    trough: str
    good: str
    warning: str
    bad: str
    dock: str
    halo: str
    field: str
    obstacle: str
    laser: str
    laser_edge: str
    body: str
    body_edge: str
    lit: str  # brushes that clean
    robots: Tuple[str, ...]


ROBOTS = ('#1f6fd6', '#d9580d', '#7a43c4', '#00857c', '#b3266e', '#7a6a00')
LIGHT = Theme(
    is_dark=False, background='#eceef1', wall='#101216', unknown='#d3d7dd', out_of_reach='#3f434c', to_sweep='#b8863c',
    swept='#fdfefe', carpet='#284f74b8', cliff='#e88f86', veil='#b8eceef1', text='#1d232b', faint_text='#5c6672',
    card='#ffffff', line='#d5d9df', trough='#e3e6ea', good='#2e9e5b', warning='#d98a00', bad='#d13b32', dock='#2e9e5b',
    halo='#302e9e5b', field='#162e9e5b', obstacle='#8a5a2b', laser='#18d13b32', laser_edge='#60d13b32', body='#343b45',
    body_edge='#ffffff', lit='#43d17f', robots=ROBOTS)
DARK = Theme(
    is_dark=True, background='#1b1e23', wall='#05070a', unknown='#15181c', out_of_reach='#262a31', to_sweep='#94733a',
    swept='#cfe0ea', carpet='#28b48ce0', cliff='#8c3b38', veil='#b81b1e23', text='#e8ebef', faint_text='#9fa8b4',
    card='#24282e', line='#3a3f47', trough='#3a3f47', good='#4cc47c', warning='#f0a830', bad='#ff6b60', dock='#1d7a45',
    halo='#301d7a45', field='#161d7a45', obstacle='#4d2f12', laser='#18d13b32', laser_edge='#60d13b32', body='#343b45',
    body_edge='#ffffff', lit='#43d17f', robots=ROBOTS)


def robot_colour(theme: Theme, name: str) -> str:
    """The colour of a robot, the same in every window: rumba, rumba2, ... in turn, others by their name."""
    number = name[len(FIRST):] if name.startswith(FIRST) else None
    if number == '':
        index = 0
    elif number is not None and number.isdigit():
        index = int(number) - 1
    else:
        index = zlib.crc32(name.encode())
    return theme.robots[index % len(theme.robots)]
