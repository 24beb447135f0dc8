"""What is measured of a drive, tick by tick; docs/glossary.md gives the formulas and their sources."""

import dataclasses
import math
from typing import List, NamedTuple, Tuple

import numpy as np
from scipy import ndimage

from rumba_sim.model.compiling.compiled import fast
from rumba_sim.model.kernel import Array
from rumba_sim.model.kernel.sweeping.samples import PASS, REACHABLE
from rumba_sim.model.maps.floor_plan import FloorPlan
from rumba_sim.model.simulation.robot import Robot
from rumba_sim.model.simulation.world import World

CONTACT = 0.001  # [m] a smaller gap between body and wall is a contact: more than the model leaves there
NEAR = 0.02  # [m] a smaller gap without a contact is a near miss; our choice: the cells of a fine map
PAUSE = 0.5  # [s] two contacts, near misses or turns with less between them are one; our choice
RADIUS = 0.5  # [m] of a curve: a tighter one is turned, a wider one is driven; our choice: three brushes
TURN = math.radians(45.0)  # a curve of less is no turn; our choice: half of a corner of a room


class Event(NamedTuple):
    """A collision or a near miss: where body and wall were nearest to each other."""

    time: float  # [s] since the start
    x: float  # [m] of the robot, map frame
    y: float  # [m]
    gap: float  # [m] from body to wall; negative if they overlap
    duration: float  # [s]


class Patch(NamedTuple):
    """A part of the floor that was never reached."""

    x: float  # [m] its middle, map frame
    y: float  # [m]
    area: float  # [m^2]


@dataclasses.dataclass(frozen=True)
class Measures:
    """What a drive was like, beside its coverage."""

    path_length: float  # [m]
    turns: int
    turned_angle: float  # [rad] left and right added up
    time_in_turns: float  # [s]
    overlap_ratio: float  # [0..1] swept more than once / swept at least once; 0 if nothing was swept
    revisit_ratio: float  # [0..] mean number of passes over swept floor beyond the first; 0 if nothing was swept
    collisions: Tuple[Event, ...]
    near_misses: Tuple[Event, ...]
    cells_never_reached: int  # of the map, with floor that could have been swept, of which nothing was
    never_reached: Tuple[Patch, ...]  # connected parts of them, the largest first


class Observer:
    """Looks at one robot of a world after each tick."""

    def __init__(self, world: World, robot: Robot) -> None:
        """Begin with where the robot is now."""
        self._world = world
        self._robot = robot
        self._poses: List[Tuple[float, float, float]] = []
        self._gaps: List[float] = []
        self._reach = float(world.constants[0]['reach'])
        self._begin = world.tick
        self.look()

    def advance(self, ticks: int) -> None:
        """Let time pass, and look after each tick."""
        for _ in range(ticks):
            self._world.step()
            self.look()

    def look(self) -> None:
        """Note pose and gap."""
        state = self._robot.state
        x, y = float(state['x']), float(state['y'])
        gap = self._world.terrain.clearance_at(x, y) - self._reach
        records = self._world.obstacles.records
        if len(records):
            radius = self._robot.config.drive.radius
            gap = min(gap, fast.nearest_obstacle(records, x, y, gap + 2.0 * radius)[0] - radius)
        self._poses.append((x, y, float(state['theta'])))
        self._gaps.append(gap)

    @property
    def path(self) -> Array:
        """Poses after all ticks, and the first: float64 (any, 3) [m, m, rad]."""
        return np.array(self._poses)

    def measures(self) -> Measures:
        """The measures so far."""
        dt, path = 1.0 / self._world.step_rate, self.path
        lengths, angles = np.hypot(*np.diff(path[:, :2], axis=0).T), _wrapped(np.diff(path[:, 2]))
        turns = turns_in(lengths, angles, round(PAUSE / dt))
        contacts, near = events(path, np.array(self._gaps), self._world.step_rate, self._begin)
        overlap, revisit = ratios(self._world.floor.sweep.samples)
        missed = self._world.swept() == 0
        return Measures(
            path_length=float(np.sum(lengths)), turns=len(turns), turned_angle=float(np.sum(np.abs(angles))),
            time_in_turns=dt * sum(end - begin for begin, end in turns), overlap_ratio=overlap, revisit_ratio=revisit,
            collisions=contacts, near_misses=near, cells_never_reached=int(np.count_nonzero(missed)),
            never_reached=patches(missed, self._world.plan))


