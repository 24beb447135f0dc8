"""Cuts a floor into blocks of parallel lanes; the lanes of a block run in the direction that suits it better.

The boustrophedon decomposition (H. Choset, Coverage of Known Spaces: The Boustrophedon Cellular Decomposition,
Autonomous Robots 9, 2000), lane by lane: a block grows while the next lane lies beside the last one and is about as
long. What Choset calls a cell is called a block here, since a cell is a square of the grid.
"""

import math
from typing import List, NamedTuple, Optional, Tuple

import numpy as np

from rumba_cleaning.belief.ground import Ground
from rumba_cleaning.planning import compiled_lanes
from rumba_cleaning.planning.turned_floor import TurnedFloor
from rumba_sim.model.kernel import Array
from rumba_sim.model.reachability import SLACK

# All figures are our choice; each comment says what speaks for a larger and for a smaller value.
LEAST = 0.08  # [m] length of a lane, half a brush: a shorter one is left to the crumbs
TURN, BLOCK = 2.2, 3.0  # [s] estimates of the time from lane to lane, and from block to block: large wants long lanes
POOR = 0.12  # share of brush * speed: a block that cleans less is left to the crumbs
JOIN = 2  # [cells] that were swept, between cells that one lane shall still clean: noise, not a gap
Window = Tuple[slice, slice]  # rows and columns
Run = Tuple[int, int]  # columns: the first, and the one after the last


class Layout(NamedTuple):
    """How lanes are laid out."""

    overlap: float = 0.05  # of two lanes, share of the brush's width: small drives less, large leaves nothing between
    needed: float = 0.12  # share of the brush's width that was missed, for a lane to be needed: large leaves more
    # A block is worth area - usual * brush * speed * time: large prefers blocks that waste little, small large ones.
    usual: float = 0.3
    gap: float = 0.5  # [m] of swept floor within a lane: large saves turns, small saves distance
    alike: float = 1.5  # ratio of the lengths of two neighbouring lanes, at most: large makes fewer blocks


class Block(NamedTuple):
    """Lanes side by side."""

    lanes: List[Array]  # float64 (2, 2) [m] each: both ends, map frame; all lanes in the same direction
    area: float  # [m^2] that they clean
    time: float  # [s] that this takes, about


class _Lane(NamedTuple):
    """In nodes of the grid: the columns of its ends, and the row (with fractions) of the robot's centre."""

    first: int
    last: int
    across: float


def blocks(ground: Ground, missed: Array, brush: float, speed: float, angle: float = 0.0,
           layout: Layout = Layout()) -> List[Block]:
    """Blocks whose lanes clean what was missed, except for crumbs.

    Args:
        ground: where the robot can stand.
        missed: the cells to clean, bool (rows, columns).
        brush: width of the brush [m].
        speed: along the lanes [m/s].
        angle: between the lanes and the map's axes [rad].
        layout: how the lanes are laid out.
    """
    found: List[Block] = []
    floor = TurnedFloor(ground, missed, angle)
    rate = brush * speed
    whole = _window(floor.missed, math.ceil(brush / floor.resolution))
    remaining = floor.missed[whole].copy()
    while remaining.any():  # in each round the best block, and each other that has no better one near it
        grids = [_Grid(floor, remaining, whole, ground.reach + SLACK, brush, along_x, layout)
                 for along_x in (True, False)]
        choices = [(block.area - layout.usual * rate * block.time, block, grid, lanes)
                   for grid in grids for block, lanes in grid.blocks(speed) if block.area > POOR * rate * block.time]
        if not choices:
            break
        claimed = np.zeros_like(remaining)
        for _, block, grid, lanes in sorted(choices, key=lambda choice: -choice[0]):
            window = grid.window(lanes)
            if not claimed[window].any():
                grid.take(lanes, remaining)
                found.append(block)
            claimed[window] = True
    return found


