"""Angles, arcs, and values between the corners of the cells, such as the clearance."""

import math

import numpy as np

from rumba_sim.model.kernel import Array, Record, Triple


def wrap(angle: float) -> float:
    """The same direction in (-pi, pi]."""
    return angle if -math.pi < angle <= math.pi else math.pi - (math.pi - angle) % (2.0 * math.pi)


def arc(x: float, y: float, theta: float, distance: float, turn: float) -> Triple:
    """The pose after an exact arc of length `distance` that changes the heading by `turn`."""
    half = 0.5 * turn
    chord = distance * (math.sin(half) / half) if abs(half) > 1e-6 else distance
    return x + chord * math.cos(theta + half), y + chord * math.sin(theta + half), wrap(theta + turn)


def interpolated(field: Array, u: float, v: float) -> Triple:
    """Bilinear interpolation between the corners of a cell: the value at (u, v) [cells], and its slopes along u and v.

    All are 0 outside the grid and if a coordinate is NaN.
    """
    if not (0.0 <= u < field.shape[1] - 1 and 0.0 <= v < field.shape[0] - 1):
        return 0.0, 0.0, 0.0
    column, row = int(u), int(v)
    u, v = u - column, v - row
    lower = field[row, column + 1] - field[row, column]
    upper = field[row + 1, column + 1] - field[row + 1, column]
    left = field[row + 1, column] - field[row, column]
    along_u = lower + v * (upper - lower)
    return field[row, column] + u * along_u + v * left, along_u, left + u * (upper - lower)


def interpolated_at(field: Array, left: float, bottom: float, resolution: float, points: Array) -> Array:
    """The values of `interpolated` at points [m], map frame.

    Args:
        field: float64 (rows + 1, columns + 1).
        left, bottom: of the grid [m], map frame.
        resolution: of the grid [m].
        points: float64 (any, 2) [m].

    Returns:
        float64 (any)
    """
    values = np.empty(len(points))
    for index in range(len(points)):
        values[index] = interpolated(field, (points[index, 0] - left) / resolution,
                                     (points[index, 1] - bottom) / resolution)[0]
    return values


def clearance(k: Record, field: Array, x: float, y: float) -> Triple:
    """Distance to the nearest wall, and its gradient along x and y."""
    gap, along_u, along_v = interpolated(field, (x - k.origin_x) / k.resolution, (y - k.origin_y) / k.resolution)
    return gap, along_u / k.resolution, along_v / k.resolution
