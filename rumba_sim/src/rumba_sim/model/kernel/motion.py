"""How a robot moves in a tick: on an arc, along what is in its way, and never into it."""

import math
from typing import Tuple

from rumba_sim.model.kernel import Array, Record, Triple
from rumba_sim.model.kernel.geometry import arc, clearance, wrap
from rumba_sim.model.kernel.obstacles import nearest_obstacle
from rumba_sim.model.kernel.walls import HELD, is_held, is_way_clear

TOUCH = 0.0005  # [m] a smaller gap is a contact
PUSH = 0.0001  # [m] a push leaves this gap, so that rounding cannot leave an overlap
PUSHES = 8  # how often a robot is pushed in one tick before it stays where it was


def move(robots: Array, me: int, k: Record, obstacles: Array, field: Array, cells: Array,
         now: int) -> Tuple[float, float]:
    """Move a robot as its wheels turn for one tick; it slides along obstacles and never enters them.

    Returns the vector from where the robot is now to where its wheels led: (0, 0) if nothing was in the way.
    """
    robot = robots[me]
    distance = 0.5 * (robot.left_speed + robot.right_speed) * k.dt
    turn = (robot.right_speed - robot.left_speed) / k.wheel_base * k.dt
    if distance == 0.0:
        robot.theta = wrap(robot.theta + turn)
        return 0.0, 0.0
    to_x, to_y, robot.theta = arc(robot.x, robot.y, robot.theta, distance, turn)
    x, y = settle(robots, me, k, obstacles, field, now, to_x, to_y)
    if (x != to_x or y != to_y) and is_held(robot, k, field, cells, to_x, to_y, x, y) and is_clear_of_others(
            robots, me, k, obstacles, now, to_x, to_y):
        x, y = to_x, to_y
    robot.distance += math.hypot(x - robot.x, y - robot.y)
    robot.x, robot.y = x, y
    return to_x - x, to_y - y


def lead(robot: Record, k: Record, to: Array) -> Triple:
    """Put a robot at the pose `to` within one tick, and set the speeds of its wheels to match.

    `to` is a row of `led` of `follow`. Returns the pose from which the brush sweeps in this tick.
    """
    from_x, from_y, from_theta = robot.x, robot.y, robot.theta
    robot.x, robot.y, robot.theta = to[0], to[1], to[2]
    if to[3] == 0.0:
        robot.left_speed = robot.right_speed = 0.0
        return to[0], to[1], to[2]
    turn = wrap(to[2] - from_theta)
    along = from_theta + 0.5 * turn
    distance = (to[0] - from_x) * math.cos(along) + (to[1] - from_y) * math.sin(along)
    robot.left_speed = (distance - 0.5 * turn * k.wheel_base) / k.dt
    robot.right_speed = (distance + 0.5 * turn * k.wheel_base) / k.dt
    robot.distance += abs(distance)
    return from_x, from_y, from_theta


def halted(robot: Record, k: Record, field: Array, cells: Array, v: float) -> float:
    """The part of a forward speed `v` that does not drive a robot into a wall within one tick."""
    gap, along_x, along_y = clearance(k, field, robot.x, robot.y)
    cos, sin = math.cos(robot.theta), math.sin(robot.theta)
    nearer = -v * k.dt * (along_x * cos + along_y * sin)
    if nearer <= 0.0 or gap - nearer >= k.reach:
        return v
    slower = v * max(gap - k.reach, 0.0) / nearer
    if abs(slower) < HELD * abs(v) and is_way_clear(
            robot, k, field, cells, robot.x + v * k.dt * cos, robot.y + v * k.dt * sin):
        return v
    return slower


def settle(robots: Array, me: int, k: Record, obstacles: Array, field: Array, now: int, x: float,
           y: float) -> Tuple[float, float]:
    """Where a robot ends that moves to (x, y): pushed out of all that is there, or where it was if that fails."""
    for _ in range(PUSHES):
        gap, along_x, along_y = clearance(k, field, x, y)
        free = gap >= k.reach
        if not free:
            slope = math.hypot(along_x, along_y)
            if slope < 1e-6:
                break
            push = (k.reach + PUSH - gap) / slope
            x, y = x + push * along_x, y + push * along_y
        if len(obstacles) > 0:
            gap, along_x, along_y = nearest_obstacle(obstacles, x, y, k.radius)
            if gap < k.radius:
                free = False
                push = k.radius + PUSH - gap
                x, y = x + push * along_x, y + push * along_y
        if now >= robots[me].alone_until:
            other, distance = nearest(robots, me, k, now, x, y)
            if other >= 0 and distance < 2.0 * k.radius:
                if distance < 1e-6:
                    break
                free = False
                push = (2.0 * k.radius + PUSH - distance) / distance
                x, y = x + push * (x - robots[other].x), y + push * (y - robots[other].y)
        if free:
            if math.hypot(x - robots[me].x, y - robots[me].y) > max_displacement(k):
                break
            return x, y
    return robots[me].x, robots[me].y


def is_clear_of_others(robots: Array, me: int, k: Record, obstacles: Array, now: int, x: float, y: float) -> bool:
    """Whether a robot overlaps no obstacle and no other robot at (x, y)."""
    if len(obstacles) > 0 and nearest_obstacle(obstacles, x, y, k.radius)[0] < k.radius:
        return False
    return now < robots[me].alone_until or nearest(robots, me, k, now, x, y)[1] >= 2.0 * k.radius


def max_displacement(k: Record) -> float:
    """The farthest that a robot may move in one tick: a push may double what it drives."""
    return 2.0 * (k.max_speed * k.dt + PUSH)


def nearest(robots: Array, me: int, k: Record, now: int, x: float, y: float) -> Tuple[int, float]:
    """Index of the other robot that is nearest to (x, y), -1 if there is none, and its distance.

    Sets `alone_until`: before that tick no other robot can come near, so that robots far apart need not search.
    """
    other, square = -1, math.inf
    for index in range(len(robots)):
        if index != me:
            dx, dy = robots[index].x - x, robots[index].y - y
            if dx * dx + dy * dy < square:
                other, square = index, dx * dx + dy * dy
    distance = math.sqrt(square)
    if other < 0:
        robots[me].alone_until = now + 1000
    else:
        # Both robots may approach each other, and this one may still be pushed away from (x, y).
        robots[me].alone_until = now + int((distance - 2.0 * k.radius - TOUCH) / (2.0 * max_displacement(k))) - 1
    return other, distance
