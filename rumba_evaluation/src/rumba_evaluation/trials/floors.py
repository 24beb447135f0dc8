"""The five floors of the benchmark, drawn as maps of map_server; docs/benchmark.md describes them.

Lengths are in metres, x points to the right and y up; (0, 0) is the lower left inner corner.
"""

import pathlib
from typing import Callable, Dict

from rumba_sim.model.maps.drawing import FREE, ROBOT_AT_WALL, Drawing

RESOLUTION = 0.02  # [m]
WALL = 0.12  # [m]
BY = '; drawn by rumba_evaluation.trials.floors'


def _sheet(width: float, height: float) -> Drawing:
    """A sheet with solid walls all over, for rooms within a width and a height [m]."""
    plan = Drawing(-0.2, -0.2, width + 0.2, height + 0.2, RESOLUTION)
    plan.paint(plan.box(-WALL, -WALL, width + WALL, height + WALL))
    return plan


def bare(folder: pathlib.Path) -> None:
    """Draw an empty room of 4 x 5 m."""
    plan = _sheet(4.0, 5.0)
    plan.paint(plan.box(0.0, 0.0, 4.0, 5.0), FREE)
    plan.save(folder, 'bare', 'An empty room of 4 x 5 m' + BY, {'dock': (4.0 - ROBOT_AT_WALL, 2.5, 0.0)})


def lounge(folder: pathlib.Path) -> None:
    """Draw a furnished living room of 4 x 5 m."""
    plan = _sheet(4.0, 5.0)
    plan.paint(plan.box(0.0, 0.0, 4.0, 5.0), FREE)
    plan.legs(0.05, 1.3, 0.95, 3.3, 0.08)  # a sofa on legs, with room for a robot below
    plan.furniture(plan.box(0.0, 4.65, 1.6, 5.0))  # a sideboard
    plan.furniture(plan.box(3.55, 3.9, 4.0, 5.0))  # a bookcase
    plan.legs(1.5, 1.9, 2.1, 2.9, 0.05)  # a coffee table
    plan.legs(2.6, 0.5, 3.7, 1.3, 0.06)  # a dining table, and four chairs, one of which is askew
    plan.legs(2.75, 1.2, 3.15, 1.6, 0.03)
    plan.legs(3.2, 1.22, 3.6, 1.62, 0.03)
    plan.legs(2.72, 0.15, 3.12, 0.55, 0.03)
    for x, y in ((3.3, 0.05), (3.66, 0.19), (3.16, 0.41), (3.52, 0.55)):
        plan.paint(plan.disc(x, y, 0.02))
    plan.furniture(plan.turned_box(2.9, 4.2, 0.7, 0.7, 35.0))  # an armchair
    plan.furniture(plan.disc(0.3, 0.3, 0.18))  # a plant
    plan.paint(plan.disc(2.2, 3.6, 0.14))  # the foot of a lamp
    plan.layers['carpet'] = plan.box(1.2, 1.6, 2.4, 3.2)
    plan.save(folder, 'lounge', 'A furnished living room of 4 x 5 m' + BY, {'dock': (4.0 - ROBOT_AT_WALL, 2.5, 0.0)})


def rooms(folder: pathlib.Path) -> None:
    """Draw four rooms along a corridor, with doors of 0.8 m."""
    plan = _sheet(8.0, 6.0)
    plan.paint(plan.box(0.0, 2.6, 8.0, 3.6), FREE)
    for left, right, bottom, top in ((0.0, 3.9, 0.0, 2.48), (4.02, 8.0, 0.0, 2.48), (0.0, 2.6, 3.72, 6.0),
                                     (2.72, 8.0, 3.72, 6.0)):
        plan.paint(plan.box(left, bottom, right, top), FREE)
    for left, bottom, top in ((1.4, 2.48, 2.6), (6.4, 2.48, 2.6), (1.7, 3.6, 3.72), (5.0, 3.6, 3.72)):
        plan.paint(plan.box(left, bottom, left + 0.8, top), FREE)
    plan.furniture(plan.box(0.0, 0.0, 2.0, 1.6))  # a bed
    plan.furniture(plan.box(4.02, 0.0, 4.6, 2.0))  # wardrobes
    plan.furniture(plan.box(0.0, 5.4, 2.6, 6.0))  # a kitchen counter
    plan.legs(4.2, 4.5, 5.8, 5.3, 0.06)  # a table
    plan.furniture(plan.box(7.4, 4.2, 8.0, 5.6))
    plan.save(folder, 'rooms', 'Four rooms along a corridor' + BY, {'dock': (8.0 - ROBOT_AT_WALL, 3.1, 0.0)})


def loft(folder: pathlib.Path) -> None:
    """Draw a hall with a slanted wall, round pillars, a platform askew and a staircase that leads down."""
    plan = _sheet(7.0, 6.0)
    plan.paint(plan.box(0.0, 0.0, 7.0, 6.0) & (plan.y < 6.0 - 0.35 * plan.x), FREE)
    for x, y in ((1.6, 1.5), (3.4, 1.5), (5.2, 1.5)):
        plan.paint(plan.disc(x, y, 0.25))
    plan.furniture(plan.turned_box(2.4, 3.5, 1.6, 0.8, 25.0))
    plan.layers['cliff'] = plan.box(0.0, 4.4, 0.9, 6.0) & (plan.floor == FREE)
    plan.save(folder, 'loft', 'A hall with a slanted wall, pillars and a staircase' + BY,
              {'dock': (7.0 - ROBOT_AT_WALL, 2.4, 0.0)})


def narrows(folder: pathlib.Path) -> None:
    """Draw shelves with aisles of 0.6 m, and a passage that a robot just fits through."""
    plan = _sheet(6.0, 4.0)
    plan.paint(plan.box(0.0, 0.0, 6.0, 4.0), FREE)
    for left in (1.0, 2.0, 3.0):
        plan.furniture(plan.box(left, 0.7, left + 0.4, 3.3))
    plan.paint(plan.box(4.2, 0.0, 4.32, 1.7))  # a wall with a gap of 0.42 m
    plan.paint(plan.box(4.2, 2.12, 4.32, 4.0))
    for row in range(3):  # stools
        for column in range(2):
            plan.paint(plan.disc(4.8 + 0.6 * column, 0.6 + 0.6 * row, 0.04))
    plan.save(folder, 'narrows', 'Narrow aisles between shelves, and a narrow passage' + BY,
              {'dock': (6.0 - ROBOT_AT_WALL, 3.0, 0.0)})


FLOORS: Dict[str, Callable[[pathlib.Path], None]] = {
    draw.__name__: draw for draw in (bare, lounge, rooms, loft, narrows)}
