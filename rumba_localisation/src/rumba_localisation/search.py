"""Where on a whole map a scan fits: hypotheses for a robot that does not know where it is."""

import math
from typing import Tuple

import numpy as np

from rumba_localisation import compiled_matching
from rumba_localisation.scan import thinned
from rumba_localisation.walls import Walls
from rumba_sim.model.floor_plan import FloorPlan
from rumba_sim.model.kernel import Array

SPACING = 0.15  # [m] between the positions that are tried
HEADINGS = 60
BEAMS = 40
SIGMA = 0.15  # [m] for the end of a beam, at a position that is tried: it is up to 0.11 m off
MOST = 300_000  # poses that are tried at once: others at the next scan
WRONG = 3.0  # beams that end at a wall are outweighed by one that would have to pass through a wall
BEST = 100  # poses that are kept, and moved to where the scan fits best
APART = np.array([1.0, 1.0, 0.3]) ** 2  # variances of a pose that is kept: it may be moved far
STEPS = np.geomspace(0.3, 0.05, 12)  # [m] sigmas of `match`


class Search:
    """Tries positions all over a map, and keeps those where a scan fits."""

    def __init__(self, plan: FloorPlan, walls: Walls, radius: float, range_max: float) -> None:
        """Look where a robot of a radius [m] can stand, with a laser that sees so far [m]."""
        self._walls = walls
        self._field = walls.log_likelihood(SIGMA, 0.9, 0.1, range_max)
        terrain = plan.refined()
        step = max(round(SPACING / terrain.resolution), 1)
        nodes = np.argwhere(terrain.safe_clearance[::step, ::step] >= radius)[:, ::-1] * (step * terrain.resolution)
        self._positions = nodes + np.array(terrain.origin)

    def hypotheses(self, points: Array, generator: np.random.Generator) -> Tuple[Array, Array]:
        """Poses at which a scan fits.

        Args:
            points: float64 (beams, 2), where beams end in the frame of the laser [m].

        Returns:
            Poses, float64 (BEST at most, 3), and how large a share of the beams ends at a wall there, less
            WRONG times the share that would have to pass through walls.
        """
        few = thinned(points, BEAMS)
        tried = self._tried(generator)
        sums = np.empty(len(tried))
        compiled_matching.weigh(tried, few, self._field, *self._walls.origin, self._walls.resolution, sums)
        best = tried[np.argsort(-sums, kind='stable')[:BEST]]
        poses, fits = self._matched(best, points)
        return poses, fits - WRONG * np.array([self._walls.through(pose, few) for pose in poses])

    def _tried(self, generator: np.random.Generator) -> Array:
        headings = np.arange(HEADINGS) * (2.0 * math.pi / HEADINGS)
        positions = self._positions
        if len(positions) * HEADINGS > MOST:
            positions = positions[generator.permutation(len(positions))[:MOST // HEADINGS]]
        return np.concatenate([np.repeat(positions, HEADINGS, axis=0), np.tile(headings, len(positions))[:, None]],
                              axis=1)

    def _matched(self, poses: Array, points: Array) -> Tuple[Array, Array]:
        found, fits = np.empty_like(poses), np.empty(len(poses))
        wide, covariance = np.diag(APART), np.empty((3, 3))
        for index, pose in enumerate(poses):
            fits[index] = compiled_matching.match(pose, wide, points, self._walls.distance, *self._walls.origin,
                                                  self._walls.resolution, STEPS, 1.0, found[index], covariance)
        return found, fits
