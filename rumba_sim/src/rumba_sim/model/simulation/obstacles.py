"""The obstacles of a world, as the arrays that the kernel reads and moves."""

import math
import zlib
from typing import Dict, Iterator, List, Sequence, Tuple

import numpy as np

from rumba_sim.model.common.errors import WorldError
from rumba_sim.model.common.geometry import Pose, hypot, wrap_angle
from rumba_sim.model.common.name import check_name
from rumba_sim.model.compiling.compiled import fast
from rumba_sim.model.kernel import Array, Record
from rumba_sim.model.kernel.records import OBSTACLE
from rumba_sim.model.kernel.ticking.movers import pause
from rumba_sim.model.maps.floor_plan import FloorPlan
from rumba_sim.model.simulation.noise import sequence
from rumba_sim.model.simulation.obstacle import Obstacle, Stop

MOST = 1000  # obstacles of a world
MOVER = 3  # purpose of random generators, beside those of `World`


class Obstacles:
    """What stands or moves in a world and is not on its map.

    Attributes:
        items: obstacles by name, in the order in which they were added.
        records: array of records of type OBSTACLE, in the same order.
        stops: float64 (stops of all movers, 6), as for `kernel`.
        has_movers: whether one of them moves.
    """

    def __init__(self, step_rate: float, seed: int, radius: float) -> None:
        """Begin with none.

        Args:
            step_rate: ticks per second [Hz].
            seed: of the world; the pauses of a mover follow from it and from the name of the mover alone.
            radius: of the robots [m].
        """
        self._step_rate = step_rate
        self._seed = seed
        self._radius = radius
        self.items: Dict[str, Obstacle] = {}
        self.records: Array = np.zeros(0, OBSTACLE)
        self.stops: Array = np.zeros((0, 6))
        self.has_movers = False

    def add(self, obstacle: Obstacle) -> None:
        """Add an obstacle where it begins.

        Raises:
            WorldError: the name is not valid or is taken, there are too many, or a mover is too fast.
        """
        check_name(obstacle.name)
        if obstacle.name in self.items:
            raise WorldError(f'{obstacle.name!r} is taken: obstacles are {", ".join(self.items)}')
        if len(self.items) >= MOST:
            raise WorldError(f'there are {MOST} obstacles already: remove one first')
        self._check_steps(obstacle)
        self._take({**self.items, obstacle.name: obstacle}, np.concatenate([self.records, self._begun(obstacle)]))

    def remove(self, name: str) -> None:
        """Take an obstacle away.

        Raises:
            WorldError: there is no obstacle of that name.
        """
        if name not in self.items:
            raise WorldError(f'there is no obstacle {name!r}: obstacles are {", ".join(self.items) or "none"}')
        index = list(self.items).index(name)
        self._take({other: item for other, item in self.items.items() if other != name},
                   np.delete(self.records, index))

    def begin(self) -> None:
        """Put all movers back to where they began."""
        begun = [self._begun(obstacle) for obstacle in self.items.values()]
        self._take(self.items, np.concatenate([self.records[:0], *begun]))

    def restore(self, obstacles: Sequence[Obstacle]) -> None:
        """Replace all obstacles; the arrays are to be filled next."""
        self.items = {obstacle.name: obstacle for obstacle in obstacles}
        self.begin()

    def step(self, robots: Array, constants: Record) -> None:
        """Let the movers go on for one tick; they wait for robots (records of type ROBOT)."""
        fast.go(self.records, self.stops, robots, constants)

    def poses(self) -> Iterator[Tuple[Obstacle, Pose]]:
        """Each obstacle, and where it is now."""
        for obstacle, record in zip(self.items.values(), self.records):
            yield obstacle, Pose(float(record['x']), float(record['y']), float(record['theta']))

    def near(self, x: float, y: float, gap: float) -> str:
        """Name of an obstacle that is nearer to the point (x, y) [m] than `gap` [m]; empty if none is."""
        for name, record in zip(self.items, self.records):
            if fast.outside(record, x, y)[0] < gap:
                return name
        return ''

    def _take(self, items: Dict[str, Obstacle], records: Array) -> None:
        self.items = items
        # NumPy has copied the type: numba would compare copies, field by field, at each call.
        self.records = records.view(OBSTACLE)
        stops = [_row(stop, self._step_rate) for obstacle in items.values() for stop in obstacle.stops]
        self.stops = np.array(stops, np.float64).reshape(-1, 6)
        counts = [len(obstacle.stops) for obstacle in items.values()]
        self.records['first'] = np.cumsum([0, *counts])[:-1]
        self.has_movers = any(counts)

    def _begun(self, obstacle: Obstacle) -> Array:
        """Array of the one record of an obstacle that begins; `first` is left open."""
        records = np.zeros(1, OBSTACLE)
        record = records[0]
        record['x'], record['y'], record['theta'] = obstacle.pose
        record['cos'], record['sin'] = math.cos(obstacle.pose.theta), math.sin(obstacle.pose.theta)
        record['half_length'], record['half_width'] = 0.5 * obstacle.length, 0.5 * obstacle.width
        record['radius'], record['reach'], record['is_seen'] = obstacle.radius, obstacle.reach, obstacle.is_seen
        record['stops'] = len(obstacle.stops)
        record['key'] = sequence(self._seed, MOVER, zlib.crc32(obstacle.name.encode())).generate_state(1)[0] >> 1
        if obstacle.stops:
            record['rest'] = pause(record, np.array([_row(obstacle.stops[0], self._step_rate)]))
        return records

    def _check_steps(self, obstacle: Obstacle) -> None:
        """Check that no point of a mover moves by more than the radius of a robot in one tick.

        Raises:
            WorldError: one does, so that the mover could pass through a robot.
        """
        for before, stop in zip((*obstacle.stops[-1:], *obstacle.stops), obstacle.stops):
            turn = abs(wrap_angle(stop.pose.theta - before.pose.theta))
            way = hypot(stop.pose.x - before.pose.x, stop.pose.y - before.pose.y) + turn * obstacle.reach
            if way > self._radius * _ticks(stop, self._step_rate):
                raise WorldError(f'{obstacle.name} moves too fast: at {self._step_rate:g} ticks a second, must move by '
                                 f'at most {self._radius * self._step_rate:g} m/s, a radius of a robot in a tick')


