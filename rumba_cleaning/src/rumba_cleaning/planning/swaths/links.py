"""Joins the lanes of a block: paths from the end of one lane to the start of the next."""

from typing import List

import numpy as np

from rumba_cleaning.belief import paths
from rumba_cleaning.belief.ground import Ground
from rumba_cleaning.planning.common.stretches import Variant, pair
from rumba_sim.model.kernel import Array


def block_variants(ground: Ground, lanes: List[Array], path: Array) -> List[Variant]:
    """The paths through the lanes of a block, in pairs: from each end of the first lane, and backward.

    Args:
        ground: where the robot can stand.
        lanes: float64 (2, 2) [m] each, side by side, all in the same direction.
        path: through them, as `through` finds it, from the end 0.
    """
    return pair([path]) + (pair([through(ground, lanes, 1)]) if len(lanes) > 1 else [])


def through(ground: Ground, lanes: List[Array], first: int) -> Array:
    """The path through lanes, to and fro: float64 (any, 2) [m]; it begins at the end `first`, 0 or 1, of lane 0."""
    parts: List[Array] = []
    for index, lane in enumerate(lanes):
        ends = lane if index % 2 == first else lane[::-1]
        way = paths.between(ground, parts[-1][-1], ends[0]) if parts else None
        parts += [ends] if way is None else [way[1:-1], ends]
    return np.concatenate(parts)
