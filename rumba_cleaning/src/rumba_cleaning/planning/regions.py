"""Parts a floor into rooms: basins of the distance to the walls, parted at doors and other narrow places."""

import numpy as np
from scipy import ndimage
from skimage import segmentation

from rumba_cleaning.belief.ground import Ground
from rumba_sim.model.kernel import Array

WIDE = 0.5  # [m] from a wall: where a room is so roomy it is no door
LEAST = 0.6  # [m^2] that are so roomy make a room of their own


def rooms(ground: Ground) -> Array:
    """The room of each node: int (rows + 1, columns + 1), from 1; 0 where the robot cannot stand."""
    seeds, _ = ndimage.label(ground.room >= WIDE)
    seeds[(np.bincount(seeds.ravel()) * ground.plan.resolution ** 2 < LEAST)[seeds]] = 0
    regions, count = ndimage.label(ground.fits, np.ones((3, 3)))
    has_seed = np.zeros(count + 1, np.bool_)
    has_seed[regions[seeds > 0]] = True
    narrow = ground.fits & ~has_seed[regions]
    seeds = np.where(narrow, regions + seeds.max(), seeds)
    return np.asarray(segmentation.watershed(-ground.room, seeds, connectivity=2, mask=ground.fits))
