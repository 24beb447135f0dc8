"""How far away walls are, exactly, and whether the interpolated clearance holds a robot that they do not.

Between walls that are about equally near, the interpolated clearance is too small by up to half a cell. It has dents
there: a robot that is pushed out of one by its slopes may come back to where it was, in whichever direction it drives.
"""

import math

from rumba_sim.model.kernel import Array, Record
from rumba_sim.model.kernel.geometry import clearance
from rumba_sim.model.kernel.ground import BLOCKED, cell_bits

HELD = 0.5  # a robot is held if it makes less than this share of its way
STRIDES = 10  # in which a robot looks ahead, as far as its radius


def wall_distance(k: Record, field: Array, cells: Array, x: float, y: float) -> float:
    """Distance from (x, y) to the nearest wall; 0 in a wall, outside the map, and if a coordinate is NaN.

    The distance at the nearest corner of a cell is known, and differs from this one by the way from there at most: only
    cells that are neither nearer nor farther than that are looked at.
    """
    u, v = (x - k.origin_x) / k.resolution, (y - k.origin_y) / k.resolution
    if not (0.0 <= u <= cells.shape[1] and 0.0 <= v <= cells.shape[0]):
        return 0.0
    corner_u, corner_v = int(u + 0.5), int(v + 0.5)
    known, way = field[corner_v, corner_u] / k.resolution, math.hypot(u - corner_u, v - corner_v)
    near, far = max(known - way, 0.0), known + way
    least = far * far
    for row in range(math.floor(v - far), math.floor(v + far) + 1):
        beyond_v = v - min(max(v, row), row + 1.0)
        inner = math.sqrt(max(near * near - beyond_v * beyond_v, 0.0))
        outer = math.sqrt(max(least - beyond_v * beyond_v, 0.0))
        for begin, end in ((u - outer, u - inner), (u + inner, u + outer)):
            for column in range(math.floor(begin), math.floor(end) + 1):
                if is_wall(cells, row, column):
                    beyond_u = u - min(max(u, column), column + 1.0)
                    least = min(least, beyond_u * beyond_u + beyond_v * beyond_v)
    return math.sqrt(least) * k.resolution


def is_wall(cells: Array, row: int, column: int) -> bool:
    """Whether a cell is a wall, as all cells outside the map are."""
    return not (0 <= row < cells.shape[0] and 0 <= column < cells.shape[1]) or cells[row, column] & BLOCKED != 0


def is_held(robot: Record, k: Record, field: Array, cells: Array, to_x: float, to_y: float, x: float, y: float) -> bool:
    """Whether only a dent has a robot settle at (x, y) that its wheels lead to (to_x, to_y).

    In a dent already, it goes on until it touches a wall: else it would be pushed out of the dent in one tick.
    """
    if clearance(k, field, to_x, to_y)[0] >= k.reach:
        return False
    if clearance(k, field, robot.x, robot.y)[0] < k.reach:
        return wall_distance(k, field, cells, to_x, to_y) >= k.radius
    way_x, way_y = to_x - robot.x, to_y - robot.y
    if (x - robot.x) * way_x + (y - robot.y) * way_y >= HELD * (way_x * way_x + way_y * way_y):
        return False
    # As a rule there is a wall where the robot was pushed from, which is a quick answer.
    depth = k.radius / math.hypot(to_x - x, to_y - y)
    if cell_bits(k, cells, to_x + depth * (to_x - x), to_y + depth * (to_y - y)) & BLOCKED:
        return False
    return is_way_clear(robot, k, field, cells, to_x, to_y)


def is_way_clear(robot: Record, k: Record, field: Array, cells: Array, x: float, y: float) -> bool:
    """Whether a robot that moves to (x, y) touches no wall, nor farther straight on until it is out of the dent."""
    stride = k.radius / STRIDES / math.hypot(x - robot.x, y - robot.y)
    stride_x, stride_y = stride * (x - robot.x), stride * (y - robot.y)
    for number in range(STRIDES):
        ahead_x, ahead_y = x + number * stride_x, y + number * stride_y
        if clearance(k, field, ahead_x, ahead_y)[0] >= k.reach:
            return True
        if wall_distance(k, field, cells, ahead_x, ahead_y) < k.radius:
            return False
    return False
