"""What the laser measures: the distances of walls, other robots and obstacles."""

import math
from typing import Tuple

import numpy as np

from rumba_sim.model.kernel import Array, Record
from rumba_sim.model.kernel.beams import NUDGE, cast_all
from rumba_sim.model.kernel.geometry import wrap
from rumba_sim.model.kernel.obstacles import is_near, outside


def scan(robots: Array, me: int, constants: Array, obstacles: Array, skips: Array, fan: Array, noise: Array,
         ranges: Array) -> None:
    """Measure with the laser of the robot with index `me`.

    Args, apart from those of the package:
        fan: float64 (beams, 2), directions of the beams as unit vectors in the frame of the robot.
        noise: float64 (beams), standard normal.
        ranges: float64 (beams), receives the measured distances.
    """
    robot, k = robots[me], constants[0]
    cos, sin = math.cos(robot.theta), math.sin(robot.theta)
    along = np.empty(fan.shape)
    for beam in range(len(ranges)):
        along[beam, 0] = cos * fan[beam, 0] - sin * fan[beam, 1]
        along[beam, 1] = sin * fan[beam, 0] + cos * fan[beam, 1]
    cast_all(k, skips, robot.x, robot.y, along, ranges)
    for other in range(len(robots)):
        if other != me:
            see_disc(robots[other].x - robot.x, robots[other].y - robot.y, k.radius, robot.theta, k, along, ranges)
    for index in range(len(obstacles)):
        obstacle = obstacles[index]
        if obstacle.is_seen and obstacle.radius > 0.0:
            see_disc(obstacle.x - robot.x, obstacle.y - robot.y, obstacle.radius, robot.theta, k, along, ranges)
        elif obstacle.is_seen:
            see_box(obstacle, robot, k, ranges)
    for beam in range(len(ranges)):
        if ranges[beam] < k.range_max:
            ranges[beam] += k.range_noise * noise[beam]
        if ranges[beam] >= k.range_max:
            ranges[beam] = math.inf
        elif ranges[beam] < k.range_min:
            ranges[beam] = -math.inf


def see_disc(dx: float, dy: float, radius: float, theta: float, k: Record, along: Array, ranges: Array) -> None:
    """Shorten the beams that hit a disc, such as another robot, which is (dx, dy) away from the laser.

    The beams have the directions `along`, float64 (beams, 2), unit vectors.
    """
    square = dx * dx + dy * dy
    if square >= (k.range_max + radius) ** 2 or square <= radius ** 2:
        return
    distance = math.sqrt(square)
    step = 2.0 * math.pi / len(ranges)
    half = math.asin(radius / distance)
    middle = wrap(math.atan2(dy, dx) - theta) + math.pi  # beam 0 points backward
    for beam in range(math.ceil((middle - half) / step), math.floor((middle + half) / step) + 1):
        index = beam % len(ranges)
        side = dx * along[index, 1] - dy * along[index, 0]
        ahead = dx * along[index, 0] + dy * along[index, 1]
        ranges[index] = min(ranges[index], ahead - math.sqrt(max(0.0, radius * radius - side * side)))


def see_box(box: Record, robot: Record, k: Record, ranges: Array) -> None:
    """Shorten the beams of a robot that hit a box: those between its outermost corners."""
    dx, dy = box.x - robot.x, box.y - robot.y
    if not is_near(box, robot.x, robot.y, k.range_max) or outside(box, robot.x, robot.y)[0] <= 0.0:
        return
    bearing, right, left = math.atan2(dy, dx), 0.0, 0.0
    for corner in range(4):
        u = box.half_length if corner & 1 else -box.half_length
        v = box.half_width if corner & 2 else -box.half_width
        off = wrap(math.atan2(dy + box.sin * u + box.cos * v, dx + box.cos * u - box.sin * v) - bearing)
        right, left = min(right, off), max(left, off)
    step = 2.0 * math.pi / len(ranges)
    middle = wrap(bearing - robot.theta) + math.pi  # beam 0 points backward
    u, v = -box.cos * dx - box.sin * dy, box.sin * dx - box.cos * dy
    for beam in range(math.ceil((middle + right) / step), math.floor((middle + left) / step) + 1):
        angle = robot.theta + beam * step - math.pi - box.theta
        enter_u, leave_u = crossing(u, math.cos(angle), box.half_length)
        enter_v, leave_v = crossing(v, math.sin(angle), box.half_width)
        edge = max(enter_u, enter_v)
        if 0.0 <= edge <= min(leave_u, leave_v):
            index = beam % len(ranges)
            ranges[index] = min(ranges[index], edge)


def crossing(position: float, along: float, half: float) -> Tuple[float, float]:
    """Distances along a beam at which one of its coordinates enters and leaves the interval from -half to half.

    `position` is the coordinate at the laser, and grows by `along` per metre. A beam along the border does not enter.
    """
    if abs(along) < NUDGE:
        return (-math.inf, math.inf) if abs(position) < half else (math.inf, -math.inf)
    one, other = (-half - position) / along, (half - position) / along
    return min(one, other), max(one, other)
