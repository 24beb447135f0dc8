"""The nearest of many points, the same with each version of SciPy: where some are equally far, its choice differs."""

from typing import Any

import numpy as np

from rumba_cleaning.planning.common.compiled_ways import NONE
from rumba_sim.model.kernel import Array

ROUNDING = 1.0 + 1e-9  # of a distance, whose square is compared


def nearest(tree: Any, points: Array, count: int, farthest: float) -> Array:
    """The points of a tree that are nearest to each of some points.

    Args:
        tree: scipy.spatial.cKDTree of float64 (any, 2) [m].
        points: float64 (points, 2) [m].
        count: of those that are found for each point, at most.
        farthest: away from it [m], at most.

    Returns:
        int (points, count), the indices of those near to each point, the nearest first, and those equally far by their
        indices; NONE for no more.
    """
    found = np.full((len(points), count), NONE)
    distances = tree.query(points, [count], distance_upper_bound=farthest)[0][:, 0]
    reaches = np.where(np.isfinite(distances), distances * ROUNDING, farthest)
    for row, point, reach in zip(found, points, reaches):
        near = np.array(tree.query_ball_point(point, reach), np.intp)
        squares = ((tree.data[near] - point) ** 2).sum(axis=1)
        chosen = near[np.lexsort((near, squares))[:count]]
        row[:len(chosen)] = chosen
    return found
