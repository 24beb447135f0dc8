"""Keeps numbers within limits."""

import numpy as np

from rumba_sim.model.kernel import Array


def limited(values: Array, low: Array, high: Array) -> Array:
    """As np.clip, which takes several times as long if there are few values."""
    return np.minimum(np.maximum(values, low), high)
