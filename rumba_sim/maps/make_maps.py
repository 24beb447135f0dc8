"""Draw the maps of this folder: make_maps.py [FOLDER], in a ./rumba shell.

Lengths are in metres, x points to the right and y up; (0, 0) is the lower left inner corner.
"""

import math
import pathlib
import sys
from typing import Callable, Tuple

from rumba_sim.model.maps.drawing import FREE, ROBOT_AT_WALL, UNKNOWN, Drawing

BY = '; drawn by make_maps.py'


def apartment(folder: pathlib.Path) -> None:
    """Draw an apartment: kitchen, hall and bath above; living room and bedroom below."""
    plan = Drawing(-0.4, -0.4, 9.0, 7.0, 0.02)
    rooms = [plan.box(0.0, 0.0, 4.8, 3.8), plan.box(4.92, 0.0, 8.6, 3.3), plan.box(0.0, 3.92, 3.0, 6.6),
             plan.box(3.12, 3.92, 6.08, 6.6), plan.box(4.92, 3.42, 6.08, 3.92), plan.box(6.2, 3.42, 8.6, 5.5)]
    plan.paint(plan.box(-0.24, -0.24, 8.84, 5.74))
    plan.paint(plan.box(-0.24, 5.74, 6.32, 6.84))
    for room in rooms:
        plan.paint(room, FREE)
    doors(plan)
    living_room(plan)
    kitchen(plan)
    hall(plan)
    bath(plan)
    bedroom(plan)
    dock = 4.8 - ROBOT_AT_WALL, 3.24, 0.0
    plan.save(folder, 'apartment', 'An apartment of 52 m2, furnished' + BY, {'dock': dock})
    plan.save_with_docks(
        folder, 'apartment_docks', 'apartment', 'The apartment with docks in living room, hall and bedroom' + BY,
        [dock, (6.08 - ROBOT_AT_WALL, 4.2, 0.0), (6.1, 3.3 - ROBOT_AT_WALL, 0.5 * math.pi)])


def doors(plan: Drawing) -> None:
    """Draw open doors of 0.8 m, and a closed front door and windows, which are thinner than the wall."""
    plan.paint(plan.box(3.6, 3.8, 4.4, 3.92), FREE)  # living room - hall
    plan.paint(plan.box(2.0, 3.8, 2.8, 3.92), FREE)  # living room - kitchen
    plan.paint(plan.box(3.0, 4.2, 3.12, 5.0), FREE)  # kitchen - hall
    plan.paint(plan.box(5.0, 3.3, 5.8, 3.42), FREE)  # bedroom - hall
    plan.paint(plan.box(6.08, 4.62, 6.2, 5.42), FREE)  # bath - hall
    plan.paint(plan.box(3.6, 6.68, 4.5, 6.84), UNKNOWN)  # front door
    for window in (plan.box(1.8, -0.24, 3.8, -0.08), plan.box(-0.24, 4.4, -0.08, 5.6),
                   plan.box(8.68, 1.1, 8.84, 2.3), plan.box(8.68, 4.0, 8.84, 4.6)):
        plan.paint(window, UNKNOWN)


def living_room(plan: Drawing) -> None:
    """Draw a corner sofa, a coffee table on a carpet, a television, an armchair."""
    plan.furniture(plan.box(0.0, 0.6, 0.9, 2.8) | plan.box(0.9, 0.6, 1.6, 1.4),  # sofa: back and cushions
                   plan.box(0.24, 2.1, 0.9, 2.6), plan.box(0.24, 1.4, 0.9, 2.1), plan.box(0.24, 0.8, 1.6, 1.4))
    plan.furniture(plan.box(0.0, 0.1, 0.4, 0.5), plan.disc(0.2, 0.3, 0.1))  # side table, lamp
    plan.legs(1.4, 1.8, 2.0, 2.7, 0.06)  # coffee table
    plan.furniture(plan.box(4.36, 0.9, 4.8, 2.5), plan.box(4.56, 1.1, 4.64, 2.3))  # television on its board
    plan.furniture(plan.turned_box(3.0, 0.8, 0.76, 0.72, 115.0),  # armchair
                   plan.turned_box(2.96, 0.88, 0.56, 0.44, 115.0))
    for left in (0.1, 0.9):
        plan.furniture(plan.box(left, 3.48, left + 0.8, 3.8))  # bookshelves
    plan.furniture(plan.disc(2.1, 0.3, 0.14))  # floor lamp
    plan.furniture(plan.disc(4.54, 0.26, 0.2), plan.disc(4.54, 0.26, 0.1))  # plant in its pot
    plan.layers['carpet'] = plan.box(0.96, 1.5, 2.6, 3.0)


