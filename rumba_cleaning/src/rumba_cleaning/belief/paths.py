"""Paths on the ground from point to point, and their lengths.

A path is float64 (any, 2) [m], map frame. Nodes are those of the ground.
"""

import itertools
from typing import Optional

import numpy as np

from rumba_cleaning.belief.ground import INFLATION, Ground
from rumba_cleaning.belief.search import Costs, Lattice, cheapest, path_lengths
from rumba_sim.model.compiling.jit import plain
from rumba_sim.model.kernel import Array

# Our choice; each comment says what speaks for a larger and for a smaller value.
EXTRA_CLEARANCE = 0.04  # [m] beside straight parts of a path: large touches less, small makes paths shorter
NEAR = 0.4  # [m] a goal this near is driven to directly, without the extra clearance: a path around it costs more
SEARCH_SPACING = 0.05  # [m] between the nodes that are looked at first: large is fast, but misses narrow passages
SEARCH_MARGIN = 2.0  # [m] around both ends is searched first: small is fast, but a longer path needs a second search
# Times its length that a path costs more beside obstacles, at most: large keeps to the open floor, small lets a path
# follow a wall to be shorter.
INFLATION_COST = 2.0


def between(ground: Ground, start: Array, end: Array) -> Optional[Array]:
    """A short path from one point (2) to another [m]; None if there is none.

    Returns:
        float64 (2 or more, 2) [m]. The path begins and ends at the points themselves, even if these are a little
        nearer to a wall than the rest of a path may be.
    """
    is_near = bool(np.hypot(*(end - start)) < NEAR)
    if ground.is_straight(start, end, 0.0 if is_near else EXTRA_CLEARANCE):
        return np.array([start, end])
    first, last = ground.standing(ground.nodes(np.array([start, end])))
    parts = ground.parts()
    if parts[tuple(first)] != parts[tuple(last)]:
        first = np.array(ground.standing_at(*start.tolist()))
        if parts[tuple(first)] != parts[tuple(last)]:
            return None
    near, all_of_it = int(SEARCH_MARGIN / ground.plan.resolution), max(ground.clearance.shape)
    spacings = sorted({max(int(SEARCH_SPACING / ground.plan.resolution + 0.5), 1), 1}, reverse=True)
    for margin, spacing in itertools.product((near, all_of_it), spacings):
        found = _search(ground, first, last, margin, spacing)
        if found is not None:
            break
    else:
        return None
    inner = _straightened(ground, ground.points(found))
    return np.concatenate([[start], inner[1:-1] if len(inner) > 2 else inner, [end]])


def lengths_to(ground: Ground, x: float, y: float) -> Array:
    """Length of the shortest path from each node to a point [m].

    Returns:
        float64 (rows + 1, columns + 1) [m]; inf at nodes from which no path leads there.
    """
    return np.asarray(path_lengths(ground.fits, *ground.standing_at(x, y)) * ground.plan.resolution)


def _search(ground: Ground, first: Array, last: Array, margin: int, spacing: int) -> Optional[Array]:
    """The cheapest path between two nodes (2), or None: int (any, 2), nodes.

    It stays in the rectangle around both nodes that is larger by `margin` nodes on each side, and visits only each node
    that is a multiple of `spacing` from the first; from the one nearest to the last it goes on to that.
    """
    low = np.maximum(np.minimum(first, last) - margin, first % spacing)
    low += (first - low) % spacing
    high = np.minimum(np.maximum(first, last) + margin + 1, ground.clearance.shape)
    rows, columns = ((high - low + spacing - 1) // spacing).tolist()
    begin = (first - low) // spacing
    end = np.minimum((last - low + spacing // 2) // spacing, (rows - 1, columns - 1))
    if not ground.fits[tuple(low + spacing * end)]:
        return None
    costs = Costs(ground.clearance, ground.fits, ground.reach, INFLATION, INFLATION_COST)
    lattice = Lattice(int(low[0]), int(low[1]), rows, columns, spacing)
    found = cheapest(plain(costs), plain(lattice), (int(begin[0]), int(begin[1])), (int(end[0]), int(end[1])))
    if len(found) == 0:
        return None
    path = found * spacing + low
    return path if (path[-1] == last).all() else np.concatenate([path, [last]])


def _straightened(ground: Ground, path: Array) -> Array:
    """A path (any, 2) without the waypoints that it does not need.

    From each waypoint that is kept, the next one is about the farthest that a straight line reaches: found by doubling
    the step as long as the line is free, and then by bisection.
    """
    kept, here, last = [0], 0, len(path) - 1
    while here < last:
        low, high = here + 1, last + 1
        step = 2
        while here + step <= last and ground.is_straight(path[here], path[here + step], EXTRA_CLEARANCE):
            low, step = here + step, 2 * step
        high = min(here + step, last + 1)
        while high - low > 1:
            middle = (low + high) // 2
            if ground.is_straight(path[here], path[middle], EXTRA_CLEARANCE):
                low = middle
            else:
                high = middle
        here = low
        kept.append(here)
    return path[kept]
