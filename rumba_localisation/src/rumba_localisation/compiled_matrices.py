"""Symmetric matrices (3, 3) in closed form, compiled by numba.

A library of linear algebra may share even so small a problem out among threads, which wait for each other for far
longer than the problem takes: more than a third of the CPU time of a mission by a map of its own went into that.
"""

from typing import Any

import numpy as np

from rumba_sim.model.compiling.jit import compiled

Array = Any  # numpy.ndarray


@compiled
def inverse(matrix: Array) -> Array:
    """The inverse of a symmetric positive definite matrix, by its cofactors: float64 (3, 3)."""
    a, b, c = matrix[0, 0], matrix[0, 1], matrix[0, 2]
    d, e, f = matrix[1, 1], matrix[1, 2], matrix[2, 2]
    found = np.empty((3, 3))
    found[0, 0], found[0, 1], found[0, 2] = d * f - e * e, c * e - b * f, b * e - c * d
    found[1, 1], found[1, 2], found[2, 2] = a * f - c * c, b * c - a * e, a * d - b * b
    found[1, 0], found[2, 0], found[2, 1] = found[0, 1], found[0, 2], found[1, 2]
    return found / (a * found[0, 0] + b * found[0, 1] + c * found[0, 2])


@compiled
def product(matrix: Array, vector: Array) -> Array:
    """A matrix (3, 3) times a vector (3): float64 (3)."""
    found = np.empty(3)
    for row in range(3):
        found[row] = matrix[row, 0] * vector[0] + matrix[row, 1] * vector[1] + matrix[row, 2] * vector[2]
    return found
