"""Around an obstacle that was met, and back onto the route."""

from typing import List, Optional

import numpy as np

from rumba_cleaning.behaviours.follower import Route
from rumba_cleaning.belief.context import Context
from rumba_sim.model.geometry import Pose
from rumba_sim.model.kernel import Array

HORIZON = 6.0  # [m] of the route that are looked at; what is still in the way later is met later


def detour(context: Context, pose: Pose, rest: Route) -> Optional[Route]:
    """From a pose onto the rest of a route, around what is marked; None where none of it can be reached.

    Places of the route that an obstacle covers are left out.
    """
    ground = context.ground
    places: List[Array] = [np.array([pose[:2]])]
    speeds: List[Array] = []
    lengths = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(rest.places, axis=0).T))])
    is_on_route = False
    for index, place in enumerate(rest.places):
        here = places[-1][-1]
        if is_on_route and lengths[index] > HORIZON:
            places.append(rest.places[index:])
            speeds.append(rest.speeds[index - 1:])
            break
        if is_on_route and not ground.is_marked(here, place):
            places.append(place[np.newaxis])
            speeds.append(rest.speeds[index - 1:index])
            continue
        is_on_route = not ground.is_marked(place, place)
        way = ground.way(here, place) if is_on_route else None
        if way is None:
            is_on_route = False
            continue
        places.append(way[1:])
        speeds.append(np.full(len(way) - 1, context.config.speed))
    return Route(np.concatenate(places), np.concatenate(speeds)) if speeds else None
