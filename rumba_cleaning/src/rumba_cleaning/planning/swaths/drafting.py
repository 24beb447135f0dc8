"""What to drive along to clean what was missed, laid out in several ways: rings, lanes, and large pieces between."""

from typing import Dict, Iterator, List, NamedTuple, Sequence, Tuple

import numpy as np
from scipy import ndimage

from rumba_cleaning.belief.ground import Ground
from rumba_cleaning.belief.swept import Swept
from rumba_cleaning.planning.common.stretches import Stretch
from rumba_cleaning.planning.decompose.turned_floor import Window
from rumba_cleaning.planning.simulate.paper import drive
from rumba_cleaning.planning.swaths.lanes import Layout, block_variants, blocks, through
from rumba_cleaning.planning.swaths.problem import Problem
from rumba_cleaning.planning.swaths.rings import PASS, chains, rings, stretch
from rumba_sim.model.kernel import Array


class Draft(NamedTuple):
    """How the lanes and rings of a floor are laid out."""

    layout: Layout  # of the lanes
    missed: float  # share of a cell, for a lane to clean it: small drives over swept floor
    ring_pass: float = PASS  # from ring to ring, as in `rings.rings`
    strip: float = 0.1  # [m^2] of what rings and lanes leave, for the tour to lead over it; the rest may stay
    apart: float = 0.0  # [m] up to which pieces of that belong together, as a broken line in the middle of a corridor


# All figures are our choice. Which draft is best differs from floor to floor: routes by several are rehearsed.
DRAFTS = (Draft(Layout(), 0.3),
          Draft(Layout(0.0, needed=0.15, gap=0.4, alike=2.7), 0.4),
          Draft(Layout(0.08, needed=0.17, usual=0.5, gap=0.65), 0.45))
# For regions in rings, such as a corridor a little wider than so many of them: one more pass in its middle, though what
# is left there is thin and broken, or rings that overlap less.
IN_RINGS = (DRAFTS[0]._replace(strip=0.015, apart=0.04), DRAFTS[0]._replace(strip=0.015, apart=0.04, ring_pass=0.995))


class Drafted(NamedTuple):
    """Stretches that a draft comes to."""

    stretches: List[Stretch]
    paper: Swept  # the floor after them, on paper


def choices(problem: Problem) -> Sequence[Draft]:
    """The drafts to rehearse: more of them on a floor that is worth more rounds; none for rings that no region has."""
    rounds, has_rings = problem.effort.rounds, not problem.shapes.has_lanes[1:].all()
    return *DRAFTS[:max(rounds, 1)], *IN_RINGS[:(rounds + 1) // 2 if has_rings else 0]


def drafted(problem: Problem, drafts: Sequence[Draft]) -> Iterator[Drafted]:
    """What each draft comes to; those that come to the same appear once."""
    ringed: Dict[float, Tuple[List[Stretch], Swept]] = {}  # by how far apart the rings are
    found = set()  # by their paths
    for draft in drafts:
        if draft.ring_pass not in ringed:
            paper = problem.context.swept.copy()
            ringed[draft.ring_pass] = _rings(problem, paper, draft), paper
        along_rings, beside_rings = ringed[draft.ring_pass]
        paper = beside_rings.copy()
        stretches = along_rings + _lanes(problem, paper, draft)
        stretches += _strips(problem, paper, draft)
        paths = b''.join(part.variants[0].path().tobytes() for part in stretches)
        if paths not in found:
            found.add(paths)
            yield Drafted(stretches, paper)


def _rings(problem: Problem, paper: Swept, draft: Draft) -> List[Stretch]:
    """Rings that clean what was missed along walls, and where there are to be no lanes; they are driven on paper."""
    ground, brush = problem.context.ground, problem.context.robot.brush.width
    spare = (1.0 - problem.context.target_coverage) * paper.reachable_area
    found = rings(ground, paper, problem.labels, problem.shapes, brush, draft.ring_pass, spare)
    return [stretch(chain, brush) for chain in chains(found)]


def _lanes(problem: Problem, paper: Swept, draft: Draft) -> List[Stretch]:
    """Lanes that clean what was missed beside the rings, but for crumbs; they are driven on paper."""
    context, found = problem.context, []
    missed = (paper.missing_share() > draft.missed) & problem.around
    for region, part, window in _by_region(context.ground, missed, problem.labels):
        if problem.shapes.has_lanes[region]:
            for block in blocks(context.ground, part, window, context.robot.brush.width, context.config.speed,
                                problem.angle, draft.layout):
                path = through(context.ground, block.lanes, 0)
                drive(paper, path)
                found.append(Stretch(block_variants(context.ground, block.lanes, path), region, block.area))
    return found


def _strips(problem: Problem, paper: Swept, draft: Draft) -> List[Stretch]:
    """What rings and lanes leave in large pieces, as in the middle of corridors; it is driven on paper."""
    found = problem.crumbs(paper, draft.strip, draft.apart)
    for part in found:
        drive(paper, part.variants[0].path())
    return found


def _by_region(ground: Ground, missed: Array, labels: Array) -> Iterator[Tuple[int, Array, Window]]:
    """The label of each region, the cells to clean in it, bool (rows, columns), and the window that holds them."""
    cells = np.argwhere(missed)
    nodes = ground.standing(cells)
    of_cells = np.zeros(missed.shape, labels.dtype)
    of_cells[missed] = labels[nodes[:, 0], nodes[:, 1]]
    for label, window in enumerate(ndimage.find_objects(of_cells), 1):
        if window is not None:
            part = np.zeros(missed.shape, bool)  # not zeros_like, which writes to all of it
            part[window] = of_cells[window] == label
            yield label, part, window
