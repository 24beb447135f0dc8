"""Floors to plan on, and measures of paths on them that do not use the code under test."""

import math

import numpy as np
from rooms import PLANS, quiet, room

from rumba_cleaning.belief.context import Context
from rumba_cleaning.belief.ground import Ground
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.maps.floor_plan import FREE, OCCUPIED, FloorPlan

BRUSH = quiet().brush.width
STEP = 0.01  # [m]
TINY = 1e-4  # [m]


def ground(plan):
    """The ground that a robot without noise knows from a plan."""
    return Ground(plan, quiet())


GROUNDS = {name: ground(plan) for name, plan in PLANS.items()}


def context(plan, **config):
    """The context of a robot without noise."""
    return Context(plan, quiet(), CleaningConfig(**config))


def knowing(plan, pose, **config):
    """The same of one that begins at a pose and has swept nothing yet."""
    begun = context(plan, **config)
    begun.swept.begin(pose.x, pose.y)
    return begun


def standing_points(floor):
    """The points of all nodes at which the robot can stand: float64 (any, 2) [m]."""
    return floor.points(np.argwhere(floor.fits))


def part_of(plan, *boxes):
    """The free cells of a plan whose centre lies in one of the boxes [m]: bool (rows, columns)."""
    rows, columns = plan.occupancy.shape
    x = plan.origin[0] + (np.arange(columns) + 0.5) * plan.resolution
    y = plan.origin[1] + (np.arange(rows)[:, np.newaxis] + 0.5) * plan.resolution
    return plan.free & np.any([(x > left) & (x < right) & (y > bottom) & (y < top)
                               for left, bottom, right, top in boxes], axis=0)


def wall_with_gap(resolution=0.05, height=3.0, gap=0.8):
    """A room of 4 m, and a wall across it with a gap at its upper end."""
    return room(4.0, height, resolution, [(1.9, 0.0, 2.1, height - gap)])


def closed_off(resolution=0.05):
    """A room, and another that no door joins to it."""
    return room(4.0, 2.0, resolution, [(1.9, 0.0, 2.1, 2.0)])


def two_rooms(resolution=0.05, **kwargs):
    """A larger room on the left and a smaller one on the right, with a door of 0.7 m at their lower end."""
    return room(5.0, 2.4, resolution, [(2.8, 0.0, 2.9, 0.3), (2.8, 1.0, 2.9, 2.4)], **kwargs)


def tilted(width, height, angle, resolution=0.05, box=(0.0, 0.0, 0.0, 0.0)):
    """A room, and a box (left, bottom, right, top) in it, turned by an angle [rad] about its corner at (0, 0)."""
    cos, sin = math.cos(angle), math.sin(angle)
    corners = [(u * cos - v * sin, u * sin + v * cos) for u in (0.0, width) for v in (0.0, height)]
    low = np.min(corners, axis=0) - 2.0 * resolution
    columns, rows = np.ceil((np.max(corners, axis=0) - low) / resolution).astype(int) + 2
    x = low[0] + (np.arange(columns) + 0.5) * resolution
    y = low[1] + (np.arange(rows)[:, np.newaxis] + 0.5) * resolution
    u, v = x * cos + y * sin, y * cos - x * sin
    free = (u > 0.0) & (u < width) & (v > 0.0) & (v < height)
    free &= ~((u > box[0]) & (u < box[2]) & (v > box[1]) & (v < box[3]))
    return FloorPlan('tilted', np.where(free, FREE, OCCUPIED), resolution, tuple(low))


# --- floor that was swept before -----------------------------------------------------------------------------------

def wiped(context, box):
    """The context after the brush swept a box (left, bottom, right, top) [m], wide or high enough for the brush."""
    left, bottom, right, top = np.array(box) + np.array([1.0, 1.0, -1.0, -1.0]) * TINY
    half = 0.5 * BRUSH
    if top - bottom > BRUSH:
        ends = [(Pose(left, y, 0.0), Pose(right, y, 0.0))
                for y in np.linspace(bottom + half, top - half, int((top - bottom) / half) + 2)]
    else:
        ends = [(Pose(x, bottom, 0.5 * math.pi), Pose(x, top, 0.5 * math.pi))
                for x in np.linspace(left + half, right - half, int((right - left) / half) + 2)]
    for start, end in ends:  # in both directions: a sweep leaves out its first pose
        context.swept.sweep(start, end)
        context.swept.sweep(end, start)
    return context


def wiped_but(context, *boxes):
    """The context after the brush swept all of a plan except boxes; gaps between them are no narrower than the brush.

    Boxes that lie side by side have the same bottom and the same top.
    """
    bounds = context.plan.bounds
    height = bounds.bottom
    for bottom, top in [*sorted({(box[1], box[3]) for box in boxes}), (bounds.top, bounds.top)]:
        wiped(context, (bounds.left, height, bounds.right, bottom))
        edges = [edge for box in sorted(boxes) if box[1] == bottom for edge in (box[0], box[2])]
        edges = [bounds.left, *edges, bounds.right] if edges else []
        for left, right in zip(edges[::2], edges[1::2]):
            wiped(context, (left, bottom, right, top))
        height = top
    return context


# --- paths ---------------------------------------------------------------------------------------------------------

def length(path):
    """Length of a path (any, 2) [m]."""
    return float(sum(math.hypot(*step) for step in np.diff(path, axis=0)))


def along(path, step=STEP):
    """Points on each leg of a path, both ends included, no farther apart than a step [m]: float64 (any, 2) [m]."""
    path = np.asarray(path, float)
    return np.concatenate([np.linspace(start, end, int(math.hypot(*(end - start)) / step) + 2)
                           for start, end in zip(path[:-1], path[1:])])


def off(points, start, end):
    """Distance of each point (any, 2) from the straight line from start to end, or from start if they are the same."""
    start, end = np.asarray(start, float), np.asarray(end, float)
    square = max(float(np.sum((end - start) ** 2)), np.finfo(float).tiny)
    share = np.clip((points - start) @ (end - start) / square, 0.0, 1.0)
    return np.hypot(*(points - start - share[:, np.newaxis] * (end - start)).T)


def over(start, left, right, end, reach):
    """Length [m] of the shortest path over two posts at the same y that keeps a distance, `reach` [m], from both.

    It begins left of the `left` post and ends right of the `right` one, at points (x, y) that are not higher.
    """
    result = right[0] - left[0]
    for (x, y), post in ((start, left), (end, right)):
        far = math.hypot(post[0] - x, post[1] - y)
        slope = math.atan2(post[1] - y, abs(post[0] - x)) + math.asin(reach / far)
        result += math.sqrt(far ** 2 - reach ** 2) + reach * slope
    return result


def window_around(cells):
    """The smallest window, rows and columns, that holds bool (rows, columns); an empty one if there are none."""
    sides = (np.flatnonzero(cells.any(axis=axis)) for axis in (1, 0))
    return tuple(slice(side[0], side[-1] + 1) if len(side) else slice(0, 0) for side in sides)
