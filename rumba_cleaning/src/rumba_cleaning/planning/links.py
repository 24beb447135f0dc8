"""From the end of one lane to the beginning of the next."""

import math
from typing import List

import numpy as np

from rumba_cleaning.belief.ground import Ground
from rumba_sim.model.kernel import Array

BENDS = (0.05, 0.4)  # [m] least and largest distance of two lanes that a half circle joins
OFFSET = 0.35  # [m] by which their ends may lie apart along the lanes
CORNERS = 9  # of a half circle, its ends included
NOWHERE = np.zeros((0, 2))


def cell_manners(ground: Ground, lanes: List[Array]) -> List[Array]:
    """The four ways through the lanes of a cell: from its first or its last lane, from either end of that."""
    return [_through(ground, order, first) for order in (lanes, lanes[::-1]) for first in (0, 1)]


def _through(ground: Ground, lanes: List[Array], first: int) -> Array:
    """The way through lanes, to and fro; the first is driven from its end `first`, 0 or 1."""
    parts: List[Array] = []
    for index, lane in enumerate(lanes):
        lane = lane if index % 2 == first else lane[::-1]
        if parts:
            parts.append(_link(ground, parts[-1], lane))
        parts.append(lane)
    return np.concatenate(parts)


def _link(ground: Ground, lane: Array, following: Array) -> Array:
    """Places between two lanes."""
    bend = _half_circle(lane, following)
    end, start = lane[-1], following[0]
    if len(bend) and ground.are_free(bend).all() and ground.is_straight(end, bend[0]) and (
            ground.is_straight(bend[-1], start)):
        return bend
    way = ground.way(end, start)
    return NOWHERE if way is None else way[1:-1]


def _half_circle(lane: Array, following: Array) -> Array:
    """A half circle beyond the ends of both lanes: float64 (CORNERS, 2), or (0, 2) where they are not side by side."""
    ahead = (lane[-1] - lane[0]) / np.hypot(*(lane[-1] - lane[0]))
    step = following[0] - lane[-1]
    along = float(step @ ahead)
    across = step - along * ahead
    if not (BENDS[0] < np.hypot(*across) < BENDS[1] and abs(along) < OFFSET):
        return NOWHERE
    start = lane[-1] + max(along, 0.0) * ahead
    angles = np.linspace(0.0, math.pi, CORNERS)[:, np.newaxis]
    half = 0.5 * across
    return np.asarray(start + half - np.cos(angles) * half + np.sin(angles) * np.hypot(*half) * ahead)
