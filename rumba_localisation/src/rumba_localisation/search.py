"""Where on a whole map a scan fits: hypotheses for a robot that does not know where it is."""

import math
from typing import Tuple

import numpy as np

from rumba_localisation import compiled_matching
from rumba_localisation.scan import Scan, thinned
from rumba_localisation.walls import Walls
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.kernel import Array
from rumba_sim.model.maps.floor_plan import FloorPlan

SPACING = 0.15  # [m] between the positions that are tried
HEADINGS = 60
BEAMS = 40
SIGMA = 0.15  # [m] for the end of a beam, at a position that is tried: it is up to 0.11 m off
MOST = 300_000  # poses that are tried at once: others at the next scan
WRONG = 3.0  # beams that end at a wall are outweighed by one that would have to pass through a wall
BEST = 100  # poses that are kept, and moved to where the scan fits best
NEAR, NEAR_SPACING = 0.6, 0.1  # [m] around a place: twice as far as a robot slides in a second as it cleans
BEST_NEAR = 30  # positions that are kept there, each with one heading
APART = np.array([1.0, 1.0, 0.3]) ** 2  # variances of a pose that is kept: it may be moved far
STEPS = np.geomspace(0.3, 0.05, 12)  # [m] sigmas of `match`


def _disc(radius: float, spacing: float) -> Array:
    """Points in a disc around (0, 0), `spacing` apart: float64 (any, 2)."""
    along = np.arange(-round(radius / spacing), round(radius / spacing) + 1) * spacing
    points = np.stack(np.meshgrid(along, along), axis=-1).reshape(-1, 2)
    return np.asarray(points[np.hypot(points[:, 0], points[:, 1]) <= radius + 1e-9])


AROUND = _disc(NEAR, NEAR_SPACING)  # (any, 2) [m] offsets that are tried near a place


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

    def hypotheses(self, scan: Scan, generator: np.random.Generator) -> Tuple[Array, Array]:
        """Poses at which a scan fits.

        Args:
            scan: with echoes.

        Returns:
            Poses, float64 (BEST at most, 3), and how large a share of the beams ends at a wall there, less
            WRONG times the share that would have to pass through walls.
        """
        positions = self._positions
        if len(positions) * HEADINGS > MOST:
            positions = positions[generator.permutation(len(positions))[:MOST // HEADINGS]]
        few = thinned(scan.points, BEAMS)
        tried, sums = self._tried(positions, few)
        poses, fits = self._matched(tried[np.argsort(-sums, kind='stable')[:BEST]], scan.points)
        return poses, fits - WRONG * np.array([self._walls.through(pose, few, scan.laser) for pose in poses])

    def near(self, place: Pose, points: Array) -> Array:
        """Poses at which a scan about fits within NEAR of a place, with any heading; they are not matched yet.

        Args:
            place: [m, rad], map frame.
            points: float64 (beams, 2), where beams end, in the frame of the robot [m].

        Returns:
            float64 (BEST_NEAR at most, 3).
        """
        tried, sums = self._tried(AROUND + place[:2], thinned(points, BEAMS))
        headings = np.argmax(sums.reshape(-1, HEADINGS), axis=1)
        best = np.arange(len(AROUND)) * HEADINGS + headings
        return np.asarray(tried[best[np.argsort(-sums[best], kind='stable')[:BEST_NEAR]]])

    def _tried(self, positions: Array, points: Array) -> Tuple[Array, Array]:
        """All headings at each of some positions (any, 2), and the sums of the logarithms of how well a scan fits."""
        headings = np.arange(HEADINGS) * (2.0 * math.pi / HEADINGS)
        tried = np.concatenate([np.repeat(positions, HEADINGS, axis=0), np.tile(headings, len(positions))[:, None]],
                               axis=1)
        sums = np.empty(len(tried))
        compiled_matching.weigh(tried, points, self._field, *self._walls.origin, self._walls.resolution, sums)
        return tried, sums

    def _matched(self, poses: Array, points: Array) -> Tuple[Array, Array]:
        found, fits = np.empty_like(poses), np.empty(len(poses))
        wide, covariance, kernels = np.diag(APART), np.empty((3, 3)), np.zeros(len(points))
        for index, pose in enumerate(poses):
            fits[index] = compiled_matching.match(pose, wide, points, kernels, self._walls.distance,
                                                  *self._walls.origin, self._walls.resolution, STEPS, 1.0,
                                                  found[index], covariance)
        return found, fits
