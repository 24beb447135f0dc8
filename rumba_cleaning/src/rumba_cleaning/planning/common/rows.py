"""Rows of arrays."""

from typing import Tuple

import numpy as np

from rumba_sim.model.kernel import Array


def distinct(rows: Array) -> Tuple[Array, Array]:
    """The distinct rows of an array (any, columns), sorted, and the index of the first that is like each: int (any)."""
    if len(rows) == 0:  # NumPy before 1.18 refuses none
        return rows, np.zeros(0, np.intp)
    found, first = np.unique(rows, axis=0, return_index=True)
    return found, first
