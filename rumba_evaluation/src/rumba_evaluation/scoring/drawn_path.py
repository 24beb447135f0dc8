"""A path that somebody planned, with the checks that any source of it must pass."""

import dataclasses
import math
from typing import Optional, Sequence, Tuple

import numpy as np

from rumba_sim.model.common.errors import RumbaError
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.kernel import Array
from rumba_sim.model.maps.floor_plan import FREE, FloorPlan

MOST_POSES = 1_000_000
LONGEST = 86_400.0  # [s] a day
LEAST_LENGTH = 0.01  # [m] of a path
SAME = 1e-6  # [rad] headings that differ by less are one heading


class PathError(RumbaError):
    """A path cannot be read, or no robot can begin it."""


@dataclasses.dataclass(frozen=True)
class DrawnPath:
    """Poses in the order in which they are to be visited.

    Attributes:
        source: what messages call the path: its file.
        places: what messages call each pose: its line of the file, or its number.
        points: float64 (any, 2) [m], map frame.
        headings: float64 (any) [rad]; None if the source has none, or the same for all poses of a bent path.
        times: float64 (any) [s] since the first pose, increasing; None if the source has none, or one for all poses.
    """

    source: str
    places: Sequence[str]
    points: Array
    headings: Optional[Array]
    times: Optional[Array]

    @property
    def start(self) -> Pose:
        """Where the path begins, and in which direction."""
        x, y = self.points[0].tolist()
        if self.headings is not None:
            return Pose(x, y, float(self.headings[0]))
        away = self.points - self.points[0]
        first = int(np.argmax(np.hypot(*away.T) > 0.0))
        return Pose(x, y, math.atan2(away[first, 1], away[first, 0]))

    def at(self, index: int) -> str:
        """What a message calls a pose."""
        return f'{self.source}, {self.places[index]}'


def drawn_path(source: str, places: Sequence[str], points: Array, headings: Optional[Array],
               times: Optional[Array]) -> DrawnPath:
    """Check what was read, and leave out headings and times that mean nothing.

    Planners that do not tell headings or times often fill these fields with one value.

    Raises:
        PathError: there are too few poses or too many, a value is not a finite number, or the time goes back.
    """
    if len(points) < 2:
        raise PathError(f'{source}: has {len(points) or "no"} pose{"s" * (not len(points))}: must have two or more')
    if len(points) > MOST_POSES:
        raise PathError(f'{source}: has more than {MOST_POSES} poses: leave some out')
    for what, values in (('position', points), ('heading', headings), ('time', times)):
        bad = np.zeros(0, int) if values is None else np.flatnonzero(~np.isfinite(values.reshape(len(points), -1))
                                                                     .all(axis=1))
        if len(bad):
            raise PathError(f'{source}, {places[bad[0]]}: the {what} must be finite numbers')
    if float(np.sum(np.hypot(*np.diff(points, axis=0).T))) < LEAST_LENGTH:
        raise PathError(f'{source}: is shorter than {LEAST_LENGTH:g} m: a path leads somewhere')
    if headings is not None and _is_one(headings, points):
        headings = None
    if times is not None:
        times = None if np.ptp(times) == 0.0 else times - times[0]
    path = DrawnPath(source, places, points, headings, times)
    _check_times(path)
    return path


def _is_one(headings: Array, points: Array) -> bool:
    """Whether all headings are the same although the path is bent, or leads elsewhere."""
    if np.ptp(np.unwrap(headings)) > SAME:
        return False
    off = points - points[0]
    beside = np.cos(headings[0]) * off[:, 1] - np.sin(headings[0]) * off[:, 0]
    return bool(np.max(np.abs(beside)) > LEAST_LENGTH)


def _check_times(path: DrawnPath) -> None:
    if path.times is None:
        return
    steps = np.diff(path.times)
    back = np.flatnonzero(steps <= 0.0)
    if len(back):
        index = int(back[0]) + 1
        how = 'goes back' if steps[index - 1] < 0.0 else 'stands still'
        raise PathError(f'{path.at(index)}: the time {how} ({path.times[index]:g} s after {path.times[index - 1]:g} s '
                        'since the first pose): times must increase')
    if path.times[-1] > LONGEST:
        raise PathError(f'{path.source}: takes {path.times[-1]:.0f} s: must take a day at most')


def check_on_map(path: DrawnPath, plan: FloorPlan) -> None:
    """Refuse a path with poses outside a map or in its walls.

    Raises:
        PathError: there is such a pose; the message names the first.
    """
    rows, columns = _cells(plan, path.points)
    outside = (rows < 0) | (columns < 0) | (rows >= plan.rows) | (columns >= plan.columns)
    if outside.any():
        index = int(np.argmax(outside))
        left, bottom, right, top = plan.bounds
        raise PathError(f'{_pose(path, index)} lies outside the map {plan.name} (x {left:.2f} to {right:.2f} m, '
                        f'y {bottom:.2f} to {top:.2f} m){_others(outside)}')
    blocked = plan.occupancy[rows, columns] != FREE
    if blocked.any():
        index = int(np.argmax(blocked))
        raise PathError(f'{_pose(path, index)} lies in a wall of the map {plan.name}, or where that is '
                        f'unknown{_others(blocked)}')


def _cells(plan: FloorPlan, points: Array) -> Tuple[Array, Array]:
    columns, rows = (np.floor((points - plan.origin) / plan.resolution).clip(-1, 1e9).astype(np.int64)).T
    return rows, columns


def _pose(path: DrawnPath, index: int) -> str:
    x, y = path.points[index]
    return f'{path.at(index)}: ({x:.2f}, {y:.2f}) m'


def _others(bad: Array) -> str:
    count = int(np.count_nonzero(bad)) - 1
    return f'; so do{"es" * (count == 1)} {count} more' if count else ''
