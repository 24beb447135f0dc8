"""Driving on paper: what would be swept if a robot drove exactly along a path."""

import math

import numpy as np

from rumba_cleaning.belief.swept import Swept
from rumba_cleaning.compiled_bearings import bearings
from rumba_cleaning.planning import compiled_ways
from rumba_cleaning.route import lengths_along
from rumba_sim.model.kernel import Array

STRIDE = 0.5  # [m] that are swept at once on a straight line: large is fast, but looks at more floor on a slanted one
OFF = 0.005  # [m] by which the path on paper may differ: large is fast, small is exact
SAME = 0.2  # [rad] turns by less are not swept on their own: between their strips 1 cm is missed at most


def drive(swept: Swept, path: Array) -> None:
    """Sweep along a path (any, 2) [m], with turns on the spot at its corners."""
    points = strides(simplified(path, OFF), STRIDE)
    headings = bearings(np.diff(points, axis=0))
    before = np.append(headings[:1], headings[:-1])
    here, there = points[:-1], points[1:]
    moves = np.stack([_poses(here, before), _poses(here, headings), _poses(there, headings)], axis=1)  # (any, 3, 3)
    is_corner = np.abs((headings - before + math.pi) % (2.0 * math.pi) - math.pi) > SAME
    is_driven = np.stack([is_corner, np.ones_like(is_corner)], axis=1)
    swept.sweep_all(moves[:, :2][is_driven], moves[:, 1:][is_driven])


def _poses(points: Array, headings: Array) -> Array:
    """x [m], y [m] and theta [rad] at each point: float64 (any, 3)."""
    return np.concatenate([points, headings[:, np.newaxis]], axis=1)


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
