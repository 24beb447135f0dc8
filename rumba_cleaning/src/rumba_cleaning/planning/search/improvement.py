"""Improves routes by edits until they meet the target, and take less time."""

from typing import Sequence, Set, Tuple

from rumba_cleaning.belief.context import Context
from rumba_cleaning.planning.search.edits import applied, chosen, dense
from rumba_cleaning.planning.search.shifts import shifts
from rumba_cleaning.planning.search.shortcuts import shortcuts
from rumba_cleaning.planning.simulate.rehearsal import Edit, Rehearsal
from rumba_cleaning.planning.swaths.problem import Problem, need
from rumba_cleaning.route import Route
from rumba_sim.model.common.geometry import hypot

# All figures are our choice; each comment says what speaks for a larger and for a smaller value.
# [m^2] planned beyond the target for each rad that the robot turns, since it drives each turn a little otherwise than
# rehearsed: large sweeps too much, small may need another route for a few last spots.
MARGIN = 0.00006
EDITED = 0.0004  # of coverage that edits are to bring beyond that: together they bring a little less than one by one
DEAREST = 3000.0  # [s/m^2] a lane takes 20: edits that are dearer are not made
# [s/m^2] that edits save for what they leave, if there is more than the target needs, and take for what is missing.
SAVED, ADDED = 120.0, 600.0
CHEAP = 0.8  # share of the last price that a shortcut must save to be judged: small tries more
SHORTCUTS = 1500  # that are judged in a round, at most


def improved(problem: Problem, routes: Sequence[Route]) -> Route:
    """The best of several routes, edited so that it meets the target by rehearsal in little time.

    Args:
        problem: for which the routes are.
        routes: drafts.
    """
    context = problem.context
    rehearsal = min((Rehearsal(context, problem.pose, dense(route)) for route in routes),
                    key=lambda rehearsal: _cost(problem, rehearsal))
    tried, price = [rehearsal], SAVED
    poor: Set[bytes] = set()  # edits, by their places, that were far from worth it when they were judged
    for _ in range(problem.effort.rounds):
        if not rehearsal.is_complete:
            break
        found = [*shortcuts(context, rehearsal, CHEAP * price)[:SHORTCUTS], *shifts(context, rehearsal.route)]
        rehearsal, price = _edited(problem, rehearsal, found, poor)
        tried.append(rehearsal)
    met = [each for each in tried if _need(context, each) <= 0.0]
    best = min(met, key=lambda each: each.seconds) if met else max(tried, key=lambda each: each.swept.coverage)
    return best.route


def _edited(problem: Problem, rehearsal: Rehearsal, found: Sequence[Edit],
            poor: Set[bytes]) -> Tuple[Rehearsal, float]:
    """A rehearsal of the route with those of some edits that have it meet the target; their price [s/m^2].

    Poor edits are not judged again, although the route beside them may have changed; what turns out poor is added.
    """
    context, route = problem.context, rehearsal.route
    fresh = [edit for edit in found if edit.place(route) not in poor]
    judged = rehearsal.judged(fresh)
    edits, price = chosen(judged, _need(context, rehearsal, EDITED), DEAREST)
    poor.update({edit.place(route) for edit in fresh} - {edit.place(route) for edit in judged if edit.is_near(price)})
    return Rehearsal(context, problem.pose, dense(applied(route, edits, context.config.speed))), price


def _cost(problem: Problem, rehearsal: Rehearsal) -> float:
    """The time that a route will take, about, with the way to where it should end, once it meets the target [s]."""
    need, metres = _need(problem.context, rehearsal), 0.0
    if problem.end is not None:
        x, y = rehearsal.route.waypoints[-1]
        metres = hypot(problem.end.x - x, problem.end.y - y)
    return rehearsal.seconds + metres / problem.context.config.transit_speed + need * (ADDED if need > 0.0 else SAVED)


def _need(context: Context, rehearsal: Rehearsal, surplus: float = 0.0) -> float:
    """Area that is missing to the target, to a surplus of coverage and to what a rehearsal may be wrong by [m^2]."""
    return need(context, rehearsal.swept, surplus) + MARGIN * rehearsal.turned