def kitchen(plan: Drawing) -> None:
    """Draw a counter and a table; Rumba fits under two of its chairs, and two are too narrow."""
    plan.furniture(plan.box(0.0, 6.0, 2.4, 6.6), plan.box(1.5, 6.12, 2.1, 6.5))  # counter, sink
    plan.furniture(*(plan.disc(x, y, 0.1) for x in (0.5, 0.78) for y in (6.16, 6.42)))  # hob
    plan.furniture(plan.box(2.4, 5.94, 3.0, 6.6))  # refrigerator
    plan.legs(0.44, 4.48, 1.64, 5.24, 0.06)  # table
    for left in (0.54, 1.08):
        plan.legs(left, 5.16, left + 0.46, 5.6)
    for left in (0.6, 1.1):
        plan.legs(left, 4.1, left + 0.4, 4.5)
    plan.furniture(plan.disc(2.8, 5.74, 0.14))  # bin


def hall(plan: Drawing) -> None:
    """Draw a step down behind the front door, shoes and coats."""
    plan.furniture(plan.box(3.12, 5.7, 3.42, 6.5))  # shoes
    plan.furniture(plan.box(5.62, 5.54, 6.08, 6.6), plan.box(5.62, 5.54, 6.08, 6.06))  # coats
    plan.furniture(plan.disc(4.92, 6.44, 0.12))  # umbrellas
    plan.layers['cliff'] = plan.box(3.12, 5.6, 4.72, 6.6) & (plan.floor == FREE)


def bath(plan: Drawing) -> None:
    """Draw a bathtub, a washing machine, a basin and a toilet."""
    plan.paint(plan.box(6.2, 5.44, 7.0, 5.48))  # the door
    plan.furniture(plan.box(7.88, 3.42, 8.6, 5.5), plan.box(7.98, 3.52, 8.5, 5.06))  # bathtub
    plan.furniture(plan.box(7.26, 4.88, 7.88, 5.5), plan.disc(7.57, 5.19, 0.22))  # washing machine
    plan.furniture(plan.box(6.36, 3.42, 6.96, 3.86), plan.disc(6.66, 3.66, 0.15))  # basin
    plan.furniture(plan.box(7.24, 3.58, 7.56, 3.86) | plan.disc(7.4, 3.86, 0.16),  # toilet
                   plan.box(7.2, 3.42, 7.6, 3.6))


def bedroom(plan: Drawing) -> None:
    """Draw a double bed between two night tables, wardrobes, a chest of drawers."""
    plan.furniture(plan.box(6.5, 0.9, 8.6, 2.5), plan.box(6.5, 0.9, 7.9, 2.5),  # bed, blanket, pillows
                   plan.box(8.1, 1.0, 8.5, 1.6), plan.box(8.1, 1.8, 8.5, 2.4))
    for bottom in (0.5, 2.5):
        plan.furniture(plan.box(8.2, bottom, 8.6, bottom + 0.4))  # night tables
    for bottom in (0.0, 1.1):
        plan.furniture(plan.box(4.92, bottom, 5.52, bottom + 1.1))  # wardrobes
    plan.furniture(plan.box(6.0, 0.0, 7.2, 0.44))  # chest of drawers
    plan.paint(plan.box(4.94, 2.5, 4.98, 3.3))  # the door


