"""Cuts a floor into cells that are swept in parallel lanes, each cell in its better direction.

The boustrophedon decomposition (H. Choset, Coverage of Known Spaces: The Boustrophedon Cellular Decomposition,
Autonomous Robots 9, 2000), lane by lane: a cell grows as long as the next lane lies beside the last one and is about
as long.
"""

import math
from typing import List, NamedTuple, Optional, Tuple

import numpy as np
from scipy import ndimage

from rumba_cleaning.belief.ground import MARGIN, Ground
from rumba_cleaning.planning.turned_floor import TurnedFloor
from rumba_sim.model.kernel import Array

GAP = 0.5  # [m] of floor that needs no sweeping, and still does not part a lane in two
LEAST = 0.08  # [m] a lane that is shorter is none
ALIKE = 1.5  # lanes of one cell differ from one to the next in length by no more than this factor
TURN, CELL = 2.2, 3.0  # [s] that the way from lane to lane, and from cell to cell, takes about
USUAL = 0.3  # of brush * speed is what cells clean anyway: the best cell is the one that cleans most beyond that
POOR = 0.12  # of brush * speed: a cell that cleans less is left to the crumbs
NEEDED = 0.12  # share of the brush that finds something to sweep, where a lane is needed
Run = Tuple[int, int]  # first, and after the last


class Cell(NamedTuple):
    """Lanes side by side."""

    lanes: List[Array]  # float64 (2, 2) [m] each: both ends, all the same way round
    area: float  # [m^2] that they clean
    time: float  # [s] that this takes about


class _Lane(NamedTuple):
    """In cells of the grid: columns of its ends, and how high the middle of the robot drives."""

    first: int
    last: int
    across: float


def cells(ground: Ground, missed: Array, brush: float, speed: float, angle: float = 0.0) -> List[Cell]:
    """Cells whose lanes clean what was missed, bool (rows, columns), but for crumbs.

    Args:
        ground: where the robot can stand.
        missed: what there is to clean.
        brush: width of the brush [m].
        speed: along the lanes [m/s].
        angle: between the lanes and the map's axes [rad].
    """
    found: List[Cell] = []
    floor = TurnedFloor(ground, missed, angle)
    left = floor.missed.copy()
    rate = brush * speed
    while left.any():  # the best cell, with all others that have no better one near, until none is worth it
        grids = [_Grid(floor, left, ground.reach + MARGIN, brush, along_x) for along_x in (True, False)]
        choices = [(cell.area - USUAL * rate * cell.time, cell, grid, lanes)
                   for grid in grids for cell, lanes in grid.cells(speed) if cell.area > POOR * rate * cell.time]
        if not choices:
            break
        claimed = np.zeros_like(left)
        for _, cell, grid, lanes in sorted(choices, key=lambda choice: -choice[0]):
            window = grid.window(lanes)
            if not claimed[window].any():
                grid.take(lanes, left)
                found.append(cell)
            claimed[window] = True
    return found


