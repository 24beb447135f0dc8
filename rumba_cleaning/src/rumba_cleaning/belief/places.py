"""Places where a robot can stand out of the way."""

import numpy as np
from scipy import spatial

from rumba_cleaning.belief.ground import Ground
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.kernel import Array

GRID = 0.1  # [m] between the places that are looked at; our choice


def places_apart(ground: Ground, pose: Pose, farthest: float, taken: Array, apart: float) -> Array:
    """Where a robot could stand, the nearest place first.

    Args:
        ground: what the robot knows.
        pose: around which places are looked for.
        farthest: from there [m], at most.
        taken: points (any, 2) [m] ...
        apart: ... that are farther [m] from each place.

    Returns:
        float64 (any, 2) [m]
    """
    steps = np.arange(-farthest, farthest + 0.5 * GRID, GRID)
    places = np.stack(np.meshgrid(steps, steps), axis=-1).reshape(-1, 2)
    places = np.array(pose[:2]) + places[np.hypot(*places.T) <= farthest]
    places = places[ground.are_free(places) & (spatial.distance.cdist(places, taken).min(axis=1) > apart)]
    return np.asarray(places[np.argsort(np.hypot(*(places - pose[:2]).T), kind='stable')])
