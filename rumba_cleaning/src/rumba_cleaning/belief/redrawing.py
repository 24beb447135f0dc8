"""How a map that was redrawn, since a loop closed, differs from the one before."""

from typing import Callable

import numpy as np
from scipy.spatial import cKDTree

from rumba_sim.model.kernel import Array

STILL = 0.001  # [m], [rad] by which key frames may differ from message to message


def is_redrawn(before: Array, after: Array) -> bool:
    """Whether key frames have moved; those that are new have not."""
    count = min(len(before), len(after))
    change = after[:count] - before[:count]
    change[:, 2] = np.angle(np.exp(1j * change[:, 2]))
    return bool((np.abs(change) > STILL).any())


def way_back(before: Array, after: Array) -> Callable[[Array], Array]:
    """A function that tells where on the map before was what is at points on the redrawn one: (any, 2) [m].

    Each point stays at the key frame that is nearest.

    Args:
        before, after: poses of the key frames, float64 (any, 3).
    """
    count = min(len(before), len(after))
    before, after = before[:count], after[:count]
    tree, turn = cKDTree(after[:, :2]), before[:, 2] - after[:, 2]

    def moved(points: Array) -> Array:
        nearest = tree.query(points)[1]
        x, y = (points - after[nearest, :2]).T
        cos, sin = np.cos(turn[nearest]), np.sin(turn[nearest])
        return np.asarray(before[nearest, :2] + np.stack([cos * x - sin * y, sin * x + cos * y], axis=1))

    return moved
