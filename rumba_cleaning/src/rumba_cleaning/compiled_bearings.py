"""Directions, compiled by numba.

`math.atan2` is that of the C library, with each library set. NumPy has an arctan2 of its own for some processors, whose
last bit differs: enough for another plan, since plans choose between what is nearly alike.
"""

import math
from typing import Any

import numpy as np

from rumba_sim.model.compiling.jit import compiled

Array = Any  # numpy.ndarray


@compiled
def bearings(legs: Array) -> Array:
    """The directions of legs, float64 (any, 2) [m]: float64 (any) [rad]."""
    found = np.empty(len(legs))
    for index in range(len(legs)):
        found[index] = math.atan2(legs[index, 1], legs[index, 0])
    return found
