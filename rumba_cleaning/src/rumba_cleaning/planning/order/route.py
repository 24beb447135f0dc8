"""A route over stretches: region by region, with a tour in each toward the next one."""

from typing import Iterable, Iterator, List, Optional, Sequence, Tuple

import numpy as np

from rumba_cleaning.belief import paths
from rumba_cleaning.belief.context import Context
from rumba_cleaning.planning.common.stretches import Stretch
from rumba_cleaning.planning.decompose.regions import distances, doors
from rumba_cleaning.planning.order import tour
from rumba_cleaning.planning.order.groups import Group, groups
from rumba_cleaning.planning.order.tour import Tour
from rumba_cleaning.planning.swaths.problem import Problem
from rumba_cleaning.route import Route
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.kernel import Array

# Our choice.
TRANSIT = 0.5  # [m] of a way between two paths: a longer one is driven at the speed of transit, ...
SLOW = 0.15  # [m] ... except for its end: the robot has slowed down and lowered the brushes before its path begins


def through(problem: Problem, found: List[Stretch]) -> Optional[Route]:
    """A route over stretches between poses; None: there is none."""
    if not found:
        return None
    return route_over(problem.context, problem.pose, _legs(_tours(problem, groups(found, problem.effort.rounds > 0))))


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


def _legs(tours: List[Tuple[Group, Tour]]) -> Iterator[Tuple[Optional[Array], Array]]:
    """The way to each stretch of tours, if it is known, and the path over that: float64 (any, 2) [m] each."""
    for group, route in tours:
        for number, leg in enumerate(route.legs()):
            path = group.stretches[leg.stretch].variants[leg.variant].path()
            yield leg.way if number > 0 else None, path


def route_over(context: Context, pose: Pose, legs: Iterable[Tuple[Optional[Array], Array]]) -> Optional[Route]:
    """The route over paths from a pose; it leaves out what cannot be reached. None: that is all of it.

    Args:
        context: where the robot can stand.
        pose: map frame.
        legs: the way from the end of the path before, if it is known, and a path: float64 (any, 2) [m] each.
    """
    config = context.config
    waypoints, speeds, is_there = [np.array([[pose.x, pose.y]])], [], True
    for way, path in legs:
        if way is None or not is_there:
            way = paths.between(context.ground, waypoints[-1][-1], path[0])
        is_there = way is not None
        if way is None:
            continue
        way, way_speeds = _with_speeds(way, config.speed, config.transit_speed)
        waypoints += [way[1:], path[1:]]
        speeds += [way_speeds, np.full(len(path) - 1, config.speed)]
    return Route(np.concatenate(waypoints), np.concatenate(speeds)) if speeds else None


def _with_speeds(way: Array, speed: float, transit_speed: float) -> Tuple[Array, Array]:
    """A way (any, 2) [m] between two paths, with the end of a long one apart, and the speeds on it [m/s]."""
    legs = np.hypot(*np.diff(way, axis=0).T)
    if legs.sum() <= TRANSIT:
        return way, np.full(len(legs), speed)
    fast = np.full(len(legs), transit_speed)
    if legs[-1] <= SLOW:
        return way, np.append(fast[:-1], speed)
    slow = way[-1] - SLOW / legs[-1] * (way[-1] - way[-2])
    return np.concatenate([way[:-1], [slow], way[-1:]]), np.append(fast, speed)
