"""Many worlds, advanced by one compiled call, each of them as if it were alone, bit for bit.

    plan = map_file.load(named_maps.path('studio'))
    worlds = Worlds([world_with_a_robot(plan, seed=seed) for seed in range(1000)])
    worlds.command(np.full(1000, 0.3), np.zeros(1000))
    worlds.step(5)
    print(worlds.robots['x'], worlds.coverage)
"""

import math
from concurrent.futures import ThreadPoolExecutor
from typing import Any, Callable, List, Optional, Sequence, Tuple, Union

import numpy as np

from rumba_sim.model.common.errors import CommandError, WorldError
from rumba_sim.model.compiling.compiled import many
from rumba_sim.model.kernel import Array
from rumba_sim.model.maps.floor_plan import ROUNDING, FloorPlan
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation.noise import NOISE_TICKS
from rumba_sim.model.simulation.robot import FIRST
from rumba_sim.model.simulation.world import World
from rumba_sim.model.simulation.world_arrays import WorldArrays
from rumba_sim.model.simulation.world_rows import WorldRows

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
            WorldError: there is no world, one has no robot or several, or lasers differ in their beams.
        """
        if not worlds:
            raise WorldError('there is no world: give at least one')
        if threads < 1:
            raise WorldError(f'threads is {threads}: must be at least 1')
        self.threads = threads
        self._pool = ThreadPoolExecutor(threads) if threads > 1 else None
        self._worlds = list(worlds)
        self._by_plan: Array = np.arange(len(worlds))
        self._versions: List[int] = []
        self._take_all()

    def __reduce__(self) -> Tuple[Callable[..., 'Worlds'], Tuple[Any, ...]]:
        """Copies and pickles go on from here, bit for bit, as the worlds themselves do."""
        return Worlds, (self._worlds, self.threads)

    def __len__(self) -> int:
        """How many worlds there are."""
        return len(self._worlds)

    def __getitem__(self, index: int) -> World:
        """One of the worlds."""
        return self._worlds[index]

    def __setitem__(self, index: int, world: World) -> None:
        """Put another world at the place of one, which is free to go on alone.

        Raises:
            WorldError: as for the constructor; the old world stays.
        """
        _check(world, self[0])
        self[index].keep_in(WorldArrays(*(array.copy() for array in self[index].arrays)))
        self._worlds[index] = world
        self._versions[index] = -1

    @property
    def robots(self) -> Array:
        """The states of all robots: (worlds) records of type ROBOT. Ask again after a world was replaced."""
        self._follow_changes()
        return self._rows.robots

    @property
    def constants(self) -> Array:
        """The constants of all worlds: (worlds) records `constants.Constants`; `World.config` changes them."""
        self._follow_changes()
        return self._rows.constants

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
        self._rows.robots['command_v'], self._rows.robots['command_w'] = v, w
        self._rows.robots['command_tick'] = self._ticks()
        if brushes_up is not None:
            self._rows.robots['brushes_up'] = brushes_up

    def step(self, ticks: Union[int, Array] = 1) -> None:
        """Simulate a number of ticks in each world, the same in all or one for each: int64 (worlds)."""
        self._follow_changes()
        left = np.full(len(self), ticks, np.int64)
        while left.any():
            now, here = self._ticks(), self._rows
            rows = now % NOISE_TICKS
            for index in np.flatnonzero((rows == 0) & (left > 0)):
                self._worlds[index].noise.draw(now[index])
            spans = np.minimum(left, NOISE_TICKS - rows)
            self._run(many.advance, self._by_plan, now, spans, here.robots, here.constants, here.obstacles, here.counts,
                      here.stops, here.moving, here.plans, here.docks, here.dock_counts, here.shapes, here.fields,
                      here.cells, here.samples, here.dirt, here.tallies, here.noise)
            for world, span in zip(self._worlds, spans.tolist()):
                world.tick += span
            left -= spans

    # --- what they sense: in all worlds, or in those that are named -------------------------------------------------

    def scan(self, which: Optional[Array] = None) -> Array:
        """Ranges that each laser measures, as `World.scan` answers them: float64 (worlds, beams) [m].

        Args:
            which: int64 (any), the numbers of the worlds; None for all. The same of the other sensors.
        """
        order, rows = self._order(which)
        here = self._rows
        laser = self[0].config.laser
        ranges, noise = np.empty((len(order), laser.beams)), np.empty((len(order), laser.draws, laser.beams))
        biases = np.empty(len(order))
        for row, index in zip(rows.tolist(), order.tolist()):
            self._worlds[index].noise.draw_laser(0, noise[row])
            biases[row] = self._worlds[index].noise.biases[0]
        self._run(many.scan, order, rows, here.robots, here.constants, here.obstacles, here.counts, here.plans,
                  here.shapes, here.skips, self[0].fans, noise, biases, ranges)
        return ranges

    def infrared(self, which: Optional[Array] = None) -> Array:
        """Beams of the docks that each robot receives: uint8 (worlds, 3), omni, left and right as for `Infrared`."""
        order, rows = self._order(which)
        here = self._rows
        beams = np.empty((len(order), 3), np.uint8)
        self._run(many.infrared, order, rows, here.robots, here.constants, here.plans, here.docks, here.dock_counts,
                  here.shapes, here.skips, beams)
        return beams

    def cliffs(self, which: Optional[Array] = None) -> Array:
        """What `World.cliffs` answers for each robot: bool (worlds, 4)."""
        order, rows = self._order(which)
        here = self._rows
        seen = np.empty((len(order), 4), np.bool_)
        self._run(many.cliffs, order, rows, here.robots, here.constants, here.plans, here.shapes, here.cells,
                  seen)
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
        order, rows = self._order(which)
        here = self._rows
        maps = np.empty((len(order), len(pitches), 2, size, size), np.uint8)
        points = [math.ceil(pitch / POINT - ROUNDING) for pitch in pitches]
        self._run(many.surroundings, order, rows, here.robots, here.constants, here.plans, here.shapes, here.cells,
                  here.samples, here.left, here.known, np.array(pitches, np.float64), np.array(points, np.int64), maps)
        return maps

    @property
    def coverage(self) -> Array:
        """Swept part of the floor that can be reached: float64 (worlds) [0..1]."""
        self._follow_changes()
        swept, reachable = self._rows.tallies['swept'], self._rows.reachable
        return np.where(reachable > 0, swept / np.maximum(reachable, 1), 1.0)

    @property
    def cleaned_area(self) -> Array:
        """Area that can be reached and is swept: float64 (worlds) [m^2]."""
        self._follow_changes()
        return np.asarray(self._rows.tallies['swept'] * self._rows.constants['sample_pitch'] ** 2)

    def _order(self, which: Optional[Array]) -> Tuple[Array, Array]:
        """In which order to look at worlds, and in which row to put what is seen in each."""
        self._follow_changes()
        if which is None:
            return self._by_plan, self._by_plan
        order = np.asarray(which, np.int64)
        return order, np.arange(len(order))

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
                if not self._rows.fit(world, self._worlds):
                    self._take_all()
                    return
                self._rows.take(index, world, self._worlds)
                self._versions[index] = world.version
        self._sort()

    def _take_all(self) -> None:
        for world in self._worlds:
            _check(world, self._worlds[0])
        self._rows = WorldRows(self._worlds)
        self._versions = [world.version for world in self._worlds]
        self._sort()

    def _sort(self) -> None:
        """Find the order in which worlds on one floor plan are side by side."""
        self._by_plan = np.argsort(self._rows.plans, kind='stable')


def _check(world: World, like: World) -> None:
    """Refuse a world that cannot be among others such as `like`.

    Raises:
        WorldError: it has no robot, or several, or other beams.
    """
    if len(world.robots) != 1:
        raise WorldError(f'a world has {len(world.robots)} robots: each must have one')
    if world.config.laser.beams != like.config.laser.beams:
        raise WorldError(f'laser/beams is {world.config.laser.beams} in one world and {like.config.laser.beams} in '
                         'another: must be the same in all of them')
    if world.config.laser.draws != like.config.laser.draws or not np.array_equal(world.fans, like.fans):
        raise WorldError(f'the lasers {world.config.laser.model} and {like.config.laser.model} have other beams: must '
                         'be the same in all of them')
