"""How far beams go until they meet a wall."""

import math

import numpy as np

from rumba_sim.model.kernel import Array, Record

IN_WALL = 255  # instead of what a beam may skip: there is a wall
NUDGE = 1e-7  # [cells] that carries a beam across a border; a beam with less drift per cell is parallel to the border


def cast(k: Record, skips: Array, x: float, y: float, along_x: float, along_y: float, limit: float) -> float:
    """Distance from (x, y) along a unit vector to the first wall, at most `limit`."""
    u, v, far = (x - k.origin_x) / k.resolution, (y - k.origin_y) / k.resolution, limit / k.resolution
    distance = 0.0
    while distance < far:
        after = beam_step(skips, u, v, along_x, along_y, distance)
        if after == distance:
            return distance * k.resolution
        distance = after
    return limit


def cast_all(k: Record, skips: Array, x: float, y: float, along: Array, ranges: Array) -> None:
    """The same along many unit vectors, at most `range_max`: `ranges`, float64 (beams), receives the distances.

    The beams take their steps in turn. What one reads of the map does not depend on the others, so that the processor
    waits for many cells at once: this takes half as long as beam after beam.
    """
    u, v, far = (x - k.origin_x) / k.resolution, (y - k.origin_y) / k.resolution, k.range_max / k.resolution
    ranges[:] = 0.0
    under_way = np.arange(len(ranges))
    left = len(ranges)
    while left > 0:
        going, left = left, 0
        for place in range(going):
            beam = under_way[place]
            distance = beam_step(skips, u, v, along[beam, 0], along[beam, 1], ranges[beam])
            if ranges[beam] < distance < far:
                under_way[left] = beam
                left += 1
            ranges[beam] = distance
    for beam in range(len(ranges)):
        ranges[beam] = min(ranges[beam] * k.resolution, k.range_max)


def beam_step(skips: Array, u: float, v: float, along_x: float, along_y: float, distance: float) -> float:
    """How far a beam has come after another step, in cells; as far as before if it meets a wall or leaves the map.

    Far from walls it skips whole cells; near walls it goes from border to border of the cells, so that it meets the
    wall exactly.
    """
    column, row = u + distance * along_x, v + distance * along_y
    if not (0.0 <= column < skips.shape[1] and 0.0 <= row < skips.shape[0]):
        return distance
    skip = int(skips[int(row), int(column)])
    if skip == IN_WALL:
        return distance
    if skip > 0:
        return distance + skip
    return distance + min(to_border(column, along_x), to_border(row, along_y)) + NUDGE


def to_border(position: float, along: float) -> float:
    """Distance [cells] until one coordinate [cells], which grows by `along` per cell, reaches the border of its cell.

    It is infinite for a beam that is parallel to the border except for rounding: NUDGE would not carry it across.
    """
    if along > NUDGE:
        return (math.floor(position) + 1.0 - position) / along
    if along < -NUDGE:
        return (math.floor(position) - position) / along
    return math.inf
