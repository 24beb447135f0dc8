"""Draw the room of the exercises: draw.py, in a ./rumba shell.

Lengths are in metres, x points to the right and y up; (0, 0) is the lower left inner corner.
"""

import pathlib

from rumba_sim.model.drawing import FREE, ROBOT_AT_WALL, Drawing


def main() -> None:
    """Draw a room of 3.0 m by 2.4 m with a cupboard in a corner, which tells one end of it from the other."""
    plan = Drawing(-0.2, -0.2, 3.2, 2.6, 0.02)
    plan.paint(plan.box(-0.1, -0.1, 3.1, 2.5))
    plan.paint(plan.box(0.0, 0.0, 3.0, 2.4), FREE)
    plan.paint(plan.box(0.0, 1.8, 0.6, 2.4))
    plan.save(pathlib.Path(__file__).parent, 'room', 'The room of the exercises; drawn by draw.py',
              {'dock': (3.0 - ROBOT_AT_WALL, 1.2, 0.0)})


if __name__ == '__main__':
    main()
