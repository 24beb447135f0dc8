"""The arrays of many worlds, in rows of large arrays that `batch` reads and changes."""

from typing import Dict, List, Optional, Sequence

import numpy as np

from rumba_sim.model.floors.constants import RECORD
from rumba_sim.model.kernel import Array
from rumba_sim.model.kernel.records import ROBOT, TALLY
from rumba_sim.model.maps.floor_plan import FloorPlan
from rumba_sim.model.simulation.noise import NOISE_TICKS
from rumba_sim.model.simulation.world import World
from rumba_sim.model.simulation.world_arrays import WorldArrays


class WorldRows:
    """Rows for the arrays of worlds with one robot each; the attributes are the arguments of `batch`.

    Attributes, apart from those:
        reachable: int64 (worlds), how many samples can be reached.
    """

    def __init__(self, worlds: Sequence[World]) -> None:
        """Make rows that are long enough for each of the worlds, and move all of them there."""
        plans: Dict[int, World] = {id(world.terrain): world for world in worlds}
        number, arrays = len(worlds), [world.arrays for world in worlds]

        def rows(name: str, *shape: int) -> Array:
            most = max(getattr(each, name).size for each in arrays)
            return np.zeros((number, most, *shape), getattr(arrays[0], name).dtype)
        self.robots: Array = np.zeros(number, ROBOT)
        self.constants: Array = np.zeros(number, RECORD)
        self.tallies: Array = np.zeros(number, TALLY)
        self.noise: Array = np.zeros((number, 1, NOISE_TICKS, 2))
        self.obstacles, self.samples, self.dirt = rows('obstacles'), rows('samples'), rows('dirt')
        self.stops: Array = np.zeros((number, max(len(each.stops) for each in arrays), 6))
        self.counts, self.plans, self.reachable = np.zeros((3, number), np.int64)
        self.moving = np.zeros(number, np.bool_)
        self.shapes = np.zeros((number, 3), np.int64)
        most = max(world.terrain.skips.size for world in plans.values())
        nodes = max(world.terrain.clearance.size for world in plans.values())
        self.fields: Array = np.zeros((len(plans), nodes))
        self.cells, self.skips = np.zeros((2, len(plans), most), np.uint8)
        self.left: Array = np.zeros((number, most), np.uint8)
        self.known: Array = np.full((number, 3), np.nan)
        self.docks: Array = np.zeros((len(plans), max(len(world.terrain.docks) for world in plans.values()), 3))
        self.dock_counts = np.zeros(len(plans), np.int64)
        self.terrains: List[Optional[FloorPlan]] = [None] * len(plans)
        for index, world in enumerate(worlds):
            self.take(index, world, worlds)

    def fit(self, world: World, worlds: Sequence[World]) -> bool:
        """Whether the rows are long enough for a world, which is one of those that are to be here."""
        arrays, terrain = world.arrays, world.terrain
        return (arrays.obstacles.size <= self.obstacles.shape[1] and len(arrays.stops) <= self.stops.shape[1]
                and arrays.samples.size <= self.samples.shape[1] and arrays.dirt.size <= self.dirt.shape[1]
                and terrain.clearance.size <= self.fields.shape[1] and terrain.skips.size <= self.cells.shape[1]
                and len(terrain.docks) <= self.docks.shape[1]
                and self._row_of(terrain, worlds) is not None)

    def _row_of(self, terrain: FloorPlan, worlds: Sequence[World]) -> Optional[int]:
        """The row that belongs to a floor plan, or one that no world needs any more."""
        if terrain in self.terrains:
            return self.terrains.index(terrain)
        needed = {id(world.terrain) for world in worlds}
        return next((row for row, known in enumerate(self.terrains) if id(known) not in needed), None)

    def take(self, index: int, world: World, worlds: Sequence[World]) -> None:
        """Move the arrays of a world into row `index`."""
        terrain, before = world.terrain, world.arrays
        plan = self._plan_row(terrain, worlds)
        self.plans[index] = plan
        self.shapes[index] = terrain.rows, terrain.columns, terrain.sample_squares
        self.counts[index], self.moving[index] = len(before.obstacles), world.obstacles.has_movers
        self.known[index] = np.nan
        self.reachable[index] = world.floor.sweep.reachable
        alone = slice(index, index + 1)
        after = WorldArrays(
            self.robots[alone], self.constants[alone], _begin_of(self.obstacles[index], before.obstacles),
            self.stops[index, :len(before.stops)], self.noise[index], _begin_of(self.cells[plan], before.cells),
            _begin_of(self.samples[index], before.samples), _begin_of(self.dirt[index], before.dirt),
            self.tallies[alone])
        for old, new in zip(before, after):
            new[...] = old
        world.keep_in(after)

    def _plan_row(self, terrain: FloorPlan, worlds: Sequence[World]) -> int:
        """The row of a floor plan, with the plan in it."""
        row = self._row_of(terrain, worlds)
        if row is None:
            raise AssertionError('there are as many rows as plans')
        if self.terrains[row] is not terrain:
            self.terrains[row] = terrain
            self.dock_counts[row] = len(terrain.docks)
            self.docks[row, :len(terrain.docks)] = np.reshape(terrain.docks, (-1, 3))
            _begin_of(self.fields[row], terrain.clearance)[...] = terrain.clearance
            _begin_of(self.skips[row], terrain.skips)[...] = terrain.skips
        return row


def _begin_of(row: Array, array: Array) -> Array:
    """The begin of a row, in the shape of an array."""
    return row[:array.size].reshape(array.shape)
