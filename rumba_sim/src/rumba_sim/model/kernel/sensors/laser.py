"""What the laser measures: the distances of walls, other robots and obstacles."""

import math
from typing import Tuple

import numpy as np

from rumba_sim.model.kernel import Array, Record
from rumba_sim.model.kernel.geometry import wrap
from rumba_sim.model.kernel.obstacles import is_near, outside
from rumba_sim.model.kernel.sensors.beams import NUDGE, cast_all
from rumba_sim.model.kernel.sensors.echoes import echo, wide_echo


def scan(robots: Array, me: int, constants: Array, obstacles: Array, skips: Array, fans: Array, noise: Array,
         bias: float, ranges: Array) -> None:
    """Measure with the laser of the robot with index `me`.

    Args, apart from those of the package:
        fans: float64 (1 or 3, beams, 2), directions of beams as unit vectors in the frame of the robot: their middles,
            or one edge, the middles, and the other edge.
        noise: float64 (1 or 2, beams), standard normal, and uniform in [0, 1) for a laser that needs it.
        bias: systematic error of this laser, in its standard deviations.
        ranges: float64 (beams), receives what the laser tells.
    """
    k = constants[0]
    if len(fans) == 1:
        look_along(robots, me, k, obstacles, skips, fans[0], k.first_beam, ranges)
        for beam in range(len(ranges)):
            chance = noise[1, beam] if len(noise) > 1 else 1.0
            ranges[beam] = echo(k, ranges[beam], noise[0, beam], chance, bias)
        return
    seen = np.empty((3, len(ranges)))
    for fan in range(3):
        first = k.first_beam + 0.5 * (fan - 1) * k.beam_width
        look_along(robots, me, k, obstacles, skips, fans[fan], first, seen[fan])
    for beam in range(len(ranges)):
        ranges[beam] = wide_echo(k, seen[:, beam], noise[0, beam], noise[1, beam], bias)


def look_along(robots: Array, me: int, k: Record, obstacles: Array, skips: Array, fan: Array, first: float,
               ranges: Array) -> None:
    """How far it is from the laser of a robot along the beams of a fan, at most `range_max`.

    Args, apart from those above:
        fan: float64 (beams, 2), directions of the beams in the frame of the robot.
        first: angle of the first of them, in the same frame.
        ranges: float64 (beams), receives the distances.
    """
    robot = robots[me]
    cos, sin = math.cos(robot.theta), math.sin(robot.theta)
    x, y = robot.x + cos * k.laser_x - sin * k.laser_y, robot.y + sin * k.laser_x + cos * k.laser_y
    along = np.empty(fan.shape)
    for beam in range(len(ranges)):
        along[beam, 0] = cos * fan[beam, 0] - sin * fan[beam, 1]
        along[beam, 1] = sin * fan[beam, 0] + cos * fan[beam, 1]
    cast_all(k, skips, x, y, along, ranges)
    for other in range(len(robots)):
        if other != me:
            see_disc(robots[other].x - x, robots[other].y - y, k.radius, robot.theta, first, k, along, ranges)
    for index in range(len(obstacles)):
        obstacle = obstacles[index]
        if obstacle.is_seen and obstacle.radius > 0.0:
            see_disc(obstacle.x - x, obstacle.y - y, obstacle.radius, robot.theta, first, k, along, ranges)
        elif obstacle.is_seen:
            see_box(obstacle, x, y, robot.theta, first, k, ranges)


def see_disc(dx: float, dy: float, radius: float, theta: float, first: float, k: Record, along: Array,
             ranges: Array) -> None:
    """Shorten the beams that hit a disc, such as another robot, which is (dx, dy) away from the laser.

    Beam 0 has the angle `first` to the heading `theta` of the robot; the beams have the directions `along`, float64
    (beams, 2), unit vectors.
    """
    square = dx * dx + dy * dy
    if square >= (k.range_max + radius) ** 2 or square <= radius ** 2:
        return
    distance = math.sqrt(square)
    step = abs(k.beam_step)
    half = math.asin(radius / distance)
    middle = from_first(math.atan2(dy, dx) - theta, first, k)
    for beam in range(math.ceil((middle - half) / step), math.floor((middle + half) / step) + 1):
        index = beam % k.beams_per_turn
        if index < len(ranges):
            side = dx * along[index, 1] - dy * along[index, 0]
            ahead = dx * along[index, 0] + dy * along[index, 1]
            ranges[index] = min(ranges[index], ahead - math.sqrt(max(0.0, radius * radius - side * side)))


def see_box(box: Record, x: float, y: float, theta: float, first: float, k: Record, ranges: Array) -> None:
    """Shorten the beams of a laser at (x, y) that hit a box: those between its outermost corners."""
    dx, dy = box.x - x, box.y - y
    if not is_near(box, x, y, k.range_max) or outside(box, x, y)[0] <= 0.0:
        return
    bearing, right, left = math.atan2(dy, dx), 0.0, 0.0
    for corner in range(4):
        u = box.half_length if corner & 1 else -box.half_length
        v = box.half_width if corner & 2 else -box.half_width
        off = wrap(math.atan2(dy + box.sin * u + box.cos * v, dx + box.cos * u - box.sin * v) - bearing)
        right, left = min(right, off), max(left, off)
    step = abs(k.beam_step)
    if k.beam_step < 0.0:
        right, left = -left, -right
    middle = from_first(bearing - theta, first, k)
    u, v = -box.cos * dx - box.sin * dy, box.sin * dx - box.cos * dy
    for beam in range(math.ceil((middle + right) / step), math.floor((middle + left) / step) + 1):
        angle = theta + beam * k.beam_step + first - box.theta
        enter_u, leave_u = crossing(u, math.cos(angle), box.half_length)
        enter_v, leave_v = crossing(v, math.sin(angle), box.half_width)
        edge = max(enter_u, enter_v)
        index = beam % k.beams_per_turn
        if 0.0 <= edge <= min(leave_u, leave_v) and index < len(ranges):
            ranges[index] = min(ranges[index], edge)


def from_first(angle: float, first: float, k: Record) -> float:
    """Angle from the first beam, in the direction in which the beams follow one another, in [0, 2 pi]."""
    off = wrap(angle) - first
    if k.beam_step < 0.0:
        off = -off
    return off if 0.0 <= off <= 2.0 * math.pi else off % (2.0 * math.pi)


def crossing(position: float, along: float, half: float) -> Tuple[float, float]:
    """Distances along a beam at which one of its coordinates enters and leaves the interval from -half to half.

    `position` is the coordinate at the laser, and grows by `along` per metre. A beam along the border does not enter.
    """
    if abs(along) < NUDGE:
        return (-math.inf, math.inf) if abs(position) < half else (math.inf, -math.inf)
    one, other = (-half - position) / along, (half - position) / along
    return min(one, other), max(one, other)
