"""Routes over an empty rectangle, in closed form: a spiral of lanes that lie a brush apart.

Nothing is to be gained there by search. The spiral has four turns in a lap, and nowhere drives over swept floor. Each
rounded turn leaves a sliver beside it, all on the diagonals: a wide turn takes less time, a tight one leaves less.
"""

import itertools
import math
from typing import List, NamedTuple, Optional

import numpy as np

from rumba_cleaning.belief.context import Context
from rumba_cleaning.planning.order.route import route_over
from rumba_cleaning.planning.swaths.rings import WALL_MARGIN
from rumba_cleaning.route import Route
from rumba_sim.model.common.geometry import Pose, hypot
from rumba_sim.model.kernel import Array

# All figures are our choice.
APART = 1.005  # of the brush's width from lane to lane, at most
WIDEST = 0.25  # [m] radius of turns
SURPLUS = 0.005  # of coverage that is planned beyond the target, since no robot drives exactly as planned
SMALLEST = 8.0  # [m] of a side: smaller rooms are searched in little time
STRAIGHT = 0.002  # [m] by which walls may be uneven
ARC = 0.2  # [rad] from waypoint to waypoint of a turn


class Rectangle(NamedTuple):
    """Where the centre of a robot may be [m], map frame."""

    left: float
    bottom: float
    right: float
    top: float


def spiral_over(context: Context, pose: Pose) -> Optional[Route]:
    """A route over a floor that is one empty rectangle; None if it is not, or the route would miss the target.

    It leads outward if the robot is in the middle, and else inward. Its turns are as wide as the target allows: they
    leave floor between the arcs of two laps.

    Args:
        context: with the floor that was swept before; it is not changed.
        pose: from which the route begins, map frame.
    """
    found = rectangle(context)
    spare = (1.0 - context.target_coverage - SURPLUS) * context.swept.reachable_area
    if found is None or context.swept.coverage > 0.0 or spare <= 0.0:
        return None
    brush = context.robot.brush.width
    path = corners(found, APART * brush)
    radius = min(spare / ((len(path) - 2) * (1.0 - 0.25 * math.pi) * 2.0 * brush), WIDEST)
    path = rounded(path, radius)
    first, last = (hypot(pose.x - end[0], pose.y - end[1]) for end in (path[0], path[-1]))
    return route_over(context, pose, [(None, path if first <= last else path[::-1])])


def rectangle(context: Context) -> Optional[Rectangle]:
    """All the floor on which a robot can stand, if that is a rectangle along the axes of the map; else None."""
    ground = context.ground
    if ground.has_marks or not ground.fits.any():
        return None
    rows, columns = (np.flatnonzero(ground.fits.any(axis=axis)) for axis in (1, 0))
    block = slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)
    if not ground.fits[block].all():
        return None
    spare, resolution = ground.clearance[block] - ground.reach - WALL_MARGIN, ground.plan.resolution
    sides = spare[:, 0], spare[0], spare[:, -1], spare[-1]
    if any(np.ptp(side) > STRAIGHT for side in sides):
        return None
    west, south, east, north = (float(side.min()) for side in sides)
    x, y = ground.plan.origin
    found = Rectangle(x + columns[0] * resolution - west, y + rows[0] * resolution - south,
                      x + columns[-1] * resolution + east, y + rows[-1] * resolution + north)
    return found if min(found.right - found.left, found.top - found.bottom) >= SMALLEST else None


def corners(within: Rectangle, apart: float) -> Array:
    """The corners of a spiral from the walls to the middle: float64 (any, 2) [m].

    Args:
        within: where it leads.
        apart: from lane to lane [m], at most.
    """
    left, bottom, right, top = within
    short = min(right - left, top - bottom)
    step = short / math.ceil(short / apart)
    found = [(left, bottom)]
    for side in itertools.cycle(range(4)):
        if left > right + 0.5 * step or bottom > top + 0.5 * step:
            break
        found.append(((right, bottom), (right, top), (left, top), (left, bottom))[side])
        bottom, right, top, left = (bottom + step * (side == 0), right - step * (side == 1), top - step * (side == 2),
                                    left + step * (side == 3))
    return np.array(found)


def rounded(path: Array, radius: float) -> Array:
    """A path whose corners, all of them right, are rounded."""
    points: List[Array] = [path[:1]]
    for before, corner, after in zip(path, path[1:], path[2:]):
        into, out = corner - before, after - corner
        size = min(radius, 0.5 * np.abs(into).max(), 0.5 * np.abs(out).max())
        into, out = into / np.abs(into).max(), out / np.abs(out).max()
        angles = np.linspace(0.0, 0.5 * math.pi, math.ceil(0.5 * math.pi / ARC) + 1)[:, np.newaxis]
        points.append(corner - size * into + size * (np.sin(angles) * into + (1.0 - np.cos(angles)) * out))
    return np.concatenate([*points, path[-1:]])
