"""What is under a robot: cliffs and carpet under its wheels, and what its cliff sensors see."""

import math

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


def cliffs(robots: Array, me: int, constants: Array, cells: Array, distance: float, angles: Array,
           seen: Array) -> None:
    """Whether there is no floor under each cliff sensor of the robot with index `me`.

    Args, apart from those of the package:
        distance: of the sensors from the centre of the robot [m].
        angles: float64 (sensors), from straight ahead [rad].
        seen: bool (sensors), receives the answer.
    """
    robot, k = robots[me], constants[0]
    for sensor in range(len(angles)):
        along = robot.theta + angles[sensor]
        seen[sensor] = k.has_layers and cell_bits(
            k, cells, robot.x + distance * math.cos(along), robot.y + distance * math.sin(along)) & CLIFF != 0
