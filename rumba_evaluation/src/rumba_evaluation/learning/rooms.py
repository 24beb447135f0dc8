"""Rooms at random, as many as there are numbers: some to learn in, others that a learner has never seen."""

import functools
from typing import List, Tuple

import numpy as np

from rumba_sim.model.common.errors import MapError
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.kernel import Array
from rumba_sim.model.maps.floor_plan import FREE, OCCUPIED, FloorPlan
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation.world import World

RESOLUTION = 0.05  # [m] side of a cell
WIDTH, HEIGHT = (3.0, 6.0), (3.0, 5.0)  # [m] of the room
PIECES = (2, 6)  # of furniture
LENGTH, DEPTH = (0.3, 1.4), (0.3, 0.8)  # [m] of a piece
DOOR = 0.8  # [m] that a wall across the room leaves open
WALLED = 0.4  # share of the rooms with such a wall
FREE_BEFORE_DOCK = 1.0  # [m]
LEAST = 0.5  # share of the room that the brush can reach; with less, another room is drawn


def rooms(first: int, count: int) -> List[FloorPlan]:
    """The rooms with the numbers from `first` on."""
    return [room(number) for number in range(first, first + count)]


@functools.lru_cache(maxsize=4096)
def room(number: int) -> FloorPlan:
    """A furnished room of 3 x 3 to 6 x 5 m with a dock on its left wall; the same number is always the same room."""
    generator = np.random.default_rng((number, 0))
    while True:
        plan = _drawn(f'room {number}', generator)
        try:
            world = World(plan)
        except MapError:  # a piece of furniture is too near to the dock
            continue
        if world.floor.reachable_area >= LEAST * plan.occupancy.size * RESOLUTION ** 2:
            return plan


def _drawn(name: str, generator: np.random.Generator) -> FloorPlan:
    columns, rows = (_cells(generator, side) for side in (WIDTH, HEIGHT))
    grid = np.full((rows + 2, columns + 2), OCCUPIED, np.int8)
    inside = grid[1:-1, 1:-1]
    inside[...] = FREE
    radius = RobotConfig().drive.radius
    dock = Pose(radius + 0.01, float(generator.uniform(0.6, rows * RESOLUTION - 0.6)), np.pi)
    if generator.random() < WALLED:
        _add_wall(generator, inside)
    for _ in range(generator.integers(*PIECES, endpoint=True)):
        _add_piece(generator, inside)
    row, reach = int(dock.y / RESOLUTION), round(0.5 / RESOLUTION)
    inside[max(row - reach, 0):row + reach, :round(FREE_BEFORE_DOCK / RESOLUTION)] = FREE
    return FloorPlan(name, grid, RESOLUTION, (-RESOLUTION, -RESOLUTION), dock=dock)


def _add_wall(generator: np.random.Generator, inside: Array) -> None:
    """Add a wall across the middle part of the room, with a door at one of its ends."""
    column = int(generator.uniform(0.4, 0.7) * inside.shape[1])
    door = round(DOOR / RESOLUTION)
    is_low = generator.random() < 0.5
    inside[door if is_low else 0:None if is_low else -door, column:column + 2] = OCCUPIED


def _add_piece(generator: np.random.Generator, inside: Array) -> None:
    """Add a piece of furniture: half of them stand against a wall, but not the one of the dock."""
    sides = [_cells(generator, side) for side in (LENGTH, DEPTH)]
    height, width = sides if generator.random() < 0.5 else sides[::-1]
    most_row, most_column = inside.shape[0] - height, inside.shape[1] - width
    row, column = int(generator.integers(most_row + 1)), int(generator.integers(most_column + 1))
    row, column = ((0, column), (most_row, column), (row, most_column), *3 * [(row, column)])[generator.integers(6)]
    inside[row:row + height, column:column + width] = OCCUPIED


def _cells(generator: np.random.Generator, metres: Tuple[float, float]) -> int:
    return round(float(generator.uniform(*metres)) / RESOLUTION)
