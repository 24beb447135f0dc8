"""What is under a robot: cliffs and carpet under its wheels, and what its cliff sensors see."""

import math
from typing import Tuple

from rumba_sim.model.kernel import Array, Record

BLOCKED, CLIFF, CARPET = 1, 2, 4  # bits of a cell


def cell_bits(k: Record, cells: Array, x: float, y: float) -> int:
    """The byte of the cell that contains a point; outside the map everything is BLOCKED."""
    u, v = (x - k.origin_x) / k.resolution, (y - k.origin_y) / k.resolution
    if 0.0 <= u < cells.shape[1] and 0.0 <= v < cells.shape[0]:
        return int(cells[int(v), int(u)])
    return BLOCKED


def stand(robot: Record, k: Record, cells: Array) -> float:
    """Mark a robot as fallen if a wheel is over a cliff; returns the traction of its wheels."""
    x, y = -0.5 * k.wheel_base * math.sin(robot.theta), 0.5 * k.wheel_base * math.cos(robot.theta)
    left, right = cell_bits(k, cells, robot.x + x, robot.y + y), cell_bits(k, cells, robot.x - x, robot.y - y)
    if (left | right) & CLIFF:
        robot.fallen = True
    return k.carpet_traction if left & right & CARPET else k.floor_traction


def cliff_angles(k: Record) -> Tuple[float, float, float, float]:
    """Of the cliff sensors, from left to right, from straight ahead [rad]."""
    return k.cliff_outer, k.cliff_inner, -k.cliff_inner, -k.cliff_outer


def look_down(robot: Record, k: Record, cells: Array) -> None:
    """Have each cliff sensor hold what it sees at the end of a tick, if that is a cliff."""
    for sensor, angle in enumerate(cliff_angles(k)):
        if is_over_cliff(robot, k, cells, angle):
            robot.cliff_ticks[sensor] = k.cliff_hold
        elif robot.cliff_ticks[sensor] > 0:
            robot.cliff_ticks[sensor] -= 1


def is_over_cliff(robot: Record, k: Record, cells: Array, angle: float) -> bool:
    """Whether there is no floor under the cliff sensor at an angle from straight ahead [rad]."""
    along = robot.theta + angle
    x, y = robot.x + k.cliff_distance * math.cos(along), robot.y + k.cliff_distance * math.sin(along)
    return cell_bits(k, cells, x, y) & CLIFF != 0


def cliffs(robots: Array, me: int, constants: Array, cells: Array, seen: Array) -> None:
    """Whether each cliff sensor of the robot with index `me` sees a cliff, or holds one that it saw.

    Args, apart from those of the package:
        seen: bool (4), from left to right, receives the answer.
    """
    robot, k = robots[me], constants[0]
    for sensor, angle in enumerate(cliff_angles(k)):
        seen[sensor] = k.has_cliffs and (robot.cliff_ticks[sensor] > 0 or is_over_cliff(robot, k, cells, angle))
