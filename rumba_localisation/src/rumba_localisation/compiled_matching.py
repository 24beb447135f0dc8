"""Compares scans with the walls of a map: plain functions over arrays, compiled by numba.

Arguments that functions share:
    points: float64 (beams, 2), where beams end, in the frame of the robot [m].
    laser: x and y of where they begin, in that frame [m].
    kernels: float64 (beams), standard deviation of the distance from the end of each to a wall, at least [m].
    field: float32 (rows + 2, columns + 2), `Walls.log_likelihood`.
    distance: float32 (rows + 1, columns + 1), `Walls.distance`.
    left, bottom, resolution: of the map [m].
"""

import math
from typing import Any, Tuple

import numpy as np

from rumba_localisation.compiled_matrices import inverse, product
from rumba_sim.model.compiling.jit import compiled

FARTHEST = 0.5  # [m], [rad] in one step of `match`: beyond, its lines say nothing of the walls
BEFORE = 0.15  # [m] of a beam before its end that may be in a wall: by so much a pose that is not wrong may err
STRIDE = 0.02  # [m] from point to point on a beam: no more than the thinnest wall
INSIDE = 0.015  # [m] from its faces a point is in a wall: half of a thin one, so that beams may graze corners
STEEP = 1.2  # slope from which on distances jump: true ones have slopes of 1, interpolated ones up to 1.1; any up to 2
#              lets maps drift as little
Array = Any  # numpy.ndarray
Triple = Tuple[float, float, float]


@compiled
def weigh(poses: Array, points: Array, field: Array, left: float, bottom: float, resolution: float,
          sums: Array) -> None:
    """Sum up how likely the beams of a scan are at each pose.

    Args, apart from those above:
        poses: float64 (any, 3), x, y [m] and heading [rad] of the robot.
        sums: float64 (any), receives the sums of the field.
    """
    rows, columns = field.shape
    for index in range(len(poses)):
        cos, sin = math.cos(poses[index, 2]) / resolution, math.sin(poses[index, 2]) / resolution
        u, v = (poses[index, 0] - left) / resolution + 1.0, (poses[index, 1] - bottom) / resolution + 1.0
        total = 0.0
        for beam in range(len(points)):
            x, y = points[beam, 0], points[beam, 1]
            column, row = int(u + cos * x - sin * y), int(v + sin * x + cos * y)
            total += field[min(max(row, 0), rows - 1), min(max(column, 0), columns - 1)]
        sums[index] = total


@compiled
def slope_at(distance: Array, u: float, v: float) -> Triple:
    """Bilinear interpolation at (u, v) [cells]: the distance, and its slopes along u and v; NaN outside the map."""
    if not (0.0 <= u < distance.shape[1] - 1 and 0.0 <= v < distance.shape[0] - 1):
        return math.nan, 0.0, 0.0
    column, row = int(u), int(v)
    u, v = u - column, v - row
    a, b = distance[row, column], distance[row, column + 1]
    c, d = distance[row + 1, column], distance[row + 1, column + 1]
    lower, upper = a + u * (b - a), c + u * (d - c)
    return lower + v * (upper - lower), (b - a) + v * ((d - c) - (b - a)), upper - lower


@compiled
def normal_equations(pose: Array, points: Array, kernels: Array, distance: Array, left: float, bottom: float,
                     resolution: float, least: float, matrix: Array, vector: Array) -> float:
    """Linearise the distances from the ends of beams to the walls around a pose.

    A beam that ends far from any wall, in units of sigma, counts little (Welsch's weight): it hit something that the
    map does not show. Where distances are steeper than distances can be, they change their sign beside the last hit on
    a wall: scaled to a slope of 1 they still tell where the wall is. Unscaled, a few such beams would hold the heading
    where the odometry has it, so that a map of scattered hits bends the way that the wheels err.

    Args, apart from those above:
        pose: float64 (3).
        least: standard deviation of a distance, at least [m].
        matrix, vector: float64 (3, 3) and (3), receive the information and the gradient of half the sum of squares.

    Returns:
        The share of the beams that count, weighted [0..1].
    """
    cos, sin = math.cos(pose[2]), math.sin(pose[2])
    matrix[:], vector[:] = 0.0, 0.0
    count = 0.0
    for beam in range(len(points)):
        along, across = cos * points[beam, 0] - sin * points[beam, 1], sin * points[beam, 0] + cos * points[beam, 1]
        off, by_u, by_v = slope_at(distance, (pose[0] + along - left) / resolution,
                                   (pose[1] + across - bottom) / resolution)
        if math.isnan(off):
            continue
        by_x, by_y = by_u / resolution, by_v / resolution
        steep = math.hypot(by_x, by_y)
        if steep > STEEP:
            off, by_x, by_y = off / steep, by_x / steep, by_y / steep
        by_theta = by_y * along - by_x * across
        sigma = max(least, kernels[beam])
        share = math.exp(-0.5 * (off / sigma) ** 2)
        weight = share / sigma ** 2
        count += share
        matrix[0, 0] += weight * by_x * by_x
        matrix[0, 1] += weight * by_x * by_y
        matrix[0, 2] += weight * by_x * by_theta
        matrix[1, 1] += weight * by_y * by_y
        matrix[1, 2] += weight * by_y * by_theta
        matrix[2, 2] += weight * by_theta * by_theta
        vector[0] += weight * by_x * off
        vector[1] += weight * by_y * off
        vector[2] += weight * by_theta * off
    matrix[1, 0], matrix[2, 0], matrix[2, 1] = matrix[0, 1], matrix[0, 2], matrix[1, 2]
    return count / len(points)


