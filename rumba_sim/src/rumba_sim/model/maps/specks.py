"""Specks: small areas of unknown cells that free floor surrounds, which a laser has missed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy import ndimage

from rumba_sim.model.maps.floor_plan import FREE, UNKNOWN

if TYPE_CHECKING:  # NumPy 1.17 of Ubuntu 20.04 has no numpy.typing
    from numpy.typing import NDArray

ALL_AROUND = np.ones((3, 3), bool)


def specks(occupancy: NDArray[np.int8], most: int) -> NDArray[np.int32]:
    """The number of the speck to which each cell belongs, from 1 on; 0 in all other cells.

    Unknown cells beside a wall, or at the edge of the map, may hide more of the wall: they are no specks.

    Args:
        occupancy: int8 (rows, columns), as in `FloorPlan`.
        most: cells of a speck, at most.
    """
    areas, number = ndimage.label(occupancy == UNKNOWN, ALL_AROUND)
    is_speck = np.bincount(areas.ravel(), minlength=number + 1) <= most
    is_speck[0] = False
    for edge in (areas[0], areas[-1], areas[:, 0], areas[:, -1]):
        is_speck[edge] = False
    beside_walls = ndimage.binary_dilation((occupancy != FREE) & (occupancy != UNKNOWN), ALL_AROUND)
    is_speck[areas[beside_walls]] = False
    is_speck[0] = False
    numbers = np.cumsum(is_speck, dtype=np.int32) * is_speck
    return np.asarray(numbers[areas], np.int32)
