"""Why a robot cannot drive from one part of a floor to another, and where it comes nearest to that."""

import enum
from typing import List, NamedTuple, Optional, Tuple

import numpy as np
from scipy import ndimage
from skimage import graph

from rumba_sim.model.floors.reachability import Parts
from rumba_sim.model.kernel import Array
from rumba_sim.model.maps.floor_plan import OCCUPIED, FloorPlan

ALL_AROUND = np.ones((3, 3))
STEEPNESS = 8  # power of the clearance by which a way costs less where there is more: the larger, the wider its narrows
LEAST = 1e-6  # [m] of clearance: less is in a wall

Point = Tuple[float, float]  # x and y [m], map frame


class Kind(enum.Enum):
    """What keeps a robot from another part."""

    GAP = 'a gap that is too narrow'
    CLIFF = 'a cliff'
    WALL = 'a wall'
    UNKNOWN = 'cells that nobody has seen'


class Barrier(NamedTuple):
    """What lies between two parts, where it is least.

    The width is that of the gap, or how far it is across the cliff, the wall or what is unknown.
    """

    kind: Kind
    width: float  # [m]
    ends: Tuple[Point, Point]  # from one side of the gap to the other, or from floor to floor


def barrier(plan: FloorPlan, parts: Parts, here: int, there: int) -> Optional[Barrier]:
    """What keeps a robot in one part of a floor from another; None if one of them holds no node of the plan.

    Args:
        plan: the refined floor plan.
        parts: its parts.
        here, there: the numbers of two of them.
    """
    start, goal = (_widest(plan, parts.labels[::2, ::2] == part) for part in (here, there))
    if start is None or goal is None:
        return None
    way = _way(plan.safe_clearance, start, goal)
    if way is not None:
        return _gap(plan, way)
    return _wall(plan, start, goal) if _way(plan.clearance, start, goal) is None else _cliff(plan, start, goal)


def _widest(plan: FloorPlan, nodes: Array) -> Optional[Tuple[int, int]]:
    """The node with the most space among some."""
    if not nodes.any():
        return None
    row, column = np.unravel_index(int(np.argmax(np.where(nodes, plan.safe_clearance, -1.0))), nodes.shape)
    return int(row), int(column)


def _way(clearance: Array, start: Tuple[int, int], goal: Tuple[int, int]) -> Optional[Tuple[Array, Array]]:
    """Rows and columns of the nodes of a way that avoids narrows; None if walls leave none, however thin a robot is."""
    open_parts, _ = ndimage.label(clearance > LEAST, ALL_AROUND)
    if open_parts[start] != open_parts[goal]:
        return None
    box, = ndimage.find_objects((open_parts == open_parts[start]).astype(int))
    inside = open_parts[box] == open_parts[start]
    cost = np.where(inside, np.maximum(clearance[box], LEAST) ** -float(STEEPNESS), -1.0)  # below 0: no way leads there
    corner = box[0].start, box[1].start
    path, _ = graph.route_through_array(cost, *((end[0] - corner[0], end[1] - corner[1]) for end in (start, goal)),
                                        fully_connected=True)
    rows, columns = np.array(path).T
    return rows + corner[0], columns + corner[1]


def _gap(plan: FloorPlan, way: Tuple[Array, Array]) -> Barrier:
    """The narrowest place of a way."""
    clearance = plan.safe_clearance[way]
    narrowest = np.flatnonzero(clearance == clearance.min())
    at = int(narrowest[len(narrowest) // 2])
    row, column = int(way[0][at]), int(way[1][at])
    nearest = _nearest_obstacle(plan, row, column)
    across = nearest - (row, column)
    sides: List[Point] = [_point(plan, row + sign * across[0], column + sign * across[1]) for sign in (1, -1)]
    return Barrier(Kind.GAP, 2.0 * float(clearance.min()), (sides[0], sides[1]))


def _nearest_obstacle(plan: FloorPlan, row: int, column: int) -> Array:
    """The node that is nearest to one and has no clearance."""
    reach = int(plan.safe_clearance[row, column] / plan.resolution) + 2
    top, left = max(row - reach, 0), max(column - reach, 0)
    walls = np.argwhere(plan.safe_clearance[top:row + reach + 1, left:column + reach + 1] <= LEAST) + (top, left)
    return np.asarray(walls[np.argmin(((walls - (row, column)) ** 2).sum(axis=1))])


def _cliff(plan: FloorPlan, start: Tuple[int, int], goal: Tuple[int, int]) -> Barrier:
    """Where a cliff that divides two nodes is narrowest."""
    assert plan.cliff is not None
    return _divider(plan, Kind.CLIFF, plan.free & ~plan.cliff, start, goal)


def _wall(plan: FloorPlan, start: Tuple[int, int], goal: Tuple[int, int]) -> Barrier:
    """Where what divides two nodes is thinnest."""
    found = _divider(plan, Kind.WALL, plan.free, start, goal)
    ends = (np.array(plan.cell(*end)) for end in found.ends)
    return found if _has_wall(plan, *ends) else found._replace(kind=Kind.UNKNOWN)


def _divider(plan: FloorPlan, kind: Kind, floor: Array, start: Tuple[int, int], goal: Tuple[int, int]) -> Barrier:
    """The shortest line between the floors around two nodes, of a floor with these cells."""
    floors, _ = ndimage.label(floor, ALL_AROUND)
    ours, theirs = (floors == floors[node] for node in (start, goal))  # the cell above a node with space is free
    away, nearest = ndimage.distance_transform_edt(~ours, return_indices=True)
    places = np.argwhere(theirs & (away == away[theirs].min()))
    row, column = places[np.argmin(((places - places.mean(axis=0)) ** 2).sum(axis=1))].tolist()  # in their middle
    near_row, near_column = nearest[:, row, column].tolist()
    return Barrier(kind, max(float(away[row, column]) - 1.0, 0.0) * plan.resolution,
                   (plan.centre(near_row, near_column), plan.centre(row, column)))


def _has_wall(plan: FloorPlan, near: Array, far: Array) -> bool:
    """Whether any cell on the line from one cell to another is wall, and not only unknown."""
    steps = np.linspace(0.0, 1.0, 2 * int(np.abs(far - near).max()) + 1)[:, np.newaxis]
    cells = np.rint(near + steps * (far - near)).astype(int)
    return bool((plan.occupancy[cells[:, 0], cells[:, 1]] == OCCUPIED).any())


def _point(plan: FloorPlan, row: float, column: float) -> Point:
    """Where a node lies, which may have fractions [m]."""
    return (plan.origin[0] + float(column) * plan.resolution, plan.origin[1] + float(row) * plan.resolution)
