"""Plans how to clean what was missed: region by region, along the walls, in lanes or in rings, and then the crumbs."""

from typing import List, Optional

import numpy as np

from rumba_cleaning.belief.context import Context
from rumba_cleaning.planning.common.effort import effort
from rumba_cleaning.planning.decompose.regions import regions, shapes
from rumba_cleaning.planning.decompose.turned_floor import main_direction
from rumba_cleaning.planning.order.route import through
from rumba_cleaning.planning.rectangle import spiral_over
from rumba_cleaning.planning.search.improvement import improved
from rumba_cleaning.planning.swaths.drafting import choices, drafted
from rumba_cleaning.planning.swaths.problem import Problem, need
from rumba_cleaning.planning.swaths.rings import outlines
from rumba_cleaning.route import Route
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.kernel import Array

# Our choice.
MOST = 0.5  # share of what was missed that lanes, rings and large crumbs must clean, for them to be driven
YIELD = 0.55  # share of a crumb that is swept in passing, about: small plans for more crumbs than the target needs
BEYOND = 0.03  # [m] from what the brush reaches, where an obstacle may leave more floor free than the robot knows


def plan(context: Context, pose: Pose, end: Optional[Pose] = None) -> Optional[Route]:
    """A route that cleans what was missed; None if nothing was missed, or none of it can be reached.

    An empty rectangle is swept in a spiral. Elsewhere, as long as lanes and rings clean most of it, the route leads
    over these, and is improved by rehearsal. The routes after that know where the robot really drove, and visit crumb
    after crumb, as many as the target needs; if no obstacles were met, they are improved too.

    Args:
        context: with the floor that was swept before; it is not changed.
        pose: from which the route begins, map frame.
        end: near which it should end; None: anywhere.
    """
    spiral = spiral_over(context, pose) if end is None else None
    if spiral is not None:
        return spiral
    problem = posed(context, pose, end)
    routes = drafts(problem)
    if not routes:
        return _over_crumbs(problem)
    return routes[0] if problem.effort.rounds == 0 else improved(problem, routes)


def posed(context: Context, pose: Pose, end: Optional[Pose] = None) -> Problem:
    """What all stages of a plan go by: see `plan` for the arguments."""
    ground = context.ground
    labels = regions(ground)
    return Problem(context, pose, end, _around(context, pose), labels, shapes(ground, labels),
                   main_direction(outlines(ground)), effort(context))


def drafts(problem: Problem) -> List[Route]:
    """Routes of drafts that clean most of what was missed; none, if that is little."""
    swept, area = problem.context.swept, problem.context.swept.reachable_area
    missing = float((swept.missing_share() * problem.around).sum()) * problem.context.plan.resolution ** 2
    found = []
    for draft in drafted(problem, choices(problem)):
        is_much = draft.paper.coverage - swept.coverage > MOST * missing / area
        route = through(problem, draft.stretches) if is_much else None
        if route is not None:
            found.append(route)
    return found


def _around(context: Context, pose: Pose) -> Array:
    """The cells that a robot at a pose can sweep beside the obstacles it met, about: bool (rows, columns)."""
    ground = context.ground
    if not ground.has_marks:
        return np.ones(ground.plan.occupancy.shape, bool)
    return ground.around(pose.x, pose.y, 0.5 * context.robot.brush.width + BEYOND)


def _over_crumbs(problem: Problem) -> Optional[Route]:
    """A route that visits the largest crumbs, as many as the target needs; None if there are none in reach.

    Beside obstacles that the robot met, no rehearsal would be true: how large they are is known by a few contacts.
    """
    context = problem.context
    found = sorted(problem.crumbs(context.swept), key=lambda part: -part.area)
    area = np.cumsum([YIELD * part.area for part in found])
    route = through(problem, found[:int(np.searchsorted(area, need(context, context.swept))) + 1])
    if route is None or problem.effort.rounds == 0 or context.ground.has_marks:
        return route
    return improved(problem, [route])
