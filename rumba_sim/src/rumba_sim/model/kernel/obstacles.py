"""How far away obstacles are that the map does not show."""

import math

from rumba_sim.model.kernel import Array, Record, Triple


def is_near(obstacle: Record, x: float, y: float, within: float) -> bool:
    """Whether an obstacle may be nearer than `within` to (x, y): false if the circle around it is not."""
    dx, dy, far = x - obstacle.x, y - obstacle.y, obstacle.reach + within
    return bool(dx * dx + dy * dy < far * far)


def outside(obstacle: Record, x: float, y: float) -> Triple:
    """Distance from an obstacle to (x, y), negative inside it, and the direction away from it as a unit vector."""
    dx, dy = x - obstacle.x, y - obstacle.y
    u, v = obstacle.cos * dx + obstacle.sin * dy, obstacle.cos * dy - obstacle.sin * dx
    beyond_u, beyond_v = abs(u) - obstacle.half_length, abs(v) - obstacle.half_width
    if beyond_u <= 0.0 and beyond_v <= 0.0:
        gap = max(beyond_u, beyond_v)
        along_u, along_v = (1.0, 0.0) if beyond_u > beyond_v else (0.0, 1.0)
    else:
        along_u, along_v = max(beyond_u, 0.0), max(beyond_v, 0.0)
        gap = math.hypot(along_u, along_v)
        along_u, along_v = along_u / gap, along_v / gap
    along_u, along_v = math.copysign(along_u, u), math.copysign(along_v, v)
    return (gap - obstacle.radius, obstacle.cos * along_u - obstacle.sin * along_v,
            obstacle.sin * along_u + obstacle.cos * along_v)


def nearest_obstacle(obstacles: Array, x: float, y: float, within: float) -> Triple:
    """What `outside` answers for the nearest obstacle; (`within`, 0, 0) if none is nearer than that."""
    least, away_x, away_y = within, 0.0, 0.0
    for index in range(len(obstacles)):
        if is_near(obstacles[index], x, y, least):
            gap, along_x, along_y = outside(obstacles[index], x, y)
            if gap < least:
                least, away_x, away_y = gap, along_x, along_y
    return least, away_x, away_y


def keep_clear(obstacles: Array, k: Record, field: Array) -> None:
    """Reduce the clearance at the corners of the cells to the distance from obstacles, where that is smaller."""
    for row in range(field.shape[0]):
        for column in range(field.shape[1]):
            x, y = k.origin_x + column * k.resolution, k.origin_y + row * k.resolution
            field[row, column] = max(nearest_obstacle(obstacles, x, y, field[row, column])[0], 0.0)
