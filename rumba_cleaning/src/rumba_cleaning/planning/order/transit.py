"""Routes over paths, with the ways between them."""

from typing import Iterable, Optional, Tuple

import numpy as np

from rumba_cleaning.belief import paths
from rumba_cleaning.belief.context import Context
from rumba_cleaning.route import Route
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.kernel import Array

# Our choice.
TRANSIT = 0.5  # [m] of a way between two paths: a longer one is driven at the speed of transit, ...
SLOW = 0.15  # [m] ... except for its end: the robot has slowed down and lowered the brushes before its path begins


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
