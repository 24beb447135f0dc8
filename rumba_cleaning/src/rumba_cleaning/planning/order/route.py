"""A route over stretches: region by region, with a tour in each toward the next one."""

from typing import Dict, Iterable, Iterator, List, Optional, Sequence, Tuple

import numpy as np

from rumba_cleaning.belief import paths
from rumba_cleaning.belief.context import Context
from rumba_cleaning.planning.common.stretches import Stretch
from rumba_cleaning.planning.decompose.regions import distances
from rumba_cleaning.planning.order import tour
from rumba_cleaning.planning.order.tour import Tour
from rumba_cleaning.planning.swaths.problem import Problem
from rumba_cleaning.route import Route
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.kernel import Array

# Our choice.
TRANSIT = 0.5  # [m] of a way between two paths: a longer one is driven at the speed of transit, ...
SLOW = 0.15  # [m] ... except for its end: the robot has slowed down and lowered the brushes before its path begins
# Variants of stretches in a group, and in each part of a region that has more: the time for a tour grows with their
# square and more, but from part to part the robot drives farther. By halls of up to 3,500 m2 with pillars or chairs.
MANY, MOST = 1500, 350


def through(problem: Problem, found: List[Stretch]) -> Optional[Route]:
    """A route over stretches between poses; None: there is none."""
    if not found:
        return None
    return route_over(problem.context, problem.pose, _legs(problem, groups(found, problem.effort.rounds > 0)))


def _legs(problem: Problem, parts: Sequence[List[Stretch]]) -> Iterator[Tuple[Optional[Array], Array]]:
    """The way to each stretch, if it is known, and the path over that, float64 (any, 2) [m] each; group by group."""
    ground, speed, end = problem.context.ground, problem.context.config.transit_speed, problem.end
    fixed = [problem.pose] if end is None else [problem.pose, end]
    places = np.array([*(_middle(part) for part in parts), *(each[:2] for each in fixed)])
    start = len(parts)
    seconds = distances(ground, problem.labels, places) / speed
    to_end = np.zeros(start + 1) if end is None else seconds[:start + 1, -1]
    visits = tour.order(np.column_stack([seconds[:start + 1, :start], to_end]))
    here = places[start]
    for place, following in zip(visits, [*visits[1:], -1]):
        toward = None if following < 0 and end is None else places[following]
        made = Tour(ground, here, parts[place], toward, speed, problem.effort.tours)
        for leg in made.legs():
            yield leg.way, parts[place][leg.stretch].variants[leg.variant].path()
        here = made.end


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


def groups(found: Sequence[Stretch], across: bool = False) -> List[List[Stretch]]:
    """Stretches in groups, in the order of the first of each region.

    Args:
        found: the stretches.
        across: whether they may be one group, if they are few, so that a tour leads to and fro between regions.
    """
    if across and sum(len(part.variants) for part in found) <= MANY:
        return [list(found)]
    by_region: Dict[int, List[Stretch]] = {}
    for part in found:
        by_region.setdefault(part.region, []).append(part)
    return [part for stretches in by_region.values() for part in _parts(stretches, MANY)]


def _parts(stretches: List[Stretch], most: int) -> List[List[Stretch]]:
    """Stretches as they are, if they have at most so many variants; or halves of them, side by side, and so on."""
    counts = np.array([len(stretch.variants) for stretch in stretches])
    if len(stretches) < 2 or counts.sum() <= most:
        return [stretches]
    middles = 0.5 * (_entries(stretches) + np.array([stretch.variants[0].ends()[3] for stretch in stretches]))
    along = int(np.argmax(np.ptp(middles, axis=0)))
    order = np.argsort(middles[:, along], kind='stable')
    half = int(np.searchsorted(np.cumsum(counts[order]), 0.5 * counts.sum()))
    half = min(max(half, 1), len(stretches) - 1)
    return [part for indices in (order[:half], order[half:])
            for part in _parts([stretches[index] for index in np.sort(indices)], MOST)]


def _middle(stretches: Sequence[Stretch]) -> Array:
    """The first waypoint of a stretch that is nearest to the mean of all these: float64 (2) [m]."""
    entries = _entries(stretches)
    return np.asarray(entries[int(np.argmin(np.hypot(*(entries - entries.mean(axis=0)).T)))])


def _entries(stretches: Sequence[Stretch]) -> Array:
    """The first waypoint of each stretch: float64 (any, 2) [m]."""
    return np.array([stretch.variants[0].ends()[0] for stretch in stretches])
