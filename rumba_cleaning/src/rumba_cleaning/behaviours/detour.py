"""Around an obstacle that was met, and back onto the route."""

from typing import List, Optional

import numpy as np

from rumba_cleaning.belief import paths
from rumba_cleaning.belief.context import Context
from rumba_cleaning.route import Route, lengths_along
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.kernel import Array

HORIZON = 6.0  # [m] of the route that are looked at: longer than a lane and a turn; the rest is looked at if it is met


def detour(context: Context, pose: Pose, rest: Route) -> Optional[Route]:
    """A route from a pose onto the rest of another route, around what is marked; None if no path leads to any of it.

    It leaves out waypoints that an obstacle covers.
    """
    ground = context.ground
    parts: List[Array] = [np.array([pose[:2]])]
    speeds: List[Array] = []
    lengths = lengths_along(rest.waypoints)
    is_on_route = False
    for index, waypoint in enumerate(rest.waypoints):
        here = parts[-1][-1]
        if is_on_route and lengths[index] > HORIZON:
            parts.append(rest.waypoints[index:])
            speeds.append(rest.speeds[index - 1:])
            break
        if is_on_route and not ground.is_marked(here, waypoint):
            parts.append(waypoint[np.newaxis])
            speeds.append(rest.speeds[index - 1:index])
            continue
        is_on_route = not ground.is_marked(waypoint, waypoint)
        path = paths.between(ground, here, waypoint) if is_on_route else None
        if path is None:
            is_on_route = False
            continue
        parts.append(path[1:])
        speeds.append(np.full(len(path) - 1, context.config.speed))
    return Route(np.concatenate(parts), np.concatenate(speeds)) if speeds else None
