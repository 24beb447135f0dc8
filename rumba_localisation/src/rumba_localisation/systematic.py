"""By how much all ranges of a laser are too long or too short: it bends straight walls."""

import collections
from typing import Deque

import numpy as np

from rumba_localisation import compiled_bends
from rumba_localisation.scan import NEAREST, Scan
from rumba_sim.model.kernel import Array

# All these are our choice:
EACH = 4  # scans, of which one is looked at: more tell the same
MOST, FEWEST = 1000, 30  # walls that are remembered, and that tell something
EXACT = 0.03  # [m] standard deviation of what a wall tells, at most
CHANGE = 0.005  # [m] by which the estimate changes, at least: the map is drawn again each time


class Systematic:
    """The systematic error of the ranges of a laser, as the walls that it saw agree on it.

    Walls that are not straight bend in either way, so that they do not agree: half of what they tell must lie closer
    together than its median is large. Then this median is the error, else 0.

    Attributes:
        error: by how much ranges are too long [m].
    """

    def __init__(self) -> None:
        """Know of none."""
        self.error = 0.0
        self._seen = 0  # scans
        self._walls: Deque[Array] = collections.deque(maxlen=MOST)  # what each tells [m], and the variance of that

    def follow(self, scan: Scan) -> bool:
        """Learn from a scan as the laser told it, of a robot that moves; returns whether the error has changed."""
        self._seen += 1
        if (self._seen - 1) % EACH or not len(scan.points):
            return False
        by = scan.points - np.array(scan.laser)
        found = np.empty((len(by) // compiled_bends.FEWEST + 1, 2))
        count = compiled_bends.bends(np.hypot(by[:, 0], by[:, 1]), np.unwrap(np.arctan2(by[:, 1], by[:, 0])), found)
        self._walls.extend(found[:count][found[:count, 1] < EXACT ** 2])
        error = self._agreed()
        if abs(error - self.error) < CHANGE:
            return False
        self.error = error
        return True

    def _agreed(self) -> float:
        """The weighted median of what walls tell [m]; 0 if they do not agree."""
        if len(self._walls) < FEWEST:
            return 0.0
        errors, variances = np.array(self._walls).T
        order = np.argsort(errors, kind='stable')
        weights = np.cumsum(1.0 / variances[order])
        low, median, high = errors[order][np.searchsorted(weights, weights[-1] * np.array([0.25, 0.5, 0.75]))].tolist()
        return float(median) if high - low < abs(median) else 0.0

    def corrected(self, scan: Scan) -> Scan:
        """What the laser would tell without the error."""
        return scan if self.error == 0.0 else lengthened(scan, -self.error)


def lengthened(scan: Scan, by: float) -> Scan:
    """A scan of which all beams are longer by a length [m]."""
    here = np.array(scan.laser)

    def longer(points: Array) -> Array:
        lengths = np.hypot(points[:, 0] - here[0], points[:, 1] - here[1])
        return here + (points - here) * np.maximum(1.0 + by / np.maximum(lengths, NEAREST), 0.0)[:, np.newaxis]

    return scan._replace(points=longer(scan.points), beyond=longer(scan.beyond))
