"""Colours, light and dark; the palette of the desktop decides between them."""

import dataclasses
import zlib

from rumba_sim.model.maps import floor_colours
from rumba_sim.model.maps.floor_colours import ROBOTS, FloorColours
from rumba_sim.model.simulation.robot import FIRST


@dataclasses.dataclass(frozen=True)
class Theme:
    """Colours as #rrggbb, or #aarrggbb if they are transparent."""

    is_dark: bool
    floor: FloorColours
    background: str
    veil: str  # over what a robot's own map does not show, with its alpha
    text: str
    faint_text: str
    card: str
    line: str
    trough: str
    main: str  # of the most prominent button, and of the bar of what is swept
    good: str
    warning: str
    bad: str
    halo: str
    field: str
    laser: str
    laser_edge: str
    body: str = '#343b45'  # robots
    body_edge: str = '#ffffff'
    lit: str = '#43d17f'  # brushes that clean


LIGHT = Theme(
    is_dark=False, floor=floor_colours.LIGHT, background='#eceef1', veil='#b8eceef1', text='#1d232b',
    faint_text='#545e6a', card='#ffffff', line='#c9cfd7', trough='#dde1e7', main='#1a5fb8', good='#237a47',
    warning='#8a5200', bad='#b3261e', halo='#302e9e5b', field='#162e9e5b', laser='#18d13b32', laser_edge='#60d13b32')
DARK = Theme(
    is_dark=True, floor=floor_colours.DARK, background='#1b1e23', veil='#b81b1e23', text='#e8ebef',
    faint_text='#a6afbb', card='#20252c', line='#414853', trough='#39404a', main='#6fb0ff', good='#4cc47c',
    warning='#f0a830', bad='#ff8a80', halo='#301d7a45', field='#161d7a45', laser='#18d13b32', laser_edge='#60d13b32')


def robot_colour(name: str) -> str:
    """The colour of a robot, the same in every window: rumba, rumba2, ... in turn, others by their name."""
    return ROBOTS[_place(name)]


def line_colour(theme: Theme, name: str) -> str:
    """The colour of the paths of a robot."""
    return theme.floor.lines[_place(name)]


def _place(name: str) -> int:
    number = name[len(FIRST):] if name.startswith(FIRST) else None
    if number == '':
        index = 0
    elif number is not None and number.isdigit():
        index = int(number) - 1
    else:
        index = zlib.crc32(name.encode())
    return index % len(ROBOTS)
