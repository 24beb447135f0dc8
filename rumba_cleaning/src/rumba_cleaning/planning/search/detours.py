"""Detours from a route past the crumbs beside it."""

from typing import List

import numpy as np
from scipy import spatial

from rumba_cleaning.belief.swept import Swept
from rumba_cleaning.planning.common.compiled_ways import NONE
from rumba_cleaning.planning.common.lines import needed
from rumba_cleaning.planning.common.nearest import nearest
from rumba_cleaning.planning.search import compiled_detours
from rumba_cleaning.planning.simulate.edit import Edit
from rumba_cleaning.planning.swaths.problem import Problem
from rumba_cleaning.route import Route
from rumba_sim.model.compiling.jit import plain

# All figures are our choice; each comment says what speaks for a larger and for a smaller value.
FARTHEST = 0.6  # [m] from the route to a crumb: large meets high targets, small leaves more to the next route
TRIES = 10  # waypoints from which a straight line to a crumb is looked for, at most: saves time
CORNER = 0.1  # [m] that each rad of a corner counts: 0.3 s at the cleaning speed


def detours(problem: Problem, route: Route, swept: Swept, least: float = 0.0) -> List[Edit]:
    """The shortest detour past each crumb that is near to a part of the route on which the robot cleans.

    Args:
        problem: what the route is for.
        route: with waypoints that are not far apart.
        swept: the floor after it.
        least: area of a crumb that is visited, at least [m^2].

    Returns:
        with what each costs and brings on paper.
    """
    context = problem.context
    begins = np.flatnonzero(route.speeds <= context.config.speed)
    if len(begins) == 0:
        return []
    tree = spatial.cKDTree(route.waypoints[begins])
    ground = context.ground
    edits = []
    for crumb in problem.crumbs(swept, least):
        near = nearest(tree, crumb.variants[0].path()[:1], TRIES, FARTHEST)[0]
        paths = [variant.path() for variant in crumb.variants]
        length, waypoint, number = compiled_detours.shortest(
            ground.clearance, ground.plan.origin, ground.plan.resolution, plain(needed(ground)), route.waypoints,
            begins[near[near != NONE]], np.concatenate(paths), np.cumsum([0, *map(len, paths)]), CORNER)
        if np.isfinite(length):
            edits.append(Edit(waypoint, waypoint + 1, paths[number], length / context.config.speed, crumb.area))
    return edits
