"""Many worlds, advanced by one compiled call, each of them as if it were alone, bit for bit.

    plan = map_file.load('studio.yaml')
    worlds = Worlds([world_with_a_robot(plan, seed=seed) for seed in range(1000)])
    worlds.command(np.full(1000, 0.3), np.zeros(1000))
    worlds.step(5)
    print(worlds.robots['x'], worlds.coverage)
"""

import math
from concurrent.futures import ThreadPoolExecutor
from typing import Any, Callable, Dict, List, Optional, Sequence, Union

import numpy as np

from rumba_sim.model import kernel
from rumba_sim.model.compiled import many
from rumba_sim.model.constants import RECORD
from rumba_sim.model.errors import CommandError, WorldError
from rumba_sim.model.floor_plan import ROUNDING, FloorPlan
from rumba_sim.model.kernel import Array
from rumba_sim.model.robot import FIRST
from rumba_sim.model.robot_config import RobotConfig
from rumba_sim.model.world import NOISE_TICKS, World
from rumba_sim.model.world_arrays import WorldArrays

POINT = 0.1  # [m] between the points that are looked at for a map of the surroundings, at most


def world_with_a_robot(plan: FloorPlan, config: Optional[RobotConfig] = None, step_rate: float = 50,
                       seed: int = 0) -> World:
    """A world with one robot at its start.

    Raises:
        RumbaError: as for `World` and `World.spawn`.
    """
    world = World(plan, config, step_rate, seed)
    world.spawn(FIRST)
    return world


