"""Which samples the brush can reach."""

import math

import numpy as np

from rumba_sim.model.kernel import Array
from rumba_sim.model.kernel.geometry import interpolated
from rumba_sim.model.kernel.motion import PUSH
from rumba_sim.model.kernel.sweeping.samples import REACHABLE, SWEEPABLE, sample_point


def mark_reachable(field: Array, resolution: float, spare: Array, reach: float, half: float, samples: Array) -> int:
    """Set the bit REACHABLE of all samples that the brush can reach; returns how many these are.

    Args, apart from those of the package:
        resolution: side of a cell [m].
        spare: float64 (2 * rows + 1, 2 * columns + 1), clearance beyond what a robot needs [m], where it can stand
            and drive to; negative elsewhere: at the corners of the cells, in the middle of their sides, and at their
            centres.
        reach: clearance that a robot needs [m].
        half: half the width of the brush [m].
    """
    squares, count = samples.shape[0] // (field.shape[0] - 1), 0
    size = int(math.ceil(2.0 * half / resolution)) + 2  # positions of `spare` as far as the brush reaches
    tiles = occupied_tiles(spare, size)
    for row in range(samples.shape[0]):
        for column in range(samples.shape[1]):
            if samples[row, column] & SWEEPABLE:
                across, up = sample_point(row, column)
                if is_reachable(field, resolution, spare, tiles, size, reach, half, across / squares, up / squares):
                    samples[row, column] |= REACHABLE
                    count += 1
    return count


def occupied_tiles(spare: Array, size: int) -> Array:
    """Whether a robot can stand at any position in each square of so many rows and columns of `spare`: bool (n, m)."""
    tiles = np.zeros((spare.shape[0] // size + 1, spare.shape[1] // size + 1), np.bool_)
    for row in range(spare.shape[0]):
        for column in range(spare.shape[1]):
            if spare[row, column] >= 0.0:
                tiles[row // size, column // size] = True
    return tiles


def is_reachable(field: Array, resolution: float, spare: Array, tiles: Array, size: int, reach: float, half: float,
                 u: float, v: float) -> bool:
    """Whether the point (u, v) [cells] lies within `half` of a position at which a robot can stand.

    The nearest such position is usually up the slope of the clearance. If that leads nowhere, all positions nearby are
    tried: around each of them a robot can stand as far as its clearance is larger than it needs.
    """
    gap, along_u, along_v = interpolated(field, u, v)
    if reach - gap > half:
        return False
    slope = math.hypot(along_u, along_v)
    away = max(reach - gap, 0.0) / resolution / slope if slope > 0.0 else 0.0
    to_u, to_v = u + away * along_u, v + away * along_v
    if interpolated(field, to_u, to_v)[0] >= reach - PUSH and stands_beside(spare, to_u, to_v):
        return True
    row, column = int(round(2.0 * v)), int(round(2.0 * u))
    top, left = max(row // size - 1, 0), max(column // size - 1, 0)
    if not tiles[top:row // size + 2, left:column // size + 2].any():
        return False  # in a closed room, whose positions would all be tried for each sample
    for i in range(max(row - size, 0), min(row + size + 1, spare.shape[0])):
        for j in range(max(column - size, 0), min(column + size + 1, spare.shape[1])):
            if spare[i, j] >= 0.0 and math.hypot(0.5 * j - u, 0.5 * i - v) * resolution - spare[i, j] <= half:
                return True
    return False


def stands_beside(spare: Array, u: float, v: float) -> bool:
    """Whether a robot can stand at one of the four positions of `spare` around the point (u, v) [cells]."""
    i, j = int(2.0 * v), int(2.0 * u)
    if not (0 <= i < spare.shape[0] - 1 and 0 <= j < spare.shape[1] - 1):
        return False
    return bool(max(spare[i, j], spare[i, j + 1], spare[i + 1, j], spare[i + 1, j + 1]) >= 0.0)