def _row(stop: Stop, step_rate: float) -> List[float]:
    """A stop as the kernel reads it."""
    return [*stop.pose, _ticks(stop, step_rate), stop.least * step_rate, stop.most * step_rate]


def _ticks(stop: Stop, step_rate: float) -> float:
    """How long the way to a stop takes, at least one tick."""
    return max(stop.travel * step_rate, 1.0)


def check_inside(obstacle: Obstacle, plan: FloorPlan) -> None:
    """Check that an obstacle is on the map, wherever it moves.

    Raises:
        WorldError: it lies outside.
    """
    left, bottom, right, top = plan.bounds
    for x, y, _ in [obstacle.pose, *(stop.pose for stop in obstacle.stops)]:
        if not (left - obstacle.reach < x < right + obstacle.reach
                and bottom - obstacle.reach < y < top + obstacle.reach):
            raise WorldError(f'{obstacle.name} at ({x:.2f}, {y:.2f}) m lies outside the map (x {left:.2f} to '
                             f'{right:.2f} m, y {bottom:.2f} to {top:.2f} m)')


def kept_clear(plan: FloorPlan, constants: Record, obstacles: Obstacles) -> FloorPlan:
    """The same floor, whose safe clearance also keeps clear of the obstacles that do not move."""
    fixed = obstacles.records[obstacles.records['stops'] == 0]
    if len(fixed) == 0:
        return plan
    clearance = plan.safe_clearance.copy()
    fast.keep_clear(fixed, constants, clearance)
    return plan.with_clearance(plan.clearance, clearance)
