"""The bumper: which of its switches are pressed, and where."""

import math

from rumba_sim.model.kernel import Array, Record
from rumba_sim.model.kernel.geometry import clearance, wrap
from rumba_sim.model.kernel.motion import PUSH, TOUCH, nearest
from rumba_sim.model.kernel.obstacles import is_near, outside

LEFT, RIGHT = 1, 2  # bits of the bumper


def touch(robots: Array, me: int, k: Record, obstacles: Array, field: Array, now: int, toward_x: float,
          toward_y: float) -> None:
    """Press the switches of the bumper if a wall, an obstacle or a robot touches the front.

    (toward_x, toward_y) points to what stopped the robot; (0, 0) if nothing did.
    """
    robot = robots[me]
    robot.contact_angle = math.nan
    pressed = press(robot, k, toward_x, toward_y) if toward_x != 0.0 or toward_y != 0.0 else 0
    gap, along_x, along_y = clearance(k, field, robot.x, robot.y)
    if gap < k.reach + PUSH + TOUCH:
        pressed |= press(robot, k, -along_x, -along_y)
    for index in range(len(obstacles)):
        if is_near(obstacles[index], robot.x, robot.y, k.radius + PUSH + TOUCH):
            gap, along_x, along_y = outside(obstacles[index], robot.x, robot.y)
            if gap < k.radius + PUSH + TOUCH:
                pressed |= press(robot, k, -along_x, -along_y)
    if now >= robot.alone_until:
        _, distance = nearest(robots, me, k, now, robot.x, robot.y)
        if distance < 2.0 * k.radius + PUSH + TOUCH:
            for other in range(len(robots)):
                x, y = robots[other].x - robot.x, robots[other].y - robot.y
                if other != me and math.hypot(x, y) < 2.0 * k.radius + PUSH + TOUCH:
                    pressed |= press(robot, k, x, y)
    if pressed and not robot.bumper:
        robot.bumps += 1
    robot.bumper = pressed


def press(robot: Record, k: Record, toward_x: float, toward_y: float) -> int:
    """The switches that a contact in this direction presses; updates `contact_angle` if it is nearer to the front."""
    angle = wrap(math.atan2(toward_y, toward_x) - robot.theta)
    if not abs(angle) >= abs(robot.contact_angle):  # true also if there was no contact yet: NaN
        robot.contact_angle = angle
    if abs(angle) > k.bumper_half:
        return 0
    return (LEFT if angle >= -k.overlap_half else 0) | (RIGHT if angle <= k.overlap_half else 0)
