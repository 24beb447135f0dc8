"""Plans how to clean what was missed: region by region, along the walls, in lanes between them, and then the crumbs."""

from typing import Dict, List, Optional

import numpy as np

from rumba_cleaning.behaviours.follower import Route
from rumba_cleaning.belief.context import Context
from rumba_cleaning.belief.ground import Ground
from rumba_cleaning.planning.crumbs import crumbs, with_crumbs
from rumba_cleaning.planning.lanes import blocks
from rumba_cleaning.planning.links import block_variants
from rumba_cleaning.planning.regions import regions
from rumba_cleaning.planning.tour import Stretch, tour
from rumba_cleaning.planning.turned_floor import main_direction
from rumba_cleaning.planning.walls import Wall, walls
from rumba_sim.model.geometry import Pose
from rumba_sim.model.kernel import Array

# Our choice: more entries into a closed path give shorter tours, and take more time to compare.
ENTRIES = 16  # waypoints at which a closed path may begin, at most, ...
APART = 10  # ... and at least every so many waypoints: 0.2 m apart

Stretches = Dict[int, List[Stretch]]  # by the label of their region


def plan(context: Context, pose: Pose) -> Optional[Route]:
    """A route that cleans what was missed; None if nothing was missed, or none of it can be reached.

    It visits only as many crumbs as the target needs.

    Args:
        context: with the floor that was swept before; it is not changed.
        pose: from which the route begins, map frame.
    """
    ground, brush = context.ground, context.robot.brush.width
    start = np.array([pose.x, pose.y])
    labels = regions(ground)
    missed = context.swept.missed() & ground.within(0.5 * brush)
    found: Stretches = {}
    for wall in walls(ground, missed, labels, brush):
        found.setdefault(wall.region, []).append(Stretch(_wall_variants(wall)))
    angle = main_direction(ground)
    for region, part in _by_region(ground, missed, labels).items():
        for block in blocks(ground, part, brush, context.config.speed, angle):
            found.setdefault(region, []).append(Stretch(block_variants(ground, block.lanes)))
    if found:
        return with_crumbs(context, _route(context, start, found))
    for crumb in crumbs(ground, context.swept.missed() & ground.within(0.5 * brush)):
        region = int(labels[ground.node(*crumb.waypoints[0])])
        found.setdefault(region, []).append(Stretch([crumb.waypoints]))
    return _route(context, start, found)


def _wall_variants(wall: Wall) -> List[Array]:
    """The paths along a wall, in both directions: float64 (any, 2) [m] each; a closed one begins at many points."""
    if not wall.is_closed:
        return [wall.waypoints, wall.waypoints[::-1]]
    step = max(APART, len(wall.waypoints) // ENTRIES)
    rotated = [np.concatenate([wall.waypoints[index:-1], wall.waypoints[:index + 1]])
               for index in range(0, len(wall.waypoints) - 1, step)]
    return rotated + [path[::-1] for path in rotated]


def _by_region(ground: Ground, missed: Array, labels: Array) -> Dict[int, Array]:
    """The cells to clean in each region: bool (rows, columns) each."""
    indices = np.argwhere(missed)
    nodes = ground.standing(indices)
    of_cells = np.zeros(missed.shape, labels.dtype)
    of_cells[missed] = labels[nodes[:, 0], nodes[:, 1]]
    return {int(label): missed & (of_cells == label) for label in np.unique(of_cells[missed])}


def _route(context: Context, start: Array, found: Stretches) -> Optional[Route]:
    """The route through all regions from a point (2) [m]; it leaves out what cannot be reached."""
    if not found:
        return None
    config, ground = context.config, context.ground
    waypoints, speeds = [start[np.newaxis]], []
    entries = {region: _middle_entry(stretches) for region, stretches in found.items()}
    order = [list(entries)[index]
             for index, _ in tour(ground, start, [Stretch([entry]) for entry in entries.values()])]
    for region, following in zip(order, [*order[1:], None]):
        end = entries[following][0] if following is not None else None
        for index, variant in tour(ground, waypoints[-1][-1], found[region], end):
            stretch = found[region][index].variants[variant]
            path = ground.path(waypoints[-1][-1], stretch[0])
            if path is not None:
                waypoints += [path[1:], stretch[1:]]
                speeds += [np.full(len(path) - 1, config.transit_speed), np.full(len(stretch) - 1, config.speed)]
    return Route(np.concatenate(waypoints), np.concatenate(speeds)) if speeds else None


def _middle_entry(stretches: List[Stretch]) -> Array:
    """The first point of a variant that is nearest to the mean of all these points: float64 (1, 2) [m]."""
    entries = np.array([variant[0] for stretch in stretches for variant in stretch.variants])
    return entries[[int(np.argmin(np.hypot(*(entries - entries.mean(axis=0)).T)))]]
