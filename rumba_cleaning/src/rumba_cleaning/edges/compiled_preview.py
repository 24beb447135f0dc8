"""Simulates what a command leads to, compiled by numba."""

import math
from typing import Any, Tuple

import numpy as np

from rumba_sim.model.compiling.jit import compiled

STEP = 0.02  # [s] of the simulation: one tick at 50 Hz
HOLD_STEPS = 5  # for which a command holds: the control period
ROUNDING = 1e-6  # [m/s]

Array = Any  # numpy.ndarray
Wheels = Tuple[float, float]  # left and right


@compiled
def path(pose: Tuple[float, float, float], speeds: Wheels, wanted: Wheels, slip: Tuple[float, float], half: float,
         acceleration: float, hold: int) -> Array:
    """Where a robot and its wheels are, from now until it has stopped after a command.

    Args:
        pose: x, y [m], theta [rad] now.
        speeds: of the wheels now [m/s].
        wanted: speeds that are commanded [m/s].
        slip: how fast it slides to its left at its fastest [m/s], and the share of the way of its wheels that it makes.
        half: distance of the wheels from its middle [m].
        acceleration: of the wheels [m/s^2].
        hold: for how many steps the command holds.

    Returns:
        float64 (3, any, 2): x and y [m] of the middle, the left and the right wheel, at each step
    """
    change = acceleration * STEP
    held = 0.0
    for side in range(2):
        goal = max(min(wanted[side], speeds[side] + hold * change), speeds[side] - hold * change)
        held = max(held, abs(goal))
    steps = hold + math.ceil(held / change) + 1
    fastest = max(abs(speeds[0]), abs(speeds[1]), abs(wanted[0]), abs(wanted[1]), ROUNDING)
    points = np.empty((3, steps + 1, 2))
    (x, y, theta), (left, right) = pose, speeds
    for step in range(steps + 1):
        cos, sin = math.cos(theta), math.sin(theta)
        points[0, step] = x, y
        points[1, step] = x - half * sin, y + half * cos
        points[2, step] = x + half * sin, y - half * cos
        goals = wanted if step < hold else (0.0, 0.0)
        left = min(max(goals[0], left - change), left + change)
        right = min(max(goals[1], right - change), right + change)
        turn, driven = (right - left) / (2.0 * half) * STEP, 0.5 * (left + right) * STEP * slip[1]
        slid = slip[0] * STEP * max(abs(left), abs(right)) / fastest
        along = theta + 0.5 * turn
        x += driven * math.cos(along) - slid * math.sin(along)
        y += driven * math.sin(along) + slid * math.cos(along)
        theta += turn
    return points