def _wrapped(angles: Array) -> Array:
    return (angles + math.pi) % (2.0 * math.pi) - math.pi


def ratios(samples: Array) -> Tuple[float, float]:
    """Overlap ratio and revisit ratio of a floor, from the passes over its samples (`kernel`)."""
    passes = (samples // PASS)[samples & REACHABLE > 0]
    swept = int(np.count_nonzero(passes))
    if not swept:
        return 0.0, 0.0
    return int(np.count_nonzero(passes > 1)) / swept, int(np.sum(passes, dtype=np.int64)) / swept - 1.0


def runs(mask: Array, pause: int) -> List[Tuple[int, int]]:
    """First element, and the one after the last, of each run of true elements; a shorter pause does not end a run."""
    edges = np.diff(np.concatenate([[0], mask.astype(np.int8), [0]]))
    found: List[Tuple[int, int]] = []
    for begin, end in zip(np.flatnonzero(edges > 0).tolist(), np.flatnonzero(edges < 0).tolist()):
        if found and begin - found[-1][1] < pause:
            found[-1] = (found[-1][0], end)
        else:
            found.append((begin, end))
    return found


def turns_in(lengths: Array, angles: Array, pause: int) -> List[Tuple[int, int]]:
    """The turns of a drive, as runs of ticks.

    Args:
        lengths: driven in each tick, float64 (any) [m].
        angles: turned in each tick, float64 (any) [rad].
        pause: ticks between two turns in one direction, at least.
    """
    is_tight = np.abs(angles) * RADIUS > np.maximum(lengths, 1e-6)
    found = [run for side in (1.0, -1.0) for run in runs(is_tight & (side * angles > 0.0), pause)]
    return sorted(run for run in found if abs(float(np.sum(angles[run[0]:run[1]]))) >= TURN)


def events(path: Array, gaps: Array, rate: float, begin: int) -> Tuple[Tuple[Event, ...], Tuple[Event, ...]]:
    """Collisions and near misses.

    Args:
        path: poses after the ticks, float64 (any, 3).
        gaps: from body to wall there, float64 (any) [m].
        rate: ticks per second [Hz].
        begin: tick of the first of them.
    """
    pause = round(PAUSE * rate)

    def event(first: int, end: int) -> Event:
        nearest = first + int(np.argmin(gaps[first:end]))
        return Event((begin + nearest) / rate, float(path[nearest, 0]), float(path[nearest, 1]), float(gaps[nearest]),
                     (end - first) / rate)

    contacts = runs(gaps < CONTACT, pause)
    near = [run for run in runs(gaps < NEAR, pause) if gaps[run[0]:run[1]].min() >= CONTACT]
    return tuple(event(*run) for run in contacts), tuple(event(*run) for run in near)


def patches(missed: Array, plan: FloorPlan) -> Tuple[Patch, ...]:
    """Connected parts of the cells that were missed, the largest first.

    Args:
        missed: bool (rows, columns) of the cells of the plan.
        plan: the floor plan.
    """
    labels, count = ndimage.label(missed, np.ones((3, 3)))
    if not count:
        return ()
    numbers = np.arange(1, count + 1)
    cells = ndimage.sum(missed, labels, numbers)
    middles = ndimage.center_of_mass(missed, labels, numbers)
    found = [Patch(plan.origin[0] + (column + 0.5) * plan.resolution, plan.origin[1] + (row + 0.5) * plan.resolution,
                   float(size) * plan.resolution ** 2) for (row, column), size in zip(middles, cells)]
    return tuple(sorted(found, key=lambda patch: (-patch.area, patch.x, patch.y)))
