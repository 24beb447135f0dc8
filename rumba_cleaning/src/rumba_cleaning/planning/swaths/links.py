"""Joins the lanes of a block: paths from the end of one lane to the start of the next."""

from typing import List

import numpy as np

from rumba_cleaning.belief import paths
from rumba_cleaning.belief.ground import Ground
from rumba_cleaning.planning.common.stretches import Variant, pair
from rumba_cleaning.planning.swaths import compiled_links
from rumba_sim.model.floors.reachability import SLACK
from rumba_sim.model.kernel import Array

SAME = 1e-6  # [m] waypoints so near to each other are one
NO_POINTS = np.zeros((0, 2))


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
    parts = [lanes[0] if first == 0 else lanes[0][::-1]]
    for index, lane in enumerate(lanes[1:], 1):
        parts[-1:] = _joined(ground, parts[-1], lane if index % 2 == first else lane[::-1])
    path = np.concatenate(parts)
    return np.asarray(path[np.append(True, np.hypot(*np.diff(path, axis=0).T) > SAME)])


def _joined(ground: Ground, lane: Array, following: Array) -> List[Array]:
    """A lane with the waypoints from it to the next lane, and that lane: float64 (any, 2) [m] each."""
    path = compiled_links.joined(ground.clearance, ground.plan.origin, ground.plan.resolution, ground.reach + SLACK,
                                 np.ascontiguousarray(lane), np.ascontiguousarray(following))
    if len(path):
        return [path[:-2], path[-2:]]
    way = paths.between(ground, lane[-1], following[0])
    return [lane, NO_POINTS if way is None else way[1:-1], following]
