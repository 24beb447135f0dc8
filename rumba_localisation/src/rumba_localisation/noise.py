"""How far the ends of beams are from the walls that they hit: each laser errs in its own way, and so does each map."""

from typing import Tuple

import numpy as np

from rumba_localisation import compiled_matching
from rumba_sim.model.kernel import Array

# All these are our choice:
FIRST, LEAST, MOST = 0.02, 0.01, 0.15  # [m] standard deviation that is supposed at first, and bounds of the estimate
KERNEL = 2.0  # standard deviations of the narrowest step of a match: with noise alone, 0.9 of the beams fit
COARSE = np.geomspace(5.0, 1.0, 6)  # sigmas of the steps of a match, in units of the narrowest
RANGES = np.array([1.0, 2.0, 4.0, 8.0])  # [m] borders of the classes of ranges: most lasers err more, the farther
NORMAL = 1.4826  # standard deviations of a normal distribution, for each unit of its median deviation
FAR = 10.0  # standard deviations from a wall, from which on a beam hit something that the map does not show
FEWEST = 10  # beams nearer than that, fewer tell nothing
MEMORY = 50  # scans
SETTLED = 10  # scans after which the estimate is worth something


class Noise:
    """The standard deviations of the distances between ends of beams and walls, by the scans that fit."""

    def __init__(self, sigma: float = 0.0) -> None:
        """Be told the standard deviation [m]; 0 to estimate it for each class of ranges."""
        self._told = sigma
        self.begin()

    def begin(self) -> None:
        """Know no more than was told."""
        self._sigmas = np.full(len(RANGES) + 1, self._told or FIRST)  # [m] by class
        self._scans = np.zeros(len(RANGES) + 1, np.int64)  # from which each was learnt

    @property
    def sigma(self) -> float:
        """Standard deviation of the class of ranges that errs least [m]."""
        known = self._sigmas[self._scans > 0]
        return float(known.min()) if len(known) else float(self._sigmas[0])

    @property
    def kernel(self) -> float:
        """Sigma of the narrowest step of a match, for the ranges that err least [m]."""
        return KERNEL * self.sigma

    @property
    def steps(self) -> Array:
        """Sigmas of the steps of a match, falling: float64 (6) [m]; `kernels` says which are too small for a beam."""
        return self.kernel * COARSE

    @property
    def is_settled(self) -> bool:
        """Whether enough scans were seen."""
        return self._told > 0.0 or int(self._scans.max()) >= SETTLED

    def kernels(self, points: Array, laser: Tuple[float, float] = (0.0, 0.0)) -> Array:
        """Sigmas of the narrowest step of a match for beams: float64 (beams) [m].

        Args:
            points: float64 (beams, 2), where they end, in the frame of the robot [m].
            laser: where they begin.
        """
        return np.asarray(KERNEL * self._sigmas[_classes(points, laser)])

    def follow(self, pose: Array, points: Array, laser: Tuple[float, float], distance: Array, left: float,
               bottom: float, resolution: float) -> None:
        """Learn from a scan that fits: the median tells little of the beams that hit what the map does not show.

        Args:
            pose: float64 (3), where it fits.
            points, laser: as for `kernels`.
            distance, left, bottom, resolution: of the map, as for `compiled_matching`.
        """
        if self._told > 0.0:
            return
        away = np.abs(compiled_matching.distances(pose, points, distance, left, bottom, resolution))
        classes = _classes(points, laser)
        for index in range(len(self._sigmas)):
            near = away[(classes == index) & (away < FAR * self._sigmas[index])]  # off the map it is NaN
            if len(near) >= FEWEST:
                self._learn(index, NORMAL * float(np.median(near)))

    def _learn(self, index: int, sigma: float) -> None:
        """Learn of a class; those of longer ranges of which nothing is known yet err as much at least."""
        self._scans[index] += 1
        self._sigmas[index] += (sigma - self._sigmas[index]) / min(self._scans[index], MEMORY)
        self._sigmas[index] = min(max(self._sigmas[index], LEAST), MOST)
        for other in range(index + 1, len(self._sigmas)):
            if self._scans[other]:
                break
            self._sigmas[other] = max(FIRST, self._sigmas[index])


def _classes(points: Array, laser: Tuple[float, float]) -> Array:
    """The class of ranges of each beam: int64 (beams)."""
    return np.searchsorted(RANGES, np.hypot(points[:, 0] - laser[0], points[:, 1] - laser[1]))
