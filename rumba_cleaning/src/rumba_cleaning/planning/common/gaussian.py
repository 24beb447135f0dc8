"""Weights of a Gaussian filter, which are the same with each build of NumPy and on each processor: np.exp is not."""

import math

import numpy as np

from rumba_sim.model.kernel import Array

REACH = 4.0  # standard deviations


def weights(sigma: float) -> Array:
    """Weights of samples around one, whose sum is 1: float64 (odd).

    Args:
        sigma: standard deviation, in samples.
    """
    reach = int(REACH * sigma + 0.5)
    found = np.array([math.exp(-0.5 / sigma ** 2 * offset ** 2) for offset in range(-reach, reach + 1)])
    return np.asarray(found / found.sum())
