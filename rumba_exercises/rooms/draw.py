"""Draw the room of the exercises: draw.py, in a ./rumba shell.

Lengths are in metres, x points to the right and y up; (2, 1) is the lower left inner corner, so that whoever forgets
the origin of the map is wrong.
"""

import pathlib

from rumba_sim.model.maps.drawing import FREE, ROBOT_AT_WALL, Drawing


def main() -> None:
    """Draw a room of 3.0 m by 2.4 m with a cupboard in a corner, which tells one end of it from the other."""
    plan = Drawing(1.8, 0.8, 5.2, 3.6, 0.02)
    plan.paint(plan.box(1.9, 0.9, 5.1, 3.5))
    plan.paint(plan.box(2.0, 1.0, 5.0, 3.4), FREE)
    plan.paint(plan.box(2.0, 2.8, 2.6, 3.4))
    plan.save(pathlib.Path(__file__).parent, 'room', 'The room of the exercises; drawn by draw.py',
              {'dock': (5.0 - ROBOT_AT_WALL, 2.2, 0.0)})


if __name__ == '__main__':
    main()
