"""Parts a floor into regions, such as the rooms of a flat, at doors and other narrow passages.

A watershed of the clearance: each region grows from a wide part of the floor, and two regions meet where the passage
between them is narrowest (skimage.segmentation.watershed).
"""

import numpy as np
from scipy import ndimage
from skimage import segmentation

from rumba_cleaning.belief.ground import Ground
from rumba_sim.model.kernel import Array

# Our choice: 2 * WIDE is wider than the doors of dwellings (0.7 to 0.9 m), and narrower than a room.
WIDE = 0.5  # [m] clearance that no point in a door has
LEAST = 0.6  # [m^2] with such clearance make a region of their own; less belongs to the region beside it


def regions(ground: Ground) -> Array:
    """The region of each node: int (rows + 1, columns + 1), from 1; 0 if the robot cannot stand there."""
    seeds, _ = ndimage.label(ground.clearance >= WIDE)
    seeds[(np.bincount(seeds.ravel()) * ground.plan.resolution ** 2 < LEAST)[seeds]] = 0
    connected, count = ndimage.label(ground.fits, np.ones((3, 3)))
    has_seed = np.zeros(count + 1, np.bool_)
    has_seed[connected[seeds > 0]] = True
    narrow = ground.fits & ~has_seed[connected]
    seeds = np.where(narrow, connected + seeds.max(), seeds)
    return np.asarray(segmentation.watershed(-ground.clearance, seeds, connectivity=2, mask=ground.fits))
