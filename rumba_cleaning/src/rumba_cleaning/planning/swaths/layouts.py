"""Chooses how the lanes of a region are laid out: several layouts are driven on paper."""

from typing import List, NamedTuple, Optional, Sequence

import numpy as np

from rumba_cleaning.belief.context import Context
from rumba_cleaning.belief.swept import Swept
from rumba_cleaning.planning.common.stretches import Stretch
from rumba_cleaning.planning.decompose.regions import NARROW
from rumba_cleaning.planning.decompose.turned_floor import Window
from rumba_cleaning.planning.simulate.paper import drive
from rumba_cleaning.planning.swaths.lanes import BLOCK, Layout, blocks
from rumba_cleaning.planning.swaths.links import block_variants, through
from rumba_cleaning.planning.swaths.rings import PASS
from rumba_cleaning.route import Route
from rumba_sim.model.kernel import Array


class Draft(NamedTuple):
    """How the lanes and rings of a floor are laid out."""

    layouts: Sequence[Layout]  # those that are compared, on paper, in each region
    missed: float  # share of a cell, for a lane to clean it: small drives over swept floor
    narrow: float = NARROW  # [m] where rings suit a region better than lanes, as in `regions.shapes`
    ring_pass: float = PASS  # from ring to ring, as in `rings.rings`
    strip: float = 0.1  # [m^2] of what rings and lanes leave, for the tour to lead over it; the rest may stay
    apart: float = 0.0  # [m] up to which pieces of that belong together, as a broken line in the middle of a corridor


# All figures are our choice. Which draft is best differs from floor to floor, as the best layout from region to region:
# routes by several are rehearsed. Lanes for wider strips look better only on paper: they leave slivers for the end.
DRAFTS = (Draft([Layout(), Layout(usual=0.15, alike=2.5), Layout(usual=0.7)], 0.3),
          Draft([Layout(0.0, needed=0.15, gap=0.4, alike=2.7)], 0.4),
          Draft([Layout(0.09, needed=0.15, usual=0.7, gap=0.55, alike=1.35)], 0.4))
# For regions in rings, such as a corridor a little wider than so many of them: one more pass in its middle, though what
# is left there is thin and broken, or rings that overlap less.
IN_RINGS = (DRAFTS[0]._replace(strip=0.015, apart=0.04), DRAFTS[0]._replace(strip=0.015, apart=0.04, ring_pass=0.995))
# For regions that are hardly corridors or hardly rooms: a wide ring corridor wants rings, legs of chairs want lanes.
OTHER_SHAPES = (IN_RINGS[0]._replace(narrow=0.3),
                Draft([Layout(0.08, needed=0.17, usual=0.5, gap=0.65)], 0.45, narrow=0.05),
                IN_RINGS[1]._replace(narrow=0.3))
TURN = 3.0  # [s] for each turn, beyond its length: the wheels limit the turn rate, and it leaves crumbs beside it
LEFT = 50.0  # times as long as a lane takes a crumb to clean an area, about: large leaves less to the crumbs


def laid_out(context: Context, paper: Swept, missed: Array, region: int, angle: float, layouts: Sequence[Layout],
             within: Optional[Window] = None) -> List[Stretch]:
    """Blocks of lanes that clean a region, by the best layout of those tried.

    Args:
        context: where the robot can stand.
        paper: what was swept; the lanes are driven on it, on paper.
        missed: the cells to clean in the region, bool (rows, columns).
        region: its label.
        angle: between the lanes and the map's axes [rad].
        layouts: those to compare.
        within: the smallest window that holds all that was missed, if known.
    """
    ground, brush, speed = context.ground, context.robot.brush.width, context.config.speed
    options = [blocks(ground, missed, brush, speed, angle, layout, within) for layout in layouts]
    paths = [[through(ground, block.lanes, 0) for block in option] for option in options]
    turns = [sum(len(block.lanes) - 1 for block in option) for option in options]
    best = 0
    if len(layouts) > 1:
        best = int(np.argmin([_cost(context, paper.copy(), *each) for each in zip(paths, turns)]))
    for path in paths[best]:
        drive(paper, path)
    return [Stretch(block_variants(ground, block.lanes, path), region, block.area, False)
            for block, path in zip(options[best], paths[best])]


def drafts(rounds: int) -> Sequence[Draft]:
    """The drafts to rehearse on a floor that is worth so many rounds of edits: more of them if that is more.

    Behind the usual ones are those for rings and for other shapes, of use only where a region has such by them.
    """
    return *DRAFTS[:max(rounds, 1)], *IN_RINGS[:(rounds + 1) // 2], *OTHER_SHAPES[:max(rounds - 1, 0)]


def _cost(context: Context, paper: Swept, paths: List[Array], turns: int) -> float:
    """The time [s] that paths with turns take, without what they sweep; they are driven on paper."""
    before, time = paper.coverage, TURN * turns
    for path in paths:
        drive(paper, path)
        time += BLOCK + float(Route(path, np.full(len(path) - 1, context.config.speed)).times()[-1])
    rate = context.robot.brush.width * context.config.speed
    return time - LEFT * (paper.coverage - before) * paper.reachable_area / rate