class _Grid:
    """What is to be cleaned, turned so that lanes run along its columns."""

    def __init__(self, floor: TurnedFloor, missed: Array, reach: float, brush: float, along_x: bool) -> None:
        margin = math.ceil(brush / floor.resolution)
        self._window = tuple(slice(max(part.start - margin, 0), part.stop + margin)
                             for part in ndimage.find_objects(missed.astype(np.int8))[0])
        rows, columns = self._window
        room = floor.room[rows.start:rows.stop + 1, columns.start:columns.stop + 1]  # a node more than cells
        self._room = room if along_x else room.T
        self._along_x = along_x
        self._missed = self._turned(missed)
        self._floor = floor
        self._resolution = floor.resolution
        self._half = 0.5 * brush / self._resolution
        self._fits = reach
        self._gap = int(GAP / self._resolution)
        self._least = max(int(LEAST / self._resolution), 1)
        self._left = self._missed

    def _turned(self, missed: Array) -> Array:
        """A view of what was missed as this grid sees it."""
        return missed[self._window] if self._along_x else missed[self._window].T

    def window(self, lanes: List[_Lane]) -> Tuple[slice, slice]:
        """Where lanes are, and as much around them as tells on other cells: rows and columns."""
        margin = math.ceil(self._half)
        across = [lane.across for lane in lanes]
        rows = slice(int(min(across)) - 2 * margin, int(max(across)) + 2 * margin + 1)
        columns = slice(min(lane.first for lane in lanes) - margin, max(lane.last for lane in lanes) + margin)
        rows, columns = (rows, columns) if self._along_x else (columns, rows)
        top, left = self._window[0].start, self._window[1].start
        return (slice(max(rows.start + top, 0), rows.stop + top),
                slice(max(columns.start + left, 0), columns.stop + left))

    def take(self, lanes: List[_Lane], missed: Array) -> None:
        """Clean with lanes what was missed."""
        view = self._turned(missed)
        for lane in lanes:
            view[self._band(lane.across), lane.first:lane.last] = False

    def cells(self, speed: float) -> List[Tuple[Cell, List[_Lane]]]:
        """All cells, from the lowest lane upward."""
        self._left = self._missed.copy()
        found: List[Tuple[Cell, List[_Lane]]] = []
        while True:
            run = self._lowest(0, len(self._left), (0, self._left.shape[1]))
            if run is None:
                return found
            lanes, count = self._grow(*run)
            if lanes:
                area = count * self._resolution ** 2
                time = CELL + sum((lane.last - lane.first) * self._resolution / speed + TURN for lane in lanes)
                found.append((Cell([self._metres(lane) for lane in lanes], area, time), lanes))

    def _grow(self, row: int, run: Run) -> Tuple[List[_Lane], int]:
        """The lanes of one cell, from its lowest row on, and how much they clean; that is left no more."""
        lanes: List[_Lane] = []
        count = 0
        while True:
            lane = self._lane(row, run, lanes[-1].across if lanes else None)
            if lane is None:
                self._left[row, run[0]:run[1]] = False
                return lanes, count
            if lanes and not 1.0 / ALIKE < (lane.last - lane.first) / (lanes[-1].last - lanes[-1].first) < ALIKE:
                return lanes, count
            band = self._band(lane.across)
            count += np.count_nonzero(self._left[band, lane.first:lane.last])
            self._left[band, lane.first:lane.last] = False
            self._left[row, max(run[0], lane.first):min(run[1], lane.last)] = False
            lanes.append(lane)
            above = self._lowest(band.stop - 1, min(int(lane.across + 3.0 * self._half), len(self._left)),
                                 (lane.first, lane.last))
            if above is None:
                return lanes, count
            row, run = above

    def _lowest(self, bottom: int, top: int, columns: Run) -> Optional[Tuple[int, Run]]:
        """The lowest row that has something left within columns, and its longest run there."""
        for row in bottom + np.flatnonzero(self._left[bottom:top, slice(*columns)].any(axis=1)):
            inside = [run for run in _runs(self._left[row], 2) if run[0] < columns[1] and run[1] > columns[0]]
            longest = max(inside, key=lambda run: run[1] - run[0])
            if longest[1] - longest[0] >= self._least:
                return int(row), longest
            if columns == (0, self._left.shape[1]):
                self._left[row] = False  # nothing but crumbs
        return None

    def _lane(self, row: int, run: Run, below: Optional[float]) -> Optional[_Lane]:
        """The lane that cleans the run and as much above it as can be; `below` is the height of the lane before."""
        beside = below is not None and row <= below + self._half + 0.6
        highest = below + 2.0 * self._half if below is not None and beside else row + self._half
        for across in np.arange(highest, highest - 2.0 * self._half - 0.51, -0.5):
            for first, after in _runs(self._fits_at(across), 0):
                low, high = max(first, run[0]), min(after - 1, run[1])
                if high - low < min(self._least, run[1] - run[0]):
                    continue
                band = self._left[self._band(across), first:after - 1]
                if len(band):
                    for start, end in _runs(band.mean(axis=0) > NEEDED, self._gap):
                        if start + first < high and end + first > low:
                            return _Lane(start + first, end + first, float(across))
        return None

    def _fits_at(self, across: float) -> Array:
        """At which nodes along a lane the robot can stand: bool (columns + 1)."""
        row = min(max(int(across), 0), len(self._room) - 2)
        share = across - row
        return np.asarray(self._room[row] * (1.0 - share) + self._room[row + 1] * share >= self._fits)

    def _band(self, across: float) -> slice:
        """The rows whose middle the brush passes over."""
        return slice(max(math.floor(across - self._half + 0.5), 0), max(math.floor(across + self._half + 0.5), 0))

    def _metres(self, lane: _Lane) -> Array:
        ends = np.array([[lane.first, lane.across], [lane.last, lane.across]])
        rows, columns = self._window
        return self._floor.places((ends if self._along_x else ends[:, ::-1]) + (columns.start, rows.start))


def _runs(flags: Array, gap: int) -> List[Run]:
    """Runs of True in bool (any), those with at most `gap` between them joined."""
    steps = np.diff(np.concatenate([[0], flags.astype(np.int8), [0]]))
    joined: List[Run] = []
    for first, after in zip(np.flatnonzero(steps == 1).tolist(), np.flatnonzero(steps == -1).tolist()):
        if joined and first - joined[-1][1] <= gap:
            joined[-1] = (joined[-1][0], after)
        else:
            joined.append((first, after))
    return joined
