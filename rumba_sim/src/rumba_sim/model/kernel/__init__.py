"""What robots and movers do in one tick (drive, collide, count, drain, sweep), and what laser and infrared see.

These modules are plain Python that `compiled` hands to numba as a whole: they use only numbers, arrays and records, and
import only math, NumPy and each other. Uncompiled, the same functions give the same results about a hundred times
slower. No two functions have the same name: `compiled.fast` has all of them.

Units: [m], [rad], [s], [A], [Ah]. Arguments that many functions share:
    k: the record of constants (`constants.Constants`).
    robots: array of records of type ROBOT.
    field: float64 (rows + 1, columns + 1), clearance at the corners of the cells.
    cells: uint8 (rows, columns), the bits BLOCKED, CLIFF and CARPET of each cell.
    samples: uint8 (n * rows, n * columns), the bits SWEEPABLE and REACHABLE, and how often the brush passed, of the
        sample point in each of the n x n squares of a cell.
    dirt: float32 (rows, columns), dirt on the samples of each cell in the beginning.
    skips: uint8 (rows, columns), how many cells a beam may skip from anywhere in a cell, or IN_WALL
        (`FloorPlan.skips`).
    obstacles: array of records of type OBSTACLE, which the map does not show.
    docks: float64 (docks, 3), pose of a robot that stands at the contacts of each and faces it [m, rad].
    stops: float64 (all stops of all movers, 6), the columns X, Y, THETA, TRAVEL, LEAST and MOST of each stop.
In arrays of cells row 0 lies at the lowest y.
"""

from typing import Any, Tuple

Record = Any  # an element of an array of one of the types in `records`
Array = Any  # numpy.ndarray
Triple = Tuple[float, float, float]
