"""How far the ends of beams are from the walls that they hit: each laser errs in its own way, and so does each map."""

import numpy as np

from rumba_localisation import compiled_matching
from rumba_sim.model.kernel import Array

# All these are our choice:
FIRST, LEAST, MOST = 0.02, 0.01, 0.15  # [m] standard deviation that is supposed at first, and bounds of the estimate
KERNEL = 2.0  # standard deviations of the narrowest step of a match: with noise alone, 0.9 of the beams fit
COARSE = np.geomspace(5.0, 1.0, 6)  # sigmas of the steps of a match, in units of the narrowest
NORMAL = 1.4826  # standard deviations of a normal distribution, for each unit of its median deviation
FAR = 10.0  # standard deviations from a wall, from which on a beam hit something that the map does not show
FEWEST = 10  # beams nearer than that, fewer tell nothing
MEMORY = 50  # scans
SETTLED = 10  # scans after which the estimate is worth something


class Noise:
    """The standard deviation of the distances between ends of beams and walls, by the scans that fit.

    Attributes:
        sigma: the estimate [m].
    """

    def __init__(self, sigma: float = 0.0) -> None:
        """Be told the standard deviation [m]; 0 to estimate it."""
        self.sigma = sigma or FIRST
        self._is_told = sigma > 0.0
        self._scans = 0

    @property
    def kernel(self) -> float:
        """Sigma of the narrowest step of a match [m]."""
        return KERNEL * self.sigma

    @property
    def steps(self) -> Array:
        """Sigmas of the steps of a match, falling: float64 (6) [m]."""
        return self.kernel * COARSE

    @property
    def is_settled(self) -> bool:
        """Whether enough scans were seen."""
        return self._is_told or self._scans >= SETTLED

    def follow(self, pose: Array, points: Array, distance: Array, left: float, bottom: float,
               resolution: float) -> None:
        """Learn from a scan that fits: the median tells little of the beams that hit what the map does not show.

        Args:
            pose: float64 (3), where it fits.
            points: float64 (beams, 2), where beams end, in the frame of the robot [m].
            distance, left, bottom, resolution: of the map, as for `compiled_matching`.
        """
        if self._is_told:
            return
        away = np.abs(compiled_matching.distances(pose, points, distance, left, bottom, resolution))
        away = away[away < FAR * self.sigma]  # a beam that ends off the map has NaN
        if len(away) < FEWEST:
            return
        self._scans += 1
        self.sigma += (NORMAL * float(np.median(away)) - self.sigma) / min(self._scans, MEMORY)
        self.sigma = min(max(self.sigma, LEAST), MOST)