@compiled
def match(start: Array, covariance: Array, points: Array, kernels: Array, distance: Array, left: float,
          bottom: float, resolution: float, sigmas: Array, share: float, pose: Array, result: Array) -> float:
    """Move a pose so that the beams of a scan end at walls (Gauss-Newton on the distances), held by where it began.

    Args, apart from those above:
        start: float64 (3), where the robot is supposed to be.
        covariance: float64 (3, 3), of that.
        sigmas: float64 (steps), standard deviation for each step, at least, falling: it finds what is far off too.
        share: of the beams that err independently [0..1]; for the covariance of the result alone.
        pose: float64 (3), receives the result.
        result: float64 (3, 3), receives its covariance.

    Returns:
        The share of the beams that end at a wall there, weighted [0..1].
    """
    prior = inverse(covariance)
    information, vector = np.zeros((3, 3)), np.zeros(3)
    pose[:] = start
    for step in range(len(sigmas)):
        normal_equations(pose, points, kernels, distance, left, bottom, resolution, sigmas[step], information, vector)
        change = product(inverse(information + prior), vector + product(prior, pose - start))
        pose -= np.minimum(np.maximum(change, -FARTHEST), FARTHEST)
    fit = normal_equations(pose, points, kernels, distance, left, bottom, resolution, sigmas[-1], information, vector)
    result[:] = inverse(share * information + prior)
    return fit


@compiled
def look_around(pose: Array, points: Array, distance: Array, left: float, bottom: float, resolution: float,
                offsets: Array, turns: Array, width: float, scores: Array) -> None:
    """Score how well a scan fits at poses around one (correlative scan matching, Olson 2009).

    Args, apart from those above:
        pose: float64 (3).
        offsets: float64 (any, 2), from its place to those that are tried [m].
        turns: float64 (any), from its heading to those that are tried [rad].
        width: distance from a wall at which the end of a beam counts nothing [m]; at the wall it counts 1.
        scores: float64 (turns, offsets), receives the mean of what the beams count.
    """
    rows, columns = distance.shape
    for turn in range(len(turns)):
        cos, sin = math.cos(pose[2] + turns[turn]), math.sin(pose[2] + turns[turn])
        for offset in range(len(offsets)):
            u = (pose[0] + offsets[offset, 0] - left) / resolution + 0.5
            v = (pose[1] + offsets[offset, 1] - bottom) / resolution + 0.5
            total = 0.0
            for beam in range(len(points)):
                x, y = points[beam, 0] / resolution, points[beam, 1] / resolution
                column, row = int(u + cos * x - sin * y), int(v + sin * x + cos * y)
                if 0 <= row < rows and 0 <= column < columns:
                    total += max(1.0 - abs(distance[row, column]) / width, 0.0)
            scores[turn, offset] = total / len(points)


@compiled
def distances(pose: Array, points: Array, distance: Array, left: float, bottom: float, resolution: float) -> Array:
    """Distances from the ends of beams to walls at a pose (3): float64 (beams) [m]; NaN outside the map."""
    cos, sin = math.cos(pose[2]), math.sin(pose[2])
    found = np.empty(len(points))
    for beam in range(len(points)):
        along, across = cos * points[beam, 0] - sin * points[beam, 1], sin * points[beam, 0] + cos * points[beam, 1]
        found[beam] = slope_at(distance, (pose[0] + along - left) / resolution,
                               (pose[1] + across - bottom) / resolution)[0]
    return found


@compiled
def through_walls(pose: Array, points: Array, laser: Tuple[float, float], distance: Array, left: float, bottom: float,
                  resolution: float) -> float:
    """The share of the beams of a scan that would have to pass through a wall at a pose [0..1].

    What the map does not show shortens beams, but lengthens none: at the true pose there are hardly any such beams.

    Args, apart from those above:
        pose: float64 (3).
    """
    rows, columns = distance.shape
    cos, sin = math.cos(pose[2]), math.sin(pose[2])
    u = (pose[0] + cos * laser[0] - sin * laser[1] - left) / resolution + 0.5
    v = (pose[1] + sin * laser[0] + cos * laser[1] - bottom) / resolution + 0.5
    count = 0
    for beam in range(len(points)):
        x, y = points[beam, 0] - laser[0], points[beam, 1] - laser[1]
        along, across = cos * x - sin * y, sin * x + cos * y
        length = math.hypot(along, across)
        for step in range(1, int((length - BEFORE) / STRIDE)):
            share = step * STRIDE / length / resolution
            column, row = int(u + share * along), int(v + share * across)
            if not (0 <= row < rows and 0 <= column < columns) or distance[row, column] < -INSIDE:
                count += 1
                break
    return count / len(points)


@compiled
def from_behind(pose: Array, points: Array, laser: Tuple[float, float], distance: Array, left: float, bottom: float,
                resolution: float, sigma: float) -> float:
    """The share of the beams of a scan that end at a wall that faces away from the laser, weighted [0..1].

    Distances are negative behind a wall that was seen from one side alone. Beams that end there were met by the other
    side, which is elsewhere: the scan does not belong there, even if it fits.

    Args, apart from those above:
        pose: float64 (3).
        sigma: standard deviation of a distance [m].
    """
    cos, sin = math.cos(pose[2]), math.sin(pose[2])
    total = 0.0
    for beam in range(len(points)):
        along, across = cos * points[beam, 0] - sin * points[beam, 1], sin * points[beam, 0] + cos * points[beam, 1]
        off, by_u, by_v = slope_at(distance, (pose[0] + along - left) / resolution,
                                   (pose[1] + across - bottom) / resolution)
        along, across = along - cos * laser[0] + sin * laser[1], across - sin * laser[0] - cos * laser[1]
        if by_u * along + by_v * across > 0.0:
            total += math.exp(-0.5 * (off / sigma) ** 2)
    return total / len(points)
