"""Which part of a floor a brush has passed over: the one rule by which coverage is counted everywhere."""

import math
from typing import Callable, NamedTuple, Optional, Tuple

import numpy as np

from rumba_sim.model.compiling.compiled import fast
from rumba_sim.model.floors.constants import constants
from rumba_sim.model.floors.reachability import reach
from rumba_sim.model.kernel import Array
from rumba_sim.model.kernel.records import TALLY
from rumba_sim.model.kernel.sweeping.samples import PASS, REACHABLE, SWEEPABLE
from rumba_sim.model.maps.floor_plan import FloorPlan
from rumba_sim.model.settings.robot_config import RobotConfig

ANY_RATE = 50  # [Hz] `constants` asks for a rate, but the constants of a brush do not depend on it


class Brush(NamedTuple):
    """What the kernel sweeps with, for compiled callers; `samples` and `tally` change as is swept."""

    constants: Array  # one record, in an array
    samples: Array  # see `Sweep`
    no_dirt: Array  # float32 (rows, columns) of the plan
    tally: Array  # see `Sweep`


class Part(NamedTuple):
    """A part of the reachable floor."""

    share: float  # [0..1] of all of it
    coverage: float  # [0..1] of the part


class Sweep:
    """What brushes have swept of a floor.

    Each cell of the plan is divided into n x n squares, with one sample point in each. A sample is swept once a brush
    passed over it, so that a lane is as wide as the brush, whatever its heading and the resolution of the map.

    Attributes:
        samples: uint8 (n * rows, n * columns), as for `kernel`.
        tally: array of one record of type TALLY: number of swept reachable samples, and dirt left on those.
        reachable: number of reachable samples.
    """

    def __init__(self, plan: FloorPlan, config: RobotConfig, is_exact: bool = True) -> None:
        """Know no sample that can be reached: call `begin` next.

        Args:
            plan: the floor plan; the refined one of a world.
            config: of the robots.
            is_exact: as for `reachability.reach`.
        """
        self._is_exact = is_exact
        self._plan = plan
        self._config = config
        self._constants = constants(config, plan, ANY_RATE)
        self._no_dirt = np.zeros((plan.rows, plan.columns), np.float32)
        self.tally = np.zeros(1, TALLY)
        size = plan.sample_squares
        self.samples: Array = np.zeros((plan.rows * size, plan.columns * size), np.uint8)
        self.reachable = 0

    def begin(self, x: float, y: float) -> None:
        """Forget what was swept, and find out what can be reached from (x, y) [m], map frame.

        Raises:
            MapError: a robot does not fit there.
        """
        found = reach(self._plan, self._config, x, y, self._is_exact)
        self.samples = found.samples.copy()
        self.reachable = found.reachable
        self.tally.fill(0)

    def copy(self) -> 'Sweep':
        """The same state of the floor, which stays as it is if this one changes."""
        other = Sweep(self._plan, self._config, self._is_exact)
        other.samples, other.tally, other.reachable = self.samples.copy(), self.tally.copy(), self.reachable
        return other

    def take_over(self, other: 'Sweep', way_back: Optional[Callable[[Array], Array]] = None) -> None:
        """Count what was swept on another plan of the same floor.

        Args:
            other: the floor by that plan.
            way_back: where on that plan is what is at points of this one: float64 (any, 2) [m]; None if that is there
                too.
        """
        if way_back is None and math.isclose(self._plan.sample_pitch, other._plan.sample_pitch):
            self._take_window(other)
        else:
            self._take_moved(other, way_back or (lambda points: points))
        self.tally[0]['swept'] = np.count_nonzero(
            (self.samples & REACHABLE > 0) & (self.samples >= PASS))

    def _take_window(self, other: 'Sweep') -> None:
        pitch = self._plan.sample_pitch
        across, up = (round((theirs - ours) / pitch) for theirs, ours in zip(other._plan.origin, self._plan.origin))
        ours, theirs = _common(self.samples.shape, other.samples.shape, (up, across))
        passes = other.samples[theirs] & ~np.uint8(PASS - 1)
        window = self.samples[ours]
        window += np.where(window & SWEEPABLE, passes, 0).astype(np.uint8)

    def _take_moved(self, other: 'Sweep', way_back: Callable[[Array], Array]) -> None:
        """To half a square, since the points of samples lie anywhere in theirs."""
        pitch, ours = self._plan.sample_pitch, np.argwhere(self.samples & SWEEPABLE)
        there = way_back((ours[:, ::-1] + 0.5) * pitch + self._plan.origin)
        theirs = np.floor((there - other._plan.origin) / other._plan.sample_pitch).astype(np.intp)[:, ::-1]
        is_inside = ((theirs >= 0) & (theirs < other.samples.shape)).all(axis=1)
        passes = other.samples[tuple(theirs[is_inside].T)] & ~np.uint8(PASS - 1)
        self.samples[tuple(ours[is_inside].T)] += passes

    def pass_over(self, starts: Array, ends: Array) -> None:
        """Let a brush pass from poses to others that are near, map frame.

        Args:
            starts, ends: x [m], y [m] and theta [rad] of each, float64 (any, 3).
        """
        fast.sweep_moves(self._constants, self.samples, self._no_dirt, self.tally, starts, ends)

    @property
    def brush(self) -> Brush:
        """The brush that sweeps this floor."""
        return Brush(self._constants, self.samples, self._no_dirt, self.tally)

    @property
    def reachable_area(self) -> float:
        """Area that a brush can reach [m^2]."""
        return self.reachable * self._plan.sample_pitch ** 2

    @property
    def cleaned_area(self) -> float:
        """Part of the reachable area that was swept at least once [m^2]."""
        return int(self.tally['swept'][0]) * self._plan.sample_pitch ** 2

    @property
    def coverage(self) -> float:
        """cleaned_area / reachable_area [0..1]; 1 if nothing is reachable."""
        return int(self.tally['swept'][0]) / self.reachable if self.reachable else 1.0

    def planned(self, x: float, y: float) -> float:
        """Share [0..1] of what can be reached that is not behind straits for a robot that starts at (x, y) [m]."""
        return reach(self._plan, self._config, x, y, is_exact=False).reachable / max(self.reachable, 1)

    def within(self, clearance: Array, x: float, y: float) -> Part:
        """What a robot plans to reach on the same floor with less clearance; all, if it does not fit at the start then.

        Args:
            clearance: as `FloorPlan.safe_clearance` [m].
            x, y: the start [m], map frame.
        """
        plan = self._plan  # about which the last answer is known: missions ask every few seconds
        if not np.array_equal(clearance, plan.safe_clearance):
            plan = plan.with_clearance(plan.clearance, clearance)
        if not self.reachable or plan.safe_clearance_at(x, y) < self._config.drive.radius:
            return Part(1.0, self.coverage)
        found = reach(plan, self._config, x, y, is_exact=False)
        is_reachable = found.samples & REACHABLE > 0
        return Part(found.reachable / self.reachable, float((self.samples[is_reachable] >= PASS).mean()))

    def counts(self, squares: int) -> Tuple[Array, Array]:
        """Numbers of samples that can be reached, and of these that were swept, in blocks of squares.

        Args:
            squares: along the side of a block, which must divide the rows and columns of the samples.

        Returns:
            Two arrays, uint16 (rows, columns) of the blocks.
        """
        is_reachable = self.samples & REACHABLE > 0
        is_swept = is_reachable & (self.samples >= PASS)
        return _sums(is_reachable, squares), _sums(is_swept, squares)

    def missing_share(self) -> Array:
        """Share of each cell's area that can be reached and was not swept [0..1]: float32 (rows, columns)."""
        squares = self._plan.sample_squares
        return _sums(_is_missing(self.samples), squares) / np.float32(squares ** 2)


def _is_missing(samples: Array) -> Array:
    """Which samples can be reached and were not swept: bool, of the same shape."""
    is_missing = samples & REACHABLE > 0
    is_missing &= samples < PASS
    return np.asarray(is_missing)


def _common(ours: Tuple[int, ...], theirs: Tuple[int, ...],
            offset: Tuple[int, int]) -> Tuple[Tuple[slice, ...], Tuple[slice, ...]]:
    """What two grids have in common, the corner of one of which lies at an offset (rows, columns) of the other."""
    starts = [(max(by, 0), min(mine, by + other)) for mine, other, by in zip(ours, theirs, offset)]
    return (tuple(slice(low, max(high, low)) for low, high in starts),
            tuple(slice(low - by, max(high, low) - by) for (low, high), by in zip(starts, offset)))


def _sums(samples: Array, squares: int) -> Array:
    """Number of true samples in each block of squares: uint16 (rows, columns) of the blocks."""
    sums = np.zeros((samples.shape[0] // squares, samples.shape[1] // squares), np.uint16)
    for row in range(squares):
        for column in range(squares):
            sums += samples[row::squares, column::squares]
    return sums