class Worlds:
    """Worlds with one robot each, which differ in anything else: floor plan, settings, seed, obstacles, time.

    The worlds stay whole: whatever is asked of one of them, or done to it, between two calls is as if it were alone.
    Their arrays move into rows of large ones, and worlds on one floor plan share what never changes of it.

    Attributes:
        threads: how many threads advance the worlds.
    """

    def __init__(self, worlds: Sequence[World], threads: int = 1) -> None:
        """Take worlds over.

        Args:
            worlds: at least one.
            threads: how many cores to use.

        Raises:
            WorldError: there is no world, one has no robot or several, or lasers differ in their number of beams.
        """
        if not worlds:
            raise WorldError('there is no world: give at least one')
        if threads < 1:
            raise WorldError(f'threads is {threads}: must be at least 1')
        self.threads = threads
        self._pool = ThreadPoolExecutor(threads) if threads > 1 else None
        self._worlds = list(worlds)
        self._all = np.arange(len(worlds))
        self._take_all()

    def __len__(self) -> int:
        """How many worlds there are."""
        return len(self._worlds)

    def __getitem__(self, index: int) -> World:
        """One of the worlds."""
        return self._worlds[index]

    def __setitem__(self, index: int, world: World) -> None:
        """Put another world at the place of one.

        Raises:
            WorldError: as for the constructor; the old world stays.
        """
        _check(world, self[0])
        self._worlds[index] = world
        self._versions[index] = -1

    @property
    def robots(self) -> Array:
        """The states of all robots: (worlds) records `kernel.ROBOT`. Ask again after a world was replaced."""
        self._follow_changes()
        return self._robots

    @property
    def constants(self) -> Array:
        """The constants of all worlds: (worlds) records `constants.Constants`; `World.config` changes them."""
        self._follow_changes()
        return self._constants

    # --- what the robots do ---------------------------------------------------------------------------------------

    def command(self, v: Array, w: Array, brushes_up: Optional[Array] = None) -> None:
        """Command a velocity to each robot, as `Robot.command` does.

        Args:
            v: float64 (worlds), forward [m/s].
            w: float64 (worlds), counter-clockwise [rad/s].
            brushes_up: bool (worlds), whether its brushes are lifted; None leaves them as they are.

        Raises:
            CommandError: a velocity is not a finite number; the previous commands stay in force.
        """
        if not (np.isfinite(v).all() and np.isfinite(w).all()):
            raise CommandError('a velocity is not a finite number')
        self._follow_changes()
        self._robots['command_v'], self._robots['command_w'] = v, w
        self._robots['command_tick'] = self._ticks()
        if brushes_up is not None:
            self._robots['brushes_up'] = brushes_up

    def step(self, ticks: Union[int, Array] = 1) -> None:
        """Simulate a number of ticks in each world, the same in all or one for each: int64 (worlds)."""
        self._follow_changes()
        left = np.full(len(self), ticks, np.int64)
        while left.any():
            now = self._ticks()
            rows = now % NOISE_TICKS
            for index in np.flatnonzero((rows == 0) & (left > 0)):
                self._worlds[index].draw_noise()
            spans = np.minimum(left, NOISE_TICKS - rows)
            self._run(many.advance, self._all, now, spans, self._robots, self._constants, self._obstacles, self._counts,
                      self._stops, self._moving, self._plans, self._shapes, self._fields, self._cells, self._samples,
                      self._dirt, self._tallies, self._noise)
            for world, span in zip(self._worlds, spans.tolist()):
                world.tick += span
            left -= spans

    # --- what they sense: in all worlds, or in those that are named -------------------------------------------------

    def scan(self, which: Optional[Array] = None) -> Array:
        """Ranges that each laser measures, as `World.scan` answers them: float64 (worlds, beams) [m].

        Args:
            which: int64 (any), the numbers of the worlds; None for all. The same of the other sensors.
        """
        order = self._order(which)
        ranges, noise = np.empty((2, len(order), len(self._fan)))
        for row, index in zip(noise, order.tolist()):
            self._worlds[index].draw_laser_noise(0, row)
        self._run(many.scan, order, self._robots, self._constants, self._obstacles, self._counts, self._plans,
                  self._shapes, self._cells, self._skips, self._fan, noise, ranges)
        return ranges

    def infrared(self, which: Optional[Array] = None) -> Array:
        """Beams of the dock that each robot receives: uint8 (worlds, 3), omni, left and right as for `Infrared`."""
        order = self._order(which)
        beams = np.empty((len(order), 3), np.uint8)
        self._run(many.infrared, order, self._robots, self._constants, self._plans, self._shapes, self._cells,
                  self._skips, beams)
        return beams

    def cliffs(self, which: Optional[Array] = None) -> Array:
        """What `World.cliffs` answers for each robot: bool (worlds, 4)."""
        order = self._order(which)
        seen = np.empty((len(order), 4), np.bool_)
        self._run(many.cliffs, order, self._robots, self._constants, self._plans, self._shapes, self._cells,
                  self._cliff_distances, self._cliff_angles, seen)
        return seen

    def surroundings(self, size: int, pitches: Sequence[float], which: Optional[Array] = None) -> Array:
        """Maps of the floor around each robot, by its true pose: uint8 (worlds, scales, 2, size, size).

        The robot is in the middle and looks toward row 0, with column 0 on its left. The first of the two pictures
        of a scale shows what is no floor by the map, the second what is left to be swept: 255 times the share of the
        pixel, which is looked at in points at most POINT apart.

        Args:
            size: pixels along a side.
            pitches: side of a pixel in each scale [m].
            which: as for `scan`.
        """
        order = self._order(which)
        maps = np.empty((len(order), len(pitches), 2, size, size), np.uint8)
        points = [math.ceil(pitch / POINT - ROUNDING) for pitch in pitches]
        self._run(many.surroundings, order, self._robots, self._constants, self._plans, self._shapes, self._cells,
                  self._samples, np.array(pitches, np.float64), np.array(points, np.int64), maps)
        return maps

    @property
    def coverage(self) -> Array:
        """Swept part of the floor that can be reached: float64 (worlds) [0..1]."""
        self._follow_changes()
        return np.where(self._reachable > 0, self._tallies['swept'] / np.maximum(self._reachable, 1), 1.0)

    @property
    def cleaned_area(self) -> Array:
        """Area that can be reached and is swept: float64 (worlds) [m^2]."""
        self._follow_changes()
        return np.asarray(self._tallies['swept'] * self._constants['sample_pitch'] ** 2)

    def _order(self, which: Optional[Array]) -> Array:
        self._follow_changes()
        return self._all if which is None else np.asarray(which, np.int64)

    def _run(self, function: Callable[..., None], order: Array, *arguments: Any) -> None:
        """Call a function of `batch` for the worlds of an order, in all threads."""
        if self._pool is None:
            function(0, len(order), order, *arguments)
            return
        bounds = np.linspace(0, len(order), self.threads + 1).astype(int).tolist()
        parts = [self._pool.submit(function, *part, order, *arguments) for part in zip(bounds, bounds[1:])]
        for part in parts:
            part.result()

    # --- the arrays -----------------------------------------------------------------------------------------------

    def _ticks(self) -> Array:
        return np.fromiter((world.tick for world in self._worlds), np.int64, len(self))

    def _follow_changes(self) -> None:
        """Take over the worlds that were changed or replaced since the last call."""
        versions = [world.version for world in self._worlds]
        if versions == self._versions:
            return
        for index, world in enumerate(self._worlds):
            if world.version != self._versions[index]:
                _check(world, self._worlds[0])
                if not self._fits(world):
                    self._take_all()
                    return
                self._take(index, world)

    def _take_all(self) -> None:
        """Make rows that are long enough for each of the worlds, and take over all of them."""
        worlds = self._worlds
        for world in worlds:
            _check(world, worlds[0])
        plans: Dict[int, World] = {id(world.terrain): world for world in worlds}
        number, arrays = len(worlds), [world.arrays for world in worlds]

        def rows(name: str, *shape: int) -> Array:
            most = max(getattr(each, name).size for each in arrays)
            return np.zeros((number, most, *shape), getattr(arrays[0], name).dtype)
        self._robots: Array = np.zeros(number, kernel.ROBOT)
        self._constants: Array = np.zeros(number, RECORD)
        self._tallies: Array = np.zeros(number, kernel.TALLY)
        self._noise: Array = np.zeros((number, 1, NOISE_TICKS, 2))
        self._obstacles, self._samples, self._dirt = rows('obstacles'), rows('samples'), rows('dirt')
        self._stops: Array = np.zeros((number, max(len(each.stops) for each in arrays), 6))
        self._counts, self._plans, self._reachable = np.zeros((3, number), np.int64)
        self._moving = np.zeros(number, np.bool_)
        self._shapes = np.zeros((number, 3), np.int64)
        self._cliff_distances, self._cliff_angles = np.zeros(number), np.zeros((number, 4))
        self._fan = worlds[0].fan
        most = max(world.terrain.skips.size for world in plans.values())
        nodes = max(world.terrain.clearance.size for world in plans.values())
        self._fields: Array = np.zeros((len(plans), nodes))
        self._cells, self._skips = np.zeros((2, len(plans), most), np.uint8)
        self._terrains: List[Optional[FloorPlan]] = [None] * len(plans)
        self._versions = [-1] * number
        for index, world in enumerate(worlds):
            self._take(index, world)

    def _fits(self, world: World) -> bool:
        """Whether the rows are long enough for a world."""
        arrays, terrain = world.arrays, world.terrain
        return (arrays.obstacles.size <= self._obstacles.shape[1] and len(arrays.stops) <= self._stops.shape[1]
                and arrays.samples.size <= self._samples.shape[1] and arrays.dirt.size <= self._dirt.shape[1]
                and terrain.clearance.size <= self._fields.shape[1] and terrain.skips.size <= self._cells.shape[1]
                and self._row_of(terrain) is not None)

    def _row_of(self, terrain: FloorPlan) -> Optional[int]:
        """The row that belongs to a floor plan, or one that no world needs any more."""
        if terrain in self._terrains:
            return self._terrains.index(terrain)
        needed = {id(world.terrain) for world in self._worlds}
        return next((row for row, known in enumerate(self._terrains) if id(known) not in needed), None)

    def _take(self, index: int, world: World) -> None:
        """Move the arrays of a world into row `index`."""
        terrain, before = world.terrain, world.arrays
        plan = self._plan_row(world)
        self._plans[index] = plan
        self._shapes[index] = terrain.rows, terrain.columns, terrain.sample_squares
        self._counts[index], self._moving[index] = len(before.obstacles), world.obstacles.has_movers
        self._reachable[index] = world.floor.sweep.reachable
        cliff = world.config.cliff
        self._cliff_distances[index] = cliff.distance
        self._cliff_angles[index] = cliff.outer_angle, cliff.inner_angle, -cliff.inner_angle, -cliff.outer_angle
        alone = slice(index, index + 1)
        after = WorldArrays(
            self._robots[alone], self._constants[alone], _begin_of(self._obstacles[index], before.obstacles),
            self._stops[index, :len(before.stops)], self._noise[index], _begin_of(self._cells[plan], before.cells),
            _begin_of(self._samples[index], before.samples), _begin_of(self._dirt[index], before.dirt),
            self._tallies[alone])
        for old, new in zip(before, after):
            new[...] = old
        world.keep_in(after)
        self._versions[index] = world.version

    def _plan_row(self, world: World) -> int:
        """The row of a world's floor plan, with the plan in it."""
        terrain = world.terrain
        row = self._row_of(terrain)
        if row is None:
            raise AssertionError('there are as many rows as plans')
        if self._terrains[row] is not terrain:
            self._terrains[row] = terrain
            _begin_of(self._fields[row], terrain.clearance)[...] = terrain.clearance
            _begin_of(self._skips[row], terrain.skips)[...] = terrain.skips
        return row


def _begin_of(row: Array, array: Array) -> Array:
    """The begin of a row, in the shape of an array."""
    return row[:array.size].reshape(array.shape)


def _check(world: World, like: World) -> None:
    """Refuse a world that cannot be among others such as `like`.

    Raises:
        WorldError: it has no robot, or several, or another number of beams.
    """
    if len(world.robots) != 1:
        raise WorldError(f'a world has {len(world.robots)} robots: each must have one')
    if world.config.laser.beams != like.config.laser.beams:
        raise WorldError(f'laser/beams is {world.config.laser.beams} in one world and {like.config.laser.beams} in '
                         'another: must be the same in all of them')
