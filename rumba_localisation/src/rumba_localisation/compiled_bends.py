"""How much too long a laser tells all its ranges, by the bends of straight walls: plain functions, compiled by numba.

A wall that is straight lies at distance / cos(angle to its normal). Ranges that are all too long by the same bend it
away from the laser where it is near, ranges that are too short toward it.
"""

import math
from typing import Any, Tuple

import numpy as np

from rumba_localisation.compiled_matrices import inverse, product
from rumba_sim.model.compiling.jit import compiled

JUMP = 0.15  # [m] from one echo to the next on a wall, at most, beyond what a wall has that is nearly grazed
GRAZED = 5.0  # times the way across between beams, which lies on a wall between two echoes, at most
DEEP = 0.1  # [m] from the line between the ends of a wall, at most: more than noise and bends, less than most niches
FEWEST = 20  # echoes of a wall
RIM = 3  # echoes at each end of a wall that do not count: they may be of something else too
WIDE = 0.5  # [rad] that a wall spans, at least: less of it hardly bends
GRAZING = 0.15  # least cosine of the angle to the normal
STEPS = 5  # of Gauss-Newton
Array = Any  # numpy.ndarray


@compiled
def bends(ranges: Array, angles: Array, found: Array) -> int:
    """Find walls in a scan, and how much too long the ranges are by the bend of each.

    Args:
        ranges: float64 (echoes) [m], in the order of the beams.
        angles: float64 (echoes) [rad], ever larger or ever smaller.
        found: float64 (any, 2), receives for each wall how much too long its ranges are [m], and the variance of that.

    Returns:
        How many walls were found.
    """
    count, first, echoes = 0, 0, len(ranges)
    ends = np.empty(echoes, np.int64)  # of stretches that are still to be looked at, the next one last
    while first < echoes - 1:
        last = first
        while last < echoes - 1 and is_joined(ranges, angles, last):
            last += 1
        waiting = 1
        ends[0] = last
        while waiting > 0:
            end = ends[waiting - 1]
            corner = farthest(ranges, angles, first, end)
            if corner >= 0:
                ends[waiting] = corner
                waiting += 1
                continue
            if end - first + 1 >= FEWEST + 2 * RIM and count < len(found):
                offset, variance = bend(ranges, angles, first + RIM, end - RIM)
                if variance > 0.0:
                    found[count, 0], found[count, 1] = offset, variance
                    count += 1
            first = end
            waiting -= 1
        first = last + 1
    return count


@compiled
def is_joined(ranges: Array, angles: Array, one: int) -> bool:
    """Whether an echo and the next one may be of the same wall."""
    turn = abs(angles[one + 1] - angles[one])
    near = min(ranges[one], ranges[one + 1])
    apart = math.hypot(ranges[one + 1] * math.cos(turn) - ranges[one], ranges[one + 1] * math.sin(turn))
    return bool(turn < WIDE and apart <= JUMP + GRAZED * turn * near)


@compiled
def farthest(ranges: Array, angles: Array, first: int, last: int) -> int:
    """The echo of a stretch that is farthest from the line between its ends; -1 if none is farther than DEEP."""
    if last - first < FEWEST:
        return -1
    x, y = ranges[first] * math.cos(angles[first]), ranges[first] * math.sin(angles[first])
    along = ranges[last] * math.cos(angles[last]) - x
    across = ranges[last] * math.sin(angles[last]) - y
    length = max(math.hypot(along, across), 1e-9)
    most, found = DEEP, -1
    for index in range(first + 1, last):
        by_x, by_y = ranges[index] * math.cos(angles[index]) - x, ranges[index] * math.sin(angles[index]) - y
        away = abs(by_x * across - by_y * along) / length
        if away > most:
            most, found = away, index
    return found


@compiled
def bend(ranges: Array, angles: Array, first: int, last: int) -> Tuple[float, float]:
    """Fit a straight wall, and an error that all ranges share, to a stretch of echoes (Gauss-Newton).

    Returns:
        How much too long they are [m], and the variance of that; it is 0 if they tell nothing.
    """
    if abs(angles[last] - angles[first]) < WIDE:
        return 0.0, 0.0
    x, y = ranges[first] * math.cos(angles[first]), ranges[first] * math.sin(angles[first])
    normal = math.atan2(ranges[last] * math.cos(angles[last]) - x, y - ranges[last] * math.sin(angles[last]))
    distance = x * math.cos(normal) + y * math.sin(normal)
    if distance < 0.0:
        normal, distance = normal + math.pi, -distance
    offset, squares = 0.0, 0.0
    information, vector = np.zeros((3, 3)), np.zeros(3)
    for _ in range(STEPS):
        information[:], vector[:], squares = 0.0, 0.0, 0.0
        for index in range(first, last + 1):
            cos, sin = math.cos(angles[index] - normal), math.sin(angles[index] - normal)
            if cos < GRAZING:
                return 0.0, 0.0
            off = ranges[index] - distance / cos - offset
            by_distance, by_normal = 1.0 / cos, -distance * sin / cos ** 2
            squares += off * off
            information[0, 0] += by_distance * by_distance
            information[0, 1] += by_distance * by_normal
            information[0, 2] += by_distance
            information[1, 1] += by_normal * by_normal
            information[1, 2] += by_normal
            information[2, 2] += 1.0
            vector[0] += by_distance * off
            vector[1] += by_normal * off
            vector[2] += off
        information[1, 0], information[2, 0] = information[0, 1], information[0, 2]
        information[2, 1] = information[1, 2]
        covariance = inverse(information)
        change = product(covariance, vector)
        distance, normal, offset = distance + change[0], normal + change[1], offset + change[2]
    return offset, covariance[2, 2] * squares / (last - first - 2)
