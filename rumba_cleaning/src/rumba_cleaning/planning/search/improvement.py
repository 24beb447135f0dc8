"""Improves routes by edits until they meet the target, and take less time."""

from typing import Sequence, Set, Tuple

from rumba_cleaning.belief.context import Context
from rumba_cleaning.belief.swept import Swept
from rumba_cleaning.planning.search.detours import detours
from rumba_cleaning.planning.search.edits import applied, chosen, dense
from rumba_cleaning.planning.search.shifts import shifts
from rumba_cleaning.planning.search.shortcuts import shortcuts
from rumba_cleaning.planning.simulate.edit import Edit
from rumba_cleaning.planning.simulate.rehearsal import Rehearsal
from rumba_cleaning.planning.swaths.problem import Problem
from rumba_cleaning.route import Route

# All figures are our choice; each comment says what speaks for a larger and for a smaller value.
SURPLUS = 0.005  # of coverage that is planned beyond the target on paper, since no robot drives exactly as planned ...
# [m^2] ... and by rehearsal, for each rad that the robot turns, since it drives each turn a little otherwise than
# rehearsed: large sweeps too much, small may need another route for a few last spots.
MARGIN = 0.00006
EDITED = 0.0004  # of coverage that edits are to bring beyond that: together they bring a little less than one by one
MENDS = 2  # times that detours are added, at most, to a route that edits left short of the target: that takes little
# [s/m^2] a lane takes 20: dearer edits are left out on paper, where they clean less than it seems, and by rehearsal.
DEAREST_ON_PAPER, DEAREST = 200.0, 3000.0
LEAST_ON_PAPER = 0.005  # [m^2] of a crumb: a smaller one is hardly ever worth that price; large plans faster
# [s/m^2] that edits save for what they leave, if there is more than the target needs, and take for what is missing.
SAVED, ADDED = 120.0, 600.0
CHEAP = 0.8  # share of the last price that a shortcut must save to be judged: small tries more
SHORTCUTS = 1500  # that are judged in a round, at most


def with_detours(problem: Problem, route: Route, paper: Swept) -> Route:
    """A route with detours, so that it meets the target on paper, where that was swept after it."""
    route, need = dense(route), problem.need(paper, SURPLUS)
    if need <= 0.0:
        return route
    edits, _ = chosen(detours(problem, route, paper, LEAST_ON_PAPER), need, DEAREST_ON_PAPER)
    return applied(route, edits, problem.context.config.speed)


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
        shifted = shifts(context, rehearsal.route) if problem.effort.is_thorough else []
        found = [*shortcuts(context, rehearsal, CHEAP * price)[:SHORTCUTS], *shifted,
                 *detours(problem, rehearsal.route, rehearsal.swept)]
        rehearsal, price = _edited(problem, rehearsal, found, poor)
        tried.append(rehearsal)
    for _ in range(MENDS):
        if not rehearsal.is_complete or is_met(context, rehearsal):
            break
        rehearsal, _ = _edited(problem, rehearsal, detours(problem, rehearsal.route, rehearsal.swept), set())
        tried.append(rehearsal)
    return max(tried, key=lambda rehearsal: _merit(problem, rehearsal)).route


def is_met(context: Context, rehearsal: Rehearsal) -> bool:
    """Whether a route meets the target, even if its rehearsal errs by MARGIN."""
    missing = (context.target_coverage - rehearsal.swept.coverage) * context.swept.reachable_area
    return missing + MARGIN * rehearsal.turned <= 0.0


def _edited(problem: Problem, rehearsal: Rehearsal, found: Sequence[Edit],
            poor: Set[bytes]) -> Tuple[Rehearsal, float]:
    """A rehearsal of the route with those of some edits that have it meet the target; their price [s/m^2].

    Poor edits are not judged again, although the route beside them may have changed; what turns out poor is added.
    """
    context, route = problem.context, rehearsal.route
    fresh = [edit for edit in found if edit.place(route) not in poor]
    judged = rehearsal.judged(fresh)
    edits, price = chosen(judged, _need(problem, rehearsal, EDITED), DEAREST)
    poor.update({edit.place(route) for edit in fresh} - {edit.place(route) for edit in judged if edit.is_near(price)})
    return Rehearsal(context, problem.pose, dense(applied(route, edits, context.config.speed))), price


def _cost(problem: Problem, rehearsal: Rehearsal) -> float:
    """The time that a route will take, about, once edits have it meet the target [s]."""
    need = _need(problem, rehearsal)
    return rehearsal.seconds + need * (ADDED if need > 0.0 else SAVED)


def _need(problem: Problem, rehearsal: Rehearsal, surplus: float = 0.0) -> float:
    """Area that is missing to the target, to a surplus of coverage and to what a rehearsal may be wrong by [m^2]."""
    return problem.need(rehearsal.swept, surplus) + MARGIN * rehearsal.turned


def _merit(problem: Problem, rehearsal: Rehearsal) -> Tuple[bool, float]:
    """Compares rehearsals: the quickest one that meets the target, or that which comes nearest to it."""
    meets = is_met(problem.context, rehearsal)
    return meets, -rehearsal.seconds if meets else rehearsal.swept.coverage
