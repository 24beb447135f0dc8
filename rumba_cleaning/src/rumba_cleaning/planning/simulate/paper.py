"""Driving on paper: what would be swept if a robot drove exactly along a path."""

import math

import numpy as np

from rumba_cleaning.belief.swept import Swept
from rumba_cleaning.compiled_bearings import bearings
from rumba_cleaning.planning.common.polyline import simplified, strides
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
