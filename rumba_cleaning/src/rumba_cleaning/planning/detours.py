"""Detours from a route past the crumbs beside it."""

from typing import Dict, Iterator, List, NamedTuple

import numpy as np
from scipy import spatial

from rumba_cleaning.belief.context import Context
from rumba_cleaning.belief.swept import Swept
from rumba_cleaning.planning import compiled_detours
from rumba_cleaning.planning.crumbs import crumbs
from rumba_cleaning.planning.paper import stride_counts, strides
from rumba_cleaning.planning.stretches import Stretch
from rumba_cleaning.planning.walls import Walls
from rumba_cleaning.route import Route
from rumba_sim.model.kernel import Array
from rumba_sim.model.reachability import SLACK

# All figures are our choice; each comment says what speaks for a larger and for a smaller value.
SURPLUS = 0.005  # of coverage that is planned beyond the target, since no robot drives exactly as planned
APART = 0.1  # [m] between the waypoints at which a detour may begin, at most: small makes detours shorter
# [m] that a detour takes for each [m^2], at most: ten times as long as a lane. Such a detour cleans little, since the
# robot cuts its corners. Large meets high targets, small leaves more to the next route.
DEAREST = 60.0
FARTHEST = 0.6  # [m] from the route to a crumb: large meets high targets, small leaves more to the next route
TRIES = 10  # waypoints from which a straight line to a crumb is looked for, at most: saves time
CORNER = 0.1  # [m] that each rad of a corner counts: 0.3 s at the cleaning speed


class Detour(NamedTuple):
    """A path past a crumb."""

    waypoint: int  # index of the one of the route from which it begins; it ends at the next one
    path: Array  # float64 (any, 2) [m]
    length: float  # [m] that it makes the route longer, corners included
    area: float  # [m^2] that it cleans


def with_crumbs(context: Context, walls: Walls, route: Route, paper: Swept, around: Array, labels: Array) -> Route:
    """A route with detours to crumbs that it would leave, no more than the target needs: those that cost least.

    Args:
        context: where the robot can stand, and the target.
        walls: of the ground of the context.
        route: without detours.
        paper: what is swept after it.
        around: the cells that the robot can sweep, bool (rows, columns).
        labels: the region of each node, int (rows + 1, columns + 1).
    """
    missing = (context.target_coverage + SURPLUS - paper.coverage) * paper.reachable_area  # [m^2]
    route = _dense(route)
    found = _detours(context, route, crumbs(context.ground, walls, paper.missing_share() * around, labels))
    chosen: Dict[int, Detour] = {}
    for detour in sorted(found, key=lambda detour: detour.length / detour.area):
        if missing <= 0.0 or detour.length > DEAREST * detour.area:
            break
        if detour.waypoint not in chosen:
            chosen[detour.waypoint] = detour
            missing -= detour.area
    waypoints: List[Array] = []
    speeds: List[Array] = []
    last = 0
    for index in sorted(chosen):
        path = chosen[index].path
        waypoints += [route.waypoints[last:index + 1], path]
        speeds += [route.speeds[last:index], np.full(len(path) + 1, context.config.speed)]
        last = index + 1
    return Route(np.concatenate([*waypoints, route.waypoints[last:]]), np.concatenate([*speeds, route.speeds[last:]]))


def _dense(route: Route) -> Route:
    """A route with waypoints that are not far apart."""
    return Route(strides(route.waypoints, APART), np.repeat(route.speeds, stride_counts(route.waypoints, APART)))


def _detours(context: Context, route: Route, found: List[Stretch]) -> Iterator[Detour]:
    """The shortest detour past each crumb that is near to a part of the route on which the robot cleans."""
    begins = np.flatnonzero(route.speeds <= context.config.speed)
    if len(begins) == 0:
        return
    tree = spatial.cKDTree(route.waypoints[begins])
    ground = context.ground
    for crumb in found:
        distances, near = tree.query(crumb.variants[0].path()[0], TRIES, distance_upper_bound=FARTHEST)
        paths = [variant.path() for variant in crumb.variants]
        length, waypoint, number = compiled_detours.shortest(
            ground.clearance, ground.plan.origin, ground.plan.resolution, ground.reach + SLACK, route.waypoints,
            begins[near[np.isfinite(distances)]], np.concatenate(paths), np.cumsum([0, *map(len, paths)]), CORNER)
        if np.isfinite(length):
            yield Detour(waypoint, paths[number], length, crumb.area)