class _Grid:
    """The part of a floor that holds all cells to clean, transposed if the lanes run along y: they run along a row.

    Rows and columns are counted from the corner of this part; lengths are in cells.
    """

    def __init__(self, floor: TurnedFloor, missed: Array, window: Window, clearance: float, brush: float,
                 along_x: bool, layout: Layout) -> None:
        """Take the part of a floor.

        Args:
            floor: with the clearance at its nodes.
            missed: the cells to clean, bool (rows, columns) of this part.
            window: its rows and columns on the floor.
            clearance: that the robot needs at its centre [m].
            brush: width of the brush [m].
            along_x: whether the lanes run along x of the floor, or along y.
            layout: of the lanes.
        """
        self._window = window
        rows, columns = self._window
        nodes = floor.clearance[rows.start:rows.stop + 1, columns.start:columns.stop + 1]  # one more than cells
        self._clearance = np.ascontiguousarray(nodes if along_x else nodes.T)
        self._along_x = along_x
        self._missed = self._view(missed)
        self._floor = floor
        self._resolution = floor.resolution
        self._half = 0.5 * (1.0 - layout.overlap) * brush / self._resolution  # [cells] half of what a lane cleans
        self._needed_clearance = clearance
        self._gap = int(layout.gap / self._resolution)
        self._least = max(int(LEAST / self._resolution), 1)
        self._layout = layout
        self._remaining = self._missed

    def _view(self, missed: Array) -> Array:
        """Bool (rows, columns) of this part of the floor, as a view with rows along the lanes."""
        return missed if self._along_x else missed.T

    def window(self, lanes: List[_Lane]) -> Tuple[slice, slice]:
        """Rows and columns of this part around lanes, with the margin in which these lanes change other blocks."""
        margin = math.ceil(self._half)
        across = [lane.across for lane in lanes]
        rows = slice(int(min(across)) - 2 * margin, int(max(across)) + 2 * margin + 1)
        columns = slice(min(lane.first for lane in lanes) - margin, max(lane.last for lane in lanes) + margin)
        rows, columns = (rows, columns) if self._along_x else (columns, rows)
        return slice(max(rows.start, 0), rows.stop), slice(max(columns.start, 0), columns.stop)

    def take(self, lanes: List[_Lane], missed: Array) -> None:
        """Set to False what lanes clean, in bool (rows, columns) of this part of the floor."""
        view = self._view(missed)
        for lane in lanes:
            view[self._band(lane.across), lane.first:lane.last] = False

    def blocks(self, speed: float) -> List[Tuple[Block, List[_Lane]]]:
        """All blocks, from the lowest row upward, as if no lanes ran in the other direction."""
        self._remaining = self._missed.copy()
        found: List[Tuple[Block, List[_Lane]]] = []
        bottom = 0  # nothing remains below
        while True:
            lowest = self._lowest(bottom, len(self._remaining), (0, self._remaining.shape[1]))
            if lowest is None:
                return found
            bottom, run = lowest
            lanes, count = self._grow(bottom, run)
            if lanes:
                area = count * self._resolution ** 2
                time = BLOCK + sum((lane.last - lane.first) * self._resolution / speed + TURN for lane in lanes)
                found.append((Block([self._metres(lane) for lane in lanes], area, time), lanes))

    def _grow(self, row: int, run: Run) -> Tuple[List[_Lane], int]:
        """The lanes of one block, from its lowest row upward, and the number of cells they clean.

        These cells remain no longer.
        """
        lanes: List[_Lane] = []
        count = 0
        while True:
            lane = self._lane(row, run, lanes[-1].across if lanes else None)
            if lane is None:
                self._remaining[row, run[0]:run[1]] = False
                return lanes, count
            alike = self._layout.alike
            if lanes and not 1.0 / alike < (lane.last - lane.first) / (lanes[-1].last - lanes[-1].first) < alike:
                return lanes, count
            band = self._band(lane.across)
            count += np.count_nonzero(self._remaining[band, lane.first:lane.last])
            self._remaining[band, lane.first:lane.last] = False
            self._remaining[row, max(run[0], lane.first):min(run[1], lane.last)] = False
            lanes.append(lane)
            above = self._lowest(band.stop - 1, min(int(lane.across + 3.0 * self._half), len(self._remaining)),
                                 (lane.first, lane.last))
            if above is None:
                return lanes, count
            row, run = above

    def _lowest(self, bottom: int, top: int, columns: Run) -> Optional[Tuple[int, Run]]:
        """The lowest row from bottom to top that has a long run within columns, and its longest run there."""
        row, first, after = compiled_lanes.lowest(self._remaining, bottom, top, columns[0], columns[1], JOIN,
                                                  self._least)
        return None if row == compiled_lanes.NO_ROW else (row, (first, after))

    def _lane(self, row: int, run: Run, below: Optional[float]) -> Optional[_Lane]:
        """The lane that cleans a run of a row and as much as possible above it.

        Args:
            row, run: the lowest cells that it has to clean.
            below: position (row, with fractions) of the lane before; None if this is the first of its block.
        """
        beside = below is not None and row <= below + self._half + 0.6  # no whole row lies between the two lanes
        highest = below + 2.0 * self._half if below is not None and beside else row + self._half
        first, last, across = compiled_lanes.lane(
            self._remaining, self._clearance, self._needed_clearance, run, highest, self._half, self._least, self._gap,
            self._layout.needed)
        return _Lane(first, last, across) if last > first else None

    def _band(self, across: float) -> slice:
        """The rows whose centres the brush passes over."""
        return slice(*compiled_lanes.band(across, self._half))

    def _metres(self, lane: _Lane) -> Array:
        """Both ends of a lane: float64 (2, 2) [m], map frame."""
        ends = np.array([[lane.first, lane.across], [lane.last, lane.across]])
        rows, columns = self._window
        return self._floor.points((ends if self._along_x else ends[:, ::-1]) + (columns.start, rows.start))


def _window(missed: Array, margin: int) -> Window:
    """The part of bool (rows, columns) that is not False, and a margin [cells] around it."""
    rows, columns = np.flatnonzero(missed.any(axis=1)), np.flatnonzero(missed.any(axis=0))
    if len(rows) == 0:
        return slice(0, 0), slice(0, 0)
    top, left = max(int(rows[0]) - margin, 0), max(int(columns[0]) - margin, 0)
    return slice(top, int(rows[-1]) + 1 + margin), slice(left, int(columns[-1]) + 1 + margin)
