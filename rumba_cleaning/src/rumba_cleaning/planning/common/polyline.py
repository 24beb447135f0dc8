"""Lines over waypoints: with more of them, or with fewer."""

import numpy as np

from rumba_cleaning.planning.common import compiled_ways
from rumba_cleaning.route import lengths_along
from rumba_sim.model.kernel import Array

SPACING = 0.02  # [m] between the waypoints of outlines and rings; our choice


def strides(path: Array, longest: float) -> Array:
    """A path (any, 2) [m] with more waypoints on its legs, so that none is longer [m]."""
    legs = np.diff(path, axis=0)
    counts = stride_counts(path, longest)
    indices = np.repeat(np.arange(len(legs)), counts)
    shares = (np.arange(len(indices)) - np.repeat(np.cumsum(counts) - counts, counts) + 1) / counts[indices]
    return np.concatenate([path[:1], path[indices] + shares[:, np.newaxis] * legs[indices]])


def stride_counts(path: Array, longest: float) -> Array:
    """Into how many strides, none of them longer [m], each leg of a path (any, 2) [m] is divided: int (any - 1)."""
    return np.maximum(np.ceil(np.hypot(*np.diff(path, axis=0).T) / longest).astype(np.intp), 1)


def resampled(path: Array, spacing: float) -> Array:
    """A path (any, 2) [m] with waypoints that are about a spacing [m] apart, all the way along."""
    lengths = lengths_along(path)
    along = np.linspace(0.0, lengths[-1], max(int(lengths[-1] / spacing), 1) + 1)
    return np.stack([np.interp(along, lengths, path[:, axis]) for axis in (0, 1)], axis=1)


def simplified(path: Array, off: float) -> Array:
    """A path (any, 2) [m] without waypoints that are no farther than `off` [m] from the line between others.

    (D. Douglas and T. Peucker, Algorithms for the reduction of the number of points required to represent a digitized
    line or its caricature, 1973.)
    """
    return np.asarray(path[compiled_ways.kept(path, off)])