def studio(folder: pathlib.Path) -> None:
    """Draw a studio: one room with a bath in its corner."""
    plan = Drawing(-0.4, -0.4, 5.4, 4.6, 0.02)
    plan.paint(plan.box(-0.24, -0.24, 5.24, 4.44))
    plan.paint(plan.box(0.0, 0.0, 5.0, 4.2), FREE)
    plan.paint(plan.box(3.28, 2.38, 5.0, 4.2))
    plan.paint(plan.box(3.4, 2.5, 5.0, 4.2), FREE)
    plan.paint(plan.box(3.28, 3.34, 3.4, 4.14), FREE)  # door of the bath
    plan.paint(plan.box(2.2, 4.28, 3.1, 4.44), UNKNOWN)  # front door
    plan.paint(plan.box(-0.24, 1.6, -0.08, 3.0), UNKNOWN)  # window
    plan.furniture(plan.box(0.0, 3.6, 1.9, 4.2), plan.box(0.0, 3.6, 0.6, 4.2),  # kitchen: refrigerator, sink, hob
                   plan.box(0.8, 3.7, 1.2, 4.1), plan.disc(1.6, 3.76, 0.09), plan.disc(1.6, 4.0, 0.11))
    plan.furniture(plan.box(0.0, 0.0, 2.04, 1.4), plan.box(0.6, 0.0, 2.04, 1.4),  # bed, blanket, pillow
                   plan.box(0.1, 0.4, 0.5, 1.0))
    plan.furniture(plan.box(0.0, 1.4, 0.4, 1.8))  # night table
    plan.furniture(plan.box(2.8, 0.0, 4.2, 0.8), plan.box(3.0, 0.2, 3.5, 0.8), plan.box(3.5, 0.2, 4.0, 0.8))  # sofa
    plan.furniture(plan.disc(3.1, 1.5, 0.2))  # table on one foot
    plan.legs(4.3, 0.96, 5.0, 2.36, 0.06)  # desk
    plan.paint(plan.disc(4.24, 1.9, 0.05))  # swivel chair on five castors
    for degrees in range(18, 378, 72):
        angle = math.radians(degrees)
        plan.paint(plan.disc(4.24 + 0.28 * math.cos(angle), 1.9 + 0.28 * math.sin(angle), 0.035))
    plan.furniture(plan.box(4.2, 3.4, 5.0, 4.2), plan.disc(4.6, 3.8, 0.06))  # shower
    plan.furniture(plan.box(3.5, 2.5, 4.0, 2.9), plan.disc(3.75, 2.72, 0.14))  # basin
    plan.furniture(plan.box(4.56, 2.76, 4.84, 3.08) | plan.disc(4.56, 2.92, 0.16),  # toilet
                   plan.box(4.82, 2.7, 5.0, 3.14))
    plan.layers['carpet'] = plan.box(2.3, 0.96, 3.9, 2.1)
    plan.save(folder, 'studio', 'A studio of 21 m2, furnished' + BY, {'dock': (3.28 - ROBOT_AT_WALL, 2.84, 0.0)})


def field(folder: pathlib.Path) -> None:
    """Draw the field of turtlesim: 500 pixels at 45 per metre; a turtle can drive from 0 to 499 / 45."""
    size, cell = 499.0 / 45.0, 0.05
    side = math.ceil(size / cell) * cell
    plan = Drawing(-cell, -cell, side + cell, side + cell, cell)
    plan.paint(plan.box(-cell, -cell, side + cell, side + cell))
    plan.paint(plan.box(0.0, 0.0, side, side), FREE)
    plan.save(folder, 'field', 'The empty field of turtlesim, rounded up to whole cells' + BY,
              {'dock': (side - ROBOT_AT_WALL, size / 2.0, 0.0), 'start': (size / 2.0, size / 2.0, 0.0)})


MAPS: Tuple[Callable[[pathlib.Path], None], ...] = (apartment, studio, field)

if __name__ == '__main__':
    target = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parent
    for draw in MAPS:
        draw(target)
