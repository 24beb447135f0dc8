"""Rebuilds routes: of their own pieces and those of other drafts, the best ones are driven in the best order.

Drafts are laid out by few rules for a whole floor, and tours lead over their stretches as these are. Pieces of all of
them show what suits each part of the floor, and where it is better to go on elsewhere.
"""

from typing import Iterator, Optional, Sequence, Tuple

import numpy as np
from scipy import spatial

from rumba_cleaning.belief import paths
from rumba_cleaning.belief.context import Context
from rumba_cleaning.planning.common.lines import needed
from rumba_cleaning.planning.common.nearest import nearest
from rumba_cleaning.planning.common.stretches import Variant, headings
from rumba_cleaning.planning.order.tour import BESIDE
from rumba_cleaning.planning.order.transit import TRANSIT, route_over
from rumba_cleaning.planning.search import compiled_pieces, compiled_rebuilding, pieces
from rumba_cleaning.planning.search.compiled_detours import sees
from rumba_cleaning.planning.search.compiled_pieces import FAR, TOGETHER, Pace
from rumba_cleaning.planning.search.compiled_rebuilding import GOAL, START, Net
from rumba_cleaning.planning.simulate.rehearsal import Rehearsal
from rumba_cleaning.planning.swaths.problem import Problem
from rumba_cleaning.route import BENT, STOP, TURN_RATE, Route, lengths_along
from rumba_sim.model.compiling.jit import plain
from rumba_sim.model.kernel import Array

# All figures are our choice; each comment says what speaks for a larger and for a smaller value.
STEPS, EACH = 3000, 15  # of the search, at most, in all and for each piece: large makes shorter routes, small is fast
# [s/m^2] that it is worth to sweep floor, times the share that the target leaves, and at least and at most: about what
# the last that the target needs takes; a lane takes 20. Large sweeps more than is needed, small leaves much to edits.
PRICE, CHEAPEST, DEAREST = 3.0, 100.0, 1000.0
NEAR, FARTHEST = 100, 2.0  # ends that are near to one, and how far away [m], at most: large is exact, small is fast
CELL = 0.03  # [m] side of the cells in which floor is counted, about: large is fast, small is exact


def rebuilt(problem: Problem, rehearsal: Rehearsal, paths: Sequence[Array]) -> Route:
    """A route that takes less time for what it sweeps, or sweeps more, about; edits have to make it meet the target.

    Args:
        problem: for which the route is.
        rehearsal: of the route, with waypoints that are not far apart.
        paths: of other drafts, float64 (any, 2) [m] each.
    """
    context, pose = problem.context, problem.pose
    own = pieces.of_route(rehearsal, context.config.speed, context.robot.brush.width)
    goal = pose if problem.end is None else problem.end
    points = [np.array([place[:2], place[:2]]) for place in (pose, goal)]
    parts = points + own + pieces.of_paths(paths, own)
    tour = 2 * np.array([START, *range(len(points), len(points) + len(own)), GOAL])
    links = _Links(context, parts, problem.end is None)
    links.add_known(tour)
    wanted, size = _wanted(problem)
    cells, stops = compiled_pieces.cells(*_joined(parts), 0.5 * context.robot.brush.width, wanted,
                                         context.plan.origin, size)
    durations = compiled_pieces.durations(*_joined(parts), context.config.speed, plain(rehearsal.drive))
    middles = np.array([part[len(part) // 2] if len(part) > 2 else part.mean(axis=0) for part in parts])
    net = Net(links.near, links.times, durations, middles, cells, stops, _price(context) * size ** 2)
    found = compiled_rebuilding.rebuilt(net, tour, wanted.size, min(EACH * len(tour), STEPS))
    return route_over(context, pose, links.legs(found)) or rehearsal.route


def _price(context: Context) -> float:
    """What it is worth to sweep floor [s/m^2]."""
    return min(max(PRICE / max(1.0 - context.target_coverage, 1e-9), CHEAPEST), DEAREST)


def _joined(parts: Sequence[Array]) -> Tuple[Array, Array]:
    """Pieces one behind the other: waypoints, float64 (any, 2) [m]; where each begins, and the end of the last."""
    return np.concatenate(parts), np.cumsum([0, *map(len, parts)])


def _wanted(problem: Problem) -> Tuple[Array, float]:
    """The cells to sweep, bool (rows, columns), most of which was missed; their side [m]."""
    resolution = problem.context.plan.resolution
    count = max(round(CELL / resolution), 1)
    missing = problem.context.swept.missing_share() * problem.around
    rows, columns = (size // count for size in missing.shape)
    shares = missing[:rows * count, :columns * count].reshape(rows, count, columns, count).mean(axis=(1, 3))
    return shares > 0.5, count * resolution


class _Links:
    """The links between pieces.

    Attributes:
        near: see `Net`.
        times: see `Net.links`.
    """

    def __init__(self, context: Context, parts: Sequence[Array], is_open: bool) -> None:
        """Find the straight ones.

        Args:
            context: where the robot can stand.
            parts: the pieces, float64 (any, 2) [m] each; the first are START and GOAL.
            is_open: whether a tour may end anywhere.
        """
        self._context, self._parts = context, parts
        points = np.array([Variant([part], False).ends() for part in parts])
        self._ends = points[:, [0, 3]].reshape(-1, 2)
        left = headings(points[:, [1, 2]].reshape(-1, 2), self._ends)
        near = nearest(spatial.cKDTree(self._ends), self._ends, NEAR, FARTHEST)
        ground, config = self._context.ground, self._context.config
        self._needed = plain(needed(ground, BESIDE))
        self.near, self.times = compiled_pieces.links(
            self._ends, left, near, ground.clearance, ground.plan.origin, ground.plan.resolution, self._needed,
            plain(Pace(TRANSIT, config.speed, config.transit_speed, BENT, TURN_RATE, STOP)))
        if is_open:
            self.times[:, 2 * GOAL:2 * GOAL + 2] = self.times[2 * GOAL:2 * GOAL + 2] = 0.0

    def add_known(self, tour: Array) -> None:
        """Add those of a tour, also around corners."""
        for one, other in zip((tour[:-1] ^ 1).tolist(), tour[1:].tolist()):
            if self.times[one, other] < FAR:
                continue
            way = paths.between(self._context.ground, self._ends[one], self._ends[other])
            if way is not None:
                time = float(lengths_along(way)[-1]) / self._context.config.transit_speed
                self.times[one, other] = self.times[other, one] = time

    def legs(self, tour: Array) -> Iterator[Tuple[Optional[Array], Array]]:
        """The way to each piece of a tour, if it is straight, and the piece: float64 (any, 2) [m] each."""
        for before, entry in zip((tour[:-2] ^ 1).tolist(), tour[1:-1].tolist()):
            path = self._parts[entry >> 1][::-1 if entry & 1 else 1]
            yield self._straight(self._ends[before], path[0]), path

    def _straight(self, start: Array, end: Array) -> Optional[Array]:
        """The straight way from a point (2) to another [m]; None if it is not free."""
        ground = self._context.ground
        if np.hypot(*(end - start)) < TOGETHER:
            return start[np.newaxis]
        is_free = sees(ground.clearance, ground.plan.origin, ground.plan.resolution, self._needed,
                       (start[0], start[1]), (end[0], end[1]))
        return np.stack([start, end]) if is_free else None
