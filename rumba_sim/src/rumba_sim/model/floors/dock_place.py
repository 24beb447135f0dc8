"""A place for a dock on a map that has none: against a straight wall, with room to drive up to it."""

import itertools
from typing import NamedTuple, Optional, Tuple

import numpy as np
from scipy import ndimage

from rumba_sim.model.common.geometry import Pose, wrap_angle
from rumba_sim.model.floors.constants import clearance_needed
from rumba_sim.model.floors.reachability import Parts
from rumba_sim.model.kernel import Array
from rumba_sim.model.maps.floor_plan import OCCUPIED, FloorPlan

# All figures are our choice.
PLATE = 0.03  # [m] between the robot and the wall, for the plate of the dock
ALONG = (-0.3, -0.2, -0.1, 0.1, 0.2, 0.3)  # [m] along the wall from the dock, where the wall is as far away ...
EVEN = 0.01  # [m] ... as at the dock, within this and half a cell: slanted walls have steps
BEHIND = (0.2, 0.4, 0.6, 0.8, 1.0, 1.2)  # [m] from the dock on its axis, where a robot has more and more space
SPACE = 0.4  # [m] of clearance that is enough there
SIDE = (-0.5, -0.25, 0.25, 0.5)  # [m] beside the axis, where the floor is free
OPEN = 1.5  # [m] of clearance on the axis, beyond which more is no better
STRAIGHT = 20.0  # times as much as space on its axis counts how even the wall beside it is
MOST = 4000  # nodes that are looked at


class _Places(NamedTuple):
    """Nodes beside walls; float64 (any) each."""

    x: Array  # [m]
    y: Array
    ahead_x: Array  # direction to the wall, a vector of length 1
    ahead_y: Array

    def points(self, ahead: float, left: float) -> Tuple[Array, Array]:
        """x and y of points in the frames of robots that stand there and face the wall [m]."""
        return (self.x + ahead * self.ahead_x - left * self.ahead_y,
                self.y + ahead * self.ahead_y + left * self.ahead_x)

    def those(self, which: Array) -> '_Places':
        """Some of them."""
        return _Places(*(values[which] for values in self))


def place_dock(plan: FloorPlan, radius: float, start: Pose) -> Optional[Pose]:
    """The pose of a robot at a dock that robots from a start can reach; None if there is no room for one.

    Of all places, it is one with much space before it and a straight wall.

    Args:
        plan: the floor plan.
        radius: of the robots [m].
        start: where they begin, map frame.
    """
    terrain = plan.refined()
    parts = Parts(terrain, clearance_needed(radius, terrain.resolution))
    here = parts.at(*start[:2])
    if here == 0:
        return None
    away = radius + PLATE
    places = _straightened(terrain, _beside_walls(terrain, parts.labels[::2, ::2] == here, away))
    uneven = np.zeros(len(places.x))
    for left in ALONG:
        uneven = np.maximum(uneven, abs(_clearance(terrain, *places.points(0.0, left)) - away))
    good = uneven < EVEN + 0.5 * plan.resolution
    for behind in BEHIND:
        good &= _clearance(terrain, *places.points(-behind, 0.0)) >= min(away + 0.5 * behind, SPACE)
    for behind, left in itertools.product((0.0, *BEHIND), SIDE):
        good &= _clearance(terrain, *places.points(-behind, left)) > 0.0
    good &= _is_wall(terrain, *places.points(away + 0.5 * terrain.resolution, 0.0))
    return _best(terrain, places.those(good), uneven[good])


def _beside_walls(plan: FloorPlan, among: Array, away: float) -> _Places:
    """Where robots face a wall at a distance [m], near nodes among some."""
    clearance, cell = plan.safe_clearance, plan.resolution
    rows, columns = np.nonzero(among & (clearance >= away) & (clearance < away + cell))
    few = slice(None, None, max(len(rows) // MOST, 1))
    inner = slice(1, -1)
    rows, columns = (np.clip(index[few], 1, size - 2) for index, size in zip((rows, columns), clearance.shape))
    up = clearance[2:, inner][rows - 1, columns - 1] - clearance[:-2, inner][rows - 1, columns - 1]
    right = clearance[inner, 2:][rows - 1, columns - 1] - clearance[inner, :-2][rows - 1, columns - 1]
    length = np.maximum(np.sqrt(up ** 2 + right ** 2), 1e-9)
    ahead_x, ahead_y = -right / length, -up / length
    closer = clearance[rows, columns] - away
    x, y = plan.origin[0] + columns * cell, plan.origin[1] + rows * cell
    return _Places(x + closer * ahead_x, y + closer * ahead_y, ahead_x, ahead_y)


def _straightened(plan: FloorPlan, places: _Places) -> _Places:
    """The same places, square to the wall as it runs over a longer way: nearby, it may have steps."""
    right, *_, left = ALONG
    rise = _clearance(plan, *places.points(0.0, left)) - _clearance(plan, *places.points(0.0, right))
    tilt = np.clip(rise / (left - right), -1.0, 1.0)
    along = np.sqrt(1.0 - tilt ** 2)
    return places._replace(ahead_x=along * places.ahead_x + tilt * places.ahead_y,
                           ahead_y=along * places.ahead_y - tilt * places.ahead_x)


def _clearance(plan: FloorPlan, x: Array, y: Array) -> Array:
    """The safe clearance at points [m]; 0 outside the map."""
    at = [(y - plan.origin[1]) / plan.resolution, (x - plan.origin[0]) / plan.resolution]
    return np.asarray(ndimage.map_coordinates(plan.safe_clearance, at, order=1, cval=0.0))


def _is_wall(plan: FloorPlan, x: Array, y: Array) -> Array:
    """Whether there is a wall in the cells at points; nobody knows what is in unknown ones."""
    row, column = (np.floor((at - low) / plan.resolution).astype(int) for at, low in zip((y, x), plan.origin[::-1]))
    inside = (row >= 0) & (row < plan.rows) & (column >= 0) & (column < plan.columns)
    return np.asarray(inside & (plan.occupancy[np.where(inside, row, 0), np.where(inside, column, 0)] == OCCUPIED))


def _best(plan: FloorPlan, places: _Places, uneven: Array) -> Optional[Pose]:
    if not len(places.x):
        return None
    space = sum(np.minimum(_clearance(plan, *places.points(-behind, 0.0)), OPEN) for behind in BEHIND)
    best = int(np.argmax(np.round(space - STRAIGHT * uneven, 2)))
    heading = float(np.arctan2(places.ahead_y[best], places.ahead_x[best]))
    return Pose(round(float(places.x[best]), 3), round(float(places.y[best]), 3), round(wrap_angle(heading), 4))
