"""A route over stretches: region by region, with a tour in each toward the next one."""

from typing import Dict, Iterator, List, Optional, Sequence, Tuple

import numpy as np

from rumba_cleaning.belief.context import Context
from rumba_cleaning.planning.common.stretches import Stretch
from rumba_cleaning.planning.decompose.regions import distances, doors
from rumba_cleaning.planning.order import tour
from rumba_cleaning.planning.order.groups import Group, groups
from rumba_cleaning.planning.order.tour import Tour
from rumba_cleaning.planning.order.transit import route_over
from rumba_cleaning.planning.swaths.problem import Problem
from rumba_cleaning.route import Route
from rumba_sim.model.kernel import Array

# Our choice.
YIELD = 0.7  # share of a crumb that is swept in passing, about: small plans for more crumbs than the target needs
SPARE = 0.0005  # of coverage that is planned beyond the target, once the robot is past the lanes and rings
CULLS = 4  # rounds in which crumbs are left out that cost much time for their area: more make better choices


def through(problem: Problem, found: List[Stretch]) -> Optional[Route]:
    """A route over stretches between poses; of crumbs, only over as many as the target needs. None: there is none."""
    if not found:
        return None
    context, pose = problem.context, problem.pose
    tours = _tours(problem, groups(found, problem.effort.rounds > 0))
    if all(part.is_crumb for part in found):
        _cull(context, tours)
    return route_over(context, pose, _legs(tours))


def _tours(problem: Problem, parts: Sequence[Group]) -> List[Tuple[Group, Tour]]:
    """Groups of stretches in the order in which they are cleaned, with a tour in each toward the next one."""
    ground, speed, labels, end = (problem.context.ground, problem.context.config.transit_speed, problem.labels,
                                  problem.end)
    fixed = [problem.pose] if end is None else [problem.pose, end]
    places = np.array([*(part.middle() for part in parts), *(each[:2] for each in fixed)])
    of_fixed = [int(labels[ground.standing_at(each.x, each.y)]) for each in fixed]
    start = len(parts)
    seconds = distances(doors(ground, labels), places, [*(part.region for part in parts), *of_fixed]) / speed
    to_end = np.zeros(start + 1) if end is None else seconds[:start + 1, -1]
    visits = tour.order(np.column_stack([seconds[:start + 1, :start], to_end]))
    tours, here = [], places[start]
    for place, following in zip(visits, [*visits[1:], -1]):
        leave = None if following < 0 and end is None else places[following]
        tours.append((parts[place], Tour(ground, here, parts[place].stretches, leave, speed, problem.effort.tours)))
        here = tours[-1][1].end
    return tours


def _cull(context: Context, tours: List[Tuple[Group, Tour]]) -> None:
    """Leave out crumbs that cost most time for their area, as long as the target can be met without them."""
    swept = context.swept
    needed = (context.target_coverage + SPARE - swept.coverage) * swept.reachable_area / YIELD  # [m^2]
    for last in range(CULLS, 0, -1):
        rows: List[Tuple[float, float, int, int]] = []
        for number, (group, route) in enumerate(tours):
            for saved, index in route.saved():
                part = group.stretches[int(index)]
                rows.append((float(saved + part.delay) / part.area, part.area, number, int(index)))
        spare = (sum(row[1] for row in rows) - needed) / last
        dropped: Dict[int, List[int]] = {}
        for _, area, number, index in sorted(rows, key=lambda row: -row[0]):
            spare -= area
            if spare < 0.0:
                break
            dropped.setdefault(number, []).append(index)
        for number, indices in dropped.items():
            tours[number][1].leave_out(indices)


def _legs(tours: List[Tuple[Group, Tour]]) -> Iterator[Tuple[Optional[Array], Array]]:
    """The way to each stretch of tours, if it is known, and the path over that: float64 (any, 2) [m] each."""
    for group, route in tours:
        for number, leg in enumerate(route.legs()):
            path = group.stretches[leg.stretch].variants[leg.variant].path()
            yield leg.way if number > 0 else None, path
