"""The colours of the floor, as #rrggbb: the same in the window, on the page and in reports, on light and dark screens.

Whatever lies side by side has a contrast of 3 to 1 at least, as WCAG 2.1 asks of graphics: `test_floor_colours.py`. For
four states and lines over them one colour each is not enough: what is out of reach, and cliffs, have two in stripes.
"""

import math
from typing import NamedTuple, Tuple

STRIPES = 0.12  # [m] from one stripe to the next of a colour, along an axis
DOTS = 0.15  # [m] from one dot of a carpet to the next


class FloorColours(NamedTuple):
    """Colours of a floor, and of what is drawn on it.

    Attributes:
        wall, unknown, to_sweep, swept: of cells.
        out_of_reach, stripe: in turns, of cells that the brush cannot reach.
        cliff, drop: in turns, of cells over which a robot would fall.
        carpet: dots over the cells of a carpet.
        obstacle: what the map does not show.
        dock: docks, which have a white edge.
        lines: paths of the first, second, ... robot.
    """

    wall: str
    unknown: str
    to_sweep: str
    swept: str
    out_of_reach: str
    stripe: str
    cliff: str
    drop: str
    carpet: str
    obstacle: str
    dock: str
    lines: Tuple[str, ...]


LIGHT = FloorColours(
    wall='#101216', unknown='#d3d7dd', to_sweep='#b8863c', swept='#fdfefe', out_of_reach='#3f434c', stripe='#5e636e',
    cliff='#e88f86', drop='#6b1410', carpet='#24407a', obstacle='#5f3b19', dock='#237a47',
    lines=('#0b2f5e', '#542200', '#3a1a6b', '#003b36', '#5a0f36', '#332c00'))
DARK = FloorColours(
    wall='#05070a', unknown='#15181c', to_sweep='#94733a', swept='#cfe0ea', out_of_reach='#262a31', stripe='#5a606b',
    cliff='#e0726a', drop='#4a0f0c', carpet='#2a1a4d', obstacle='#3d240c', dock='#1d7a45',
    lines=('#092850', '#4a1e00', '#33175f', '#00332f', '#4e0c2e', '#2d2600'))
ROBOTS = ('#1f6fd6', '#d9580d', '#7a43c4', '#00857c', '#b3266e', '#7a6a00')  # bodies, light and dark alike


def contrast(one: str, other: str) -> float:
    """Contrast of two colours, 1 to 21, as WCAG 2 defines it."""
    low, high = sorted((_luminance(one), _luminance(other)))
    return (high + 0.05) / (low + 0.05)


def _luminance(colour: str) -> float:
    """Relative luminance of a colour, 0 to 1."""
    parts = [value / 255.0 for value in bytes.fromhex(colour[1:])]
    red, green, blue = (part / 12.92 if part <= 0.04045 else math.pow((part + 0.055) / 1.055, 2.4) for part in parts)
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue
