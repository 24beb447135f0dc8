"""Where known floor ends and unknown floor begins that the robot may reach."""

from typing import List, Optional

import numpy as np
from scipy import ndimage

from rumba_cleaning.belief import paths
from rumba_cleaning.belief.context import Context
from rumba_cleaning.belief.ground import ALL_AROUND, Ground
from rumba_cleaning.route import Route
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.kernel import Array
from rumba_sim.model.maps.floor_plan import OCCUPIED, FloorPlan

LEAST = 0.1  # [m^2] of positions behind a frontier: smaller ones are seen when the robot cleans there; our choice
SEEN = 0.4  # [m] around a point to which the robot went to look; what is unknown there then stays unknown


def route_to_frontier(context: Context, pose: Pose, seen: List[Array]) -> Optional[Route]:
    """A route to the frontier with the shortest way there; None if there is none (Yamauchi, A Frontier-Based Approach
    for Autonomous Exploration, 1997).

    Args:
        context: with the plan as it is known now.
        pose: from which the route begins, map frame.
        seen: points (2) [m], map frame, at whose frontiers the robot was already.
    """
    ground = context.ground
    nodes = frontiers(ground, pose)
    if len(nodes) and seen:
        apart = ground.points(nodes)[:, None] - np.array(seen)
        nodes = nodes[(np.hypot(apart[..., 0], apart[..., 1]) > SEEN).all(axis=1)]
    if not len(nodes):
        return None
    lengths = paths.lengths_to(ground, pose.x, pose.y)[nodes[:, 0], nodes[:, 1]]
    path = paths.between(ground, np.array(pose[:2]), ground.points(nodes[[int(np.argmin(lengths))]])[0])
    return None if path is None else Route(path, np.full(len(path) - 1, context.config.transit_speed))


def frontiers(ground: Ground, pose: Pose) -> Array:
    """The nodes that the robot can reach beside such as it could stand at if all that is unknown were free.

    Returns:
        int (any, 2)
    """
    labels, _ = ndimage.label(ground.fits, ALL_AROUND)
    known = labels == labels[ground.standing_at(pose.x, pose.y)]
    is_met = ground.clearance < ground.plan.safe_clearance
    hoped = (_clearance_if_free(ground.plan) >= ground.reach) & ~known & ~is_met
    parts, _ = ndimage.label(hoped, ALL_AROUND)
    is_large = np.bincount(parts.ravel()) * ground.plan.resolution ** 2 >= LEAST
    is_large[0] = False
    return np.argwhere(known & ndimage.binary_dilation(is_large[parts], ALL_AROUND))


def _clearance_if_free(plan: FloorPlan) -> Array:
    """As `FloorPlan.safe_clearance`, if all unknown cells and those outside the plan were free."""
    occupied = np.pad(plan.occupancy == OCCUPIED, 1)
    touches = occupied[:-1, :-1] | occupied[:-1, 1:] | occupied[1:, :-1] | occupied[1:, 1:]
    return np.asarray(ndimage.distance_transform_edt(~touches) * plan.resolution)
