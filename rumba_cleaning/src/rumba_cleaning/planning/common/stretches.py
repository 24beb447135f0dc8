"""Stretches: parts of the floor to clean, each by one of several paths."""

from typing import List, NamedTuple

import numpy as np

from rumba_cleaning.compiled_bearings import bearings
from rumba_sim.model.kernel import Array

CLOSE = 0.02  # [m] points so near to each other have no direction between them
AHEAD = 2  # waypoints from the end of a path, over which its heading is measured


class Variant(NamedTuple):
    """One path over a stretch."""

    parts: List[Array]  # float64 (any, 2) [m] each, one behind the other
    is_backward: bool  # whether the path leads from the end of the last part to the beginning of the first

    def path(self) -> Array:
        """The waypoints: float64 (any, 2) [m]."""
        path = np.concatenate(self.parts)
        return path[::-1] if self.is_backward else path

    def ends(self) -> Array:
        """Its first waypoint, one ahead of that, one before the last, and the last: float64 (4, 2) [m]."""
        first, last = self.parts[0], self.parts[-1]
        ends = np.array([first[0], first[min(AHEAD, len(first) - 1)], last[max(len(last) - 1 - AHEAD, 0)], last[-1]])
        return ends[::-1] if self.is_backward else ends


def headings(points: Array, ahead: Array) -> Array:
    """Directions from points (..., 2) [m] to others: float64 (...) [rad]; NaN if they are CLOSE."""
    along = ahead - points
    angles = bearings(along.reshape(-1, 2)).reshape(along.shape[:-1])
    return np.where(np.hypot(along[..., 0], along[..., 1]) > CLOSE, angles, np.nan)


class Stretch(NamedTuple):
    """A part of the floor to clean."""

    variants: List[Variant]  # in pairs: a path, and the same path backward
    region: int  # label of the region in which it lies
    area: float  # [m^2] that it cleans, about


def pair(parts: List[Array]) -> List[Variant]:
    """A path over parts, float64 (any, 2) [m] each, and the same path backward."""
    return [Variant(parts, False), Variant(parts, True)]
