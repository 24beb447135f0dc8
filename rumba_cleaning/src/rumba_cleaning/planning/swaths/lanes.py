"""Cuts a floor into blocks of parallel lanes; the lanes of a block run in the direction that suits it better.

The boustrophedon decomposition (H. Choset, Coverage of Known Spaces: The Boustrophedon Cellular Decomposition,
Autonomous Robots 9, 2000), lane by lane: a block grows while the next lane lies beside the last one and is about as
long. What Choset calls a cell is called a block here, since a cell is a square of the grid.
"""

import math
from typing import List, NamedTuple, Tuple

import numpy as np

from rumba_cleaning.belief import paths
from rumba_cleaning.belief.ground import Ground
from rumba_cleaning.planning.common.stretches import Variant, pair
from rumba_cleaning.planning.decompose.turned_floor import TurnedFloor, Window
from rumba_cleaning.planning.swaths import compiled_lanes
from rumba_sim.model.compiling.jit import plain
from rumba_sim.model.floors.reachability import SLACK
from rumba_sim.model.kernel import Array

# All figures are our choice; each comment says what speaks for a larger and for a smaller value.
TURN, BLOCK = 2.2, 3.0  # [s] estimates of the time from lane to lane, and from block to block: large wants long lanes
POOR = 0.12  # share of brush * speed: a block that cleans less is left to the crumbs
JOIN = 2  # [cells] that were swept, between cells that one lane shall still clean: noise, not a gap


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


def blocks(ground: Ground, missed: Array, within: Window, brush: float, speed: float, angle: float = 0.0,
           layout: Layout = Layout()) -> List[Block]:
    """Blocks whose lanes clean what was missed, except for crumbs.

    Args:
        ground: where the robot can stand.
        missed: the cells to clean, bool (rows, columns).
        within: the window that holds them.
        brush: width of the brush [m].
        speed: along the lanes [m/s].
        angle: between the lanes and the map's axes [rad].
        layout: how the lanes are laid out.
    """
    found: List[Block] = []
    floor = TurnedFloor(ground, missed, within, angle, brush)
    rate = brush * speed
    remaining = floor.missed.copy()
    grids = [_Grid(floor, remaining, ground.reach + SLACK, brush, along_x, layout) for along_x in (True, False)]
    while remaining.any():  # in each round the best block, and each other that has no better one near it
        choices = [(area - layout.usual * rate * time, area, time, grid, lanes)
                   for grid in grids for lanes, area, time in grid.blocks(speed) if area > POOR * rate * time]
        if not choices:
            break
        claimed = np.zeros_like(remaining)
        for _, area, time, grid, lanes in sorted(choices, key=lambda choice: -choice[0]):
            window = grid.window(lanes)
            if not claimed[window].any():
                grid.take(lanes)
                found.append(Block(grid.metres(lanes), area, time))
            claimed[window] = True
    return found


def block_variants(ground: Ground, lanes: List[Array], path: Array) -> List[Variant]:
    """The paths through the lanes of a block, in pairs: from each end of the first lane, and backward.

    Args:
        ground: where the robot can stand.
        lanes: float64 (2, 2) [m] each, side by side, all in the same direction.
        path: through them, as `through` finds it, from the end 0.
    """
    return pair([path]) + (pair([through(ground, lanes, 1)]) if len(lanes) > 1 else [])


def through(ground: Ground, lanes: List[Array], first: int) -> Array:
    """The path through lanes, to and fro: float64 (any, 2) [m]; it begins at the end `first`, 0 or 1, of lane 0."""
    parts: List[Array] = []
    for index, lane in enumerate(lanes):
        ends = lane if index % 2 == first else lane[::-1]
        way = paths.between(ground, parts[-1][-1], ends[0]) if parts else None
        parts += [ends] if way is None else [way[1:-1], ends]
    return np.concatenate(parts)


class _Grid:
    """A floor, transposed if the lanes run along y: they run along a row. Lengths are in cells.

    Lanes are float64 (any, 3): the column at which each begins, the one after its last, and the row (with fractions) of
    the robot's centre.
    """

    def __init__(self, floor: TurnedFloor, missed: Array, clearance: float, brush: float, along_x: bool,
                 layout: Layout) -> None:
        """Take a floor.

        Args:
            floor: with the clearance at its nodes.
            missed: the cells of it that are left to clean, bool (rows, columns): as they are when blocks are found.
            clearance: that the robot needs at its centre [m].
            brush: width of the brush [m].
            along_x: whether the lanes run along x of the floor, or along y.
            layout: of the lanes.
        """
        self._clearance = np.ascontiguousarray(floor.clearance if along_x else floor.clearance.T)
        self._along_x = along_x
        self._missed = missed if along_x else missed.T  # a view
        self._floor = floor
        self._resolution = floor.resolution
        half = 0.5 * brush / self._resolution
        self._rule = compiled_lanes.Rule(clearance, (1.0 - layout.overlap) * half, max(int(half), 1), JOIN,
                                         int(layout.gap / self._resolution), layout.needed, layout.alike)

    def window(self, lanes: Array) -> Window:
        """Rows and columns of the floor around lanes, with the margin in which these lanes change other blocks."""
        margin = math.ceil(self._rule.half)
        firsts, afters, across = lanes.T
        rows = slice(int(across.min()) - 2 * margin, int(across.max()) + 2 * margin + 1)
        columns = slice(int(firsts.min()) - margin, int(afters.max()) + margin)
        rows, columns = (rows, columns) if self._along_x else (columns, rows)
        return slice(max(rows.start, 0), rows.stop), slice(max(columns.start, 0), columns.stop)

    def take(self, lanes: Array) -> None:
        """Set to False what lanes clean, for both grids over the same cells."""
        for first, after, across in lanes.tolist():
            self._missed[slice(*compiled_lanes.band(across, self._rule.half)), int(first):int(after)] = False

    def blocks(self, speed: float) -> List[Tuple[Array, float, float]]:
        """The lanes of all blocks, as if none ran in the other direction; their area [m^2], and their time [s]."""
        lanes, begins, counts = compiled_lanes.blocks(self._missed.copy(), self._clearance, plain(self._rule))
        times = (lanes[:, 1] - lanes[:, 0]) * self._resolution / speed + TURN
        return [(lanes[first:after], count * self._resolution ** 2, BLOCK + sum(times[first:after].tolist()))
                for first, after, count in zip(begins.tolist(), begins[1:].tolist(), counts.tolist())]

    def metres(self, lanes: Array) -> List[Array]:
        """Both ends of each lane: float64 (2, 2) [m], map frame."""
        across = lanes[:, 2]
        ends = np.stack([np.stack([lanes[:, end], across], axis=1) for end in (0, 1)], axis=1)
        return list(self._floor.points(ends if self._along_x else ends[..., ::-1]))
