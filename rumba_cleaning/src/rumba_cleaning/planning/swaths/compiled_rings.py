"""Where rings are needed, compiled by numba."""

import math
from typing import Any, NamedTuple, Tuple

import numpy as np

from rumba_sim.model.compiling.compiled import fast
from rumba_sim.model.compiling.jit import compiled
from rumba_sim.model.kernel.sweeping.samples import PASS, REACHABLE

interpolated = fast.interpolated

Array = Any  # numpy.ndarray

# All figures are our choice; each comment says what speaks for a larger and for a smaller value.
NEEDED = 0.25  # share of the brush's width that was missed, for a waypoint to be needed: small drives over swept floor
POINTS = 9  # across the brush: one for each 2 cm of a brush of 17 cm
RIDGE = 0.03  # [m] inside a ring the floor must still get wider: where it does not, one pass in the middle is enough
WIDER = 0.7  # of that, by which it must: rings have corners, and a grid is not exact
TINY = 1e-9  # less than any slope or distance that counts


class Floor(NamedTuple):
    """What was swept, and what is left to sweep."""

    samples: Array  # uint8 (rows * squares, columns * squares), as in `Sweep`
    squares: int  # of samples along the side of a cell
    depth: Array  # float64 (rows + 1, columns + 1), how far the nodes are from where the robot would touch a wall [m]
    ridge: float  # [m] as RIDGE; 0: no part of a ring counts as a ridge
    origin: Tuple[float, float]  # of the nodes [m]
    resolution: float  # from node to node [m]


@compiled
def needed(floor: Floor, path: Array, brush: float) -> Array:
    """The waypoints of a path at which the brush finds much that was missed, except on ridges: bool (any).

    Args:
        floor: see above.
        path: float64 (2 or more, 2) [m].
        brush: its width [m].
    """
    floor = Floor(*floor)
    found = np.empty(len(path), np.bool_)
    for index in range(len(path)):
        found[index] = missed_share(floor, path, index, brush) >= NEEDED and not is_ridge(
            floor, path[index, 0], path[index, 1])
    return found


@compiled
def ridges(floor: Floor, path: Array) -> int:
    """How many waypoints of a path, float64 (any, 2) [m], lie on ridges."""
    floor = Floor(*floor)
    count = 0
    for index in range(len(path)):
        count += int(is_ridge(floor, path[index, 0], path[index, 1]))
    return count


@compiled
def missed_share(floor: Floor, path: Array, index: int, brush: float) -> float:
    """The share of the brush's width that was missed at a waypoint, to the nearest cells."""
    before, after = path[max(index - 1, 0)], path[min(index + 1, len(path) - 1)]
    along_x, along_y = after[0] - before[0], after[1] - before[1]
    size = max(math.hypot(along_x, along_y), TINY)
    rows, columns = floor.samples.shape[0] // floor.squares, floor.samples.shape[1] // floor.squares
    count = 0
    for point in range(POINTS):
        beside = brush * (point / (POINTS - 1) - 0.5) / size
        x, y = path[index, 0] - beside * along_y, path[index, 1] + beside * along_x
        row, column = math.floor((y - floor.origin[1]) / floor.resolution), math.floor(
            (x - floor.origin[0]) / floor.resolution)
        count += missed_in(floor, min(max(row, 0), rows - 1), min(max(column, 0), columns - 1))
    return count / (POINTS * floor.squares ** 2)


@compiled
def missed_in(floor: Floor, row: int, column: int) -> int:
    """How many samples of a cell can be reached and were not swept."""
    count, first, left = 0, floor.squares * row, floor.squares * column
    for down in range(floor.squares):
        for right in range(floor.squares):
            sample = floor.samples[first + down, left + right]
            count += int((sample & REACHABLE) > 0 and sample < PASS)
    return count


@compiled
def is_ridge(floor: Floor, x: float, y: float) -> bool:
    """Where the two sides of a ring almost touch: a pass in the middle sweeps there what both would."""
    step = 0.5 * floor.ridge
    slope_x = depth_at(floor, x + step, y) - depth_at(floor, x - step, y)
    slope_y = depth_at(floor, x, y + step) - depth_at(floor, x, y - step)
    inward = floor.ridge / max(math.hypot(slope_x, slope_y), TINY)
    inside = depth_at(floor, x + inward * slope_x, y + inward * slope_y)
    return bool(inside < depth_at(floor, x, y) + WIDER * floor.ridge)


@compiled
def depth_at(floor: Floor, x: float, y: float) -> Any:
    """The depth at a point [m]."""
    return interpolated(floor.depth, (x - floor.origin[0]) / floor.resolution,
                        (y - floor.origin[1]) / floor.resolution)[0]
