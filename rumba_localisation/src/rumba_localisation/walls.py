"""The walls of a map, as a laser sees them: how far any point is from the nearest one, and how likely an echo there."""

import math
from typing import Tuple

import numpy as np
from scipy import ndimage

from rumba_localisation import compiled_matching
from rumba_sim.model.kernel import Array
from rumba_sim.model.maps.floor_plan import FloorPlan

FARTHEST = 2.0  # [m] beyond that all distances count alike


class Walls:
    """The borders between free cells and all others.

    Attributes:
        origin: x and y of the lower left corner of the map [m].
        resolution: side of a cell [m].
        distance: float32 (rows + 1, columns + 1), distance from each node to the nearest wall [m], negative inside
            walls. It is smooth across the border, so that the nearest point of the border is found by its slope.
    """

    def __init__(self, plan: FloorPlan) -> None:
        """Measure the distances on a refined floor plan."""
        terrain = plan.refined()
        self.origin: Tuple[float, float] = terrain.origin
        self.resolution = terrain.resolution
        inside = terrain.resolution * _depth(~terrain.free)
        self.distance = np.clip(terrain.clearance - inside, -FARTHEST, FARTHEST).astype(np.float32)

    def through(self, pose: Array, points: Array, laser: Tuple[float, float]) -> float:
        """The share of beams that would have to pass through walls at a pose (3) [0..1].

        Args:
            pose: of the robot [m, m, rad].
            points: float64 (beams, 2), where they end, in its frame [m].
            laser: where they begin, in that frame [m].
        """
        return compiled_matching.through_walls(pose, points, laser, self.distance, *self.origin, self.resolution)

    def log_likelihood(self, sigma: float, hit: float, rand: float, range_max: float) -> Array:
        """Likelihood field: the logarithm of how likely a beam ends in each cell, 0 at a wall.

        Probabilistic Robotics (Thrun, Burgard, Fox 2005), table 6.3: a Gaussian of the distance to the nearest wall,
        and a floor for beams that end anywhere.

        Args:
            sigma: standard deviation of the distance [m].
            hit: share of beams that end at a wall.
            rand: share of beams that end anywhere, with the same density everywhere up to range_max [m].

        Returns:
            float32 (rows + 2, columns + 2); the cells at the rim stand for everything outside the map.
        """
        nodes = np.abs(self.distance).astype(np.float64)
        nearest = 0.25 * (nodes[:-1, :-1] + nodes[:-1, 1:] + nodes[1:, :-1] + nodes[1:, 1:])
        anywhere = rand / range_max * sigma * math.sqrt(2.0 * math.pi)  # in units of the Gaussian's peak
        field = np.log((hit * np.exp(-0.5 * (nearest / sigma) ** 2) + anywhere) / (hit + anywhere))
        return np.pad(field, 1, mode='constant', constant_values=math.log(anywhere / (hit + anywhere))).astype(
            np.float32)


def _depth(blocked: Array) -> Array:
    """Distance [cells] of each node to the nearest free cell; outside the map everything is blocked."""
    padded = np.pad(blocked, 1, mode='constant', constant_values=True)
    inside = padded[:-1, :-1] & padded[:-1, 1:] & padded[1:, :-1] & padded[1:, 1:]
    return ndimage.distance_transform_edt(inside)
