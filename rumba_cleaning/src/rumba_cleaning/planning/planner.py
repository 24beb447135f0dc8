"""Plans how to clean what was missed: room by room, along the walls, in lanes between them, then the crumbs."""

from typing import Dict, List, Optional

import numpy as np

from rumba_cleaning.behaviours.follower import Route
from rumba_cleaning.belief.context import Context
from rumba_cleaning.belief.ground import Ground
from rumba_cleaning.planning.crumbs import crumbs, with_crumbs
from rumba_cleaning.planning.lanes import cells
from rumba_cleaning.planning.links import cell_manners
from rumba_cleaning.planning.regions import rooms
from rumba_cleaning.planning.tour import Stretch, tour
from rumba_cleaning.planning.turned_floor import main_direction
from rumba_cleaning.planning.walls import Wall, walls
from rumba_sim.model.geometry import Pose
from rumba_sim.model.kernel import Array

ENTRIES = 16  # places of a closed way at which it may be begun, at most ...
APART = 10  # ... and so many of its places apart, at least

Rooms = Dict[int, List[Stretch]]


def plan(context: Context, pose: Pose) -> Optional[Route]:
    """A route from a pose that cleans what was missed; None where there is nothing that can be.

    It passes crumbs only as far as they are needed for the target.
    """
    ground, brush = context.ground, context.robot.brush.width
    start = np.array([pose.x, pose.y])
    labels = rooms(ground)
    missed = context.swept.missed() & ground.within(0.5 * brush)
    found: Rooms = {}
    for wall in walls(ground, missed, labels, brush):
        found.setdefault(wall.room, []).append(Stretch(_manners(wall)))
    angle = main_direction(ground)
    for label, part in _by_room(ground, missed, labels).items():
        for cell in cells(ground, part, brush, context.config.speed, angle):
            found.setdefault(label, []).append(Stretch(cell_manners(ground, cell.lanes)))
    if found:
        return with_crumbs(context, _route(context, start, found))
    for crumb in crumbs(ground, context.swept.missed() & ground.within(0.5 * brush)):
        room = int(labels[ground.node(*crumb.places[0])])
        found.setdefault(room, []).append(Stretch([crumb.places]))
    return _route(context, start, found)


def _manners(wall: Wall) -> List[Array]:
    """Either way along a wall; around an island from many places."""
    if not wall.is_closed:
        return [wall.places, wall.places[::-1]]
    turned = [np.concatenate([wall.places[index:-1], wall.places[:index + 1]])
              for index in range(0, len(wall.places) - 1, max(APART, len(wall.places) // ENTRIES))]
    return turned + [places[::-1] for places in turned]


def _by_room(ground: Ground, missed: Array, labels: Array) -> Dict[int, Array]:
    """What was missed in each room: bool (rows, columns)."""
    indices = np.argwhere(missed)
    nodes = ground.standing(indices)
    of_cells = np.zeros(missed.shape, labels.dtype)
    of_cells[missed] = labels[nodes[:, 0], nodes[:, 1]]
    return {int(label): missed & (of_cells == label) for label in np.unique(of_cells[missed])}


def _route(context: Context, start: Array, found: Rooms) -> Optional[Route]:
    """Through all rooms; what cannot be reached is left out."""
    if not found:
        return None
    config, ground = context.config, context.ground
    places, speeds = [start[np.newaxis]], []
    doors = {room: _middle(stretches) for room, stretches in found.items()}
    order = [list(doors)[index] for index, _ in tour(ground, start, [Stretch([door]) for door in doors.values()])]
    for room, following in zip(order, [*order[1:], None]):
        end = doors[following][0] if following is not None else None
        for index, manner in tour(ground, places[-1][-1], found[room], end):
            stretch = found[room][index].manners[manner]
            way = ground.way(places[-1][-1], stretch[0])
            if way is not None:
                places += [way[1:], stretch[1:]]
                speeds += [np.full(len(way) - 1, config.transit_speed), np.full(len(stretch) - 1, config.speed)]
    return Route(np.concatenate(places), np.concatenate(speeds)) if speeds else None


def _middle(stretches: List[Stretch]) -> Array:
    """The entry of stretches that is nearest to their middle: float64 (1, 2)."""
    entries = np.array([manner[0] for stretch in stretches for manner in stretch.manners])
    return entries[[int(np.argmin(np.hypot(*(entries - entries.mean(axis=0)).T)))]]
