"""What to drive along to clean what was missed, laid out in several ways: rings, lanes, and large pieces between."""

from typing import Dict, Iterator, List, NamedTuple, Sequence, Set, Tuple

import numpy as np
from scipy import ndimage

from rumba_cleaning.belief.ground import Ground
from rumba_cleaning.belief.swept import Swept
from rumba_cleaning.planning.common.effort import layouts
from rumba_cleaning.planning.common.stretches import Stretch
from rumba_cleaning.planning.decompose.regions import NARROW, Shapes, shapes
from rumba_cleaning.planning.decompose.turned_floor import Window
from rumba_cleaning.planning.simulate.paper import drive
from rumba_cleaning.planning.swaths.layouts import Draft, drafts, laid_out
from rumba_cleaning.planning.swaths.problem import Problem
from rumba_cleaning.planning.swaths.rings import chains, rings, stretch
from rumba_sim.model.kernel import Array


class Drafted(NamedTuple):
    """Stretches that a draft comes to."""

    stretches: List[Stretch]
    paper: Swept  # the floor after them, on paper

    @property
    def paths(self) -> List[Array]:
        """The first path over each stretch: float64 (any, 2) [m]."""
        return [part.variants[0].path() for part in self.stretches]


def drafted(problem: Problem, choices: Sequence[Tuple[Draft, Shapes]]) -> Iterator[Drafted]:
    """What each draft comes to, with what suits the regions by it; those that come to the same appear once."""
    ringed: Dict[Tuple[bytes, float], Tuple[List[Stretch], Swept]] = {}  # by where they are, and how far apart
    found: Set[bytes] = set()  # by their paths
    for draft, shape in choices:
        which = shape.has_lanes.tobytes(), draft.ring_pass
        if which not in ringed:
            paper = problem.context.swept.copy()
            ringed[which] = _rings(problem, paper, shape, draft), paper
        along_rings, beside_rings = ringed[which]
        paper = beside_rings.copy()
        stretches = along_rings + _lanes(problem, paper, shape, draft)
        stretches += _strips(problem, paper, draft)
        each = Drafted(stretches, paper)
        paths = b''.join(path.tobytes() for path in each.paths)
        if paths not in found:
            found.add(paths)
            yield each


def choices(problem: Problem) -> List[Tuple[Draft, Shapes]]:
    """The drafts to rehearse, with what suits the regions by each; none for rings or shapes that no region has."""
    usual, *others = [(draft, shapes(problem.context.ground, problem.labels, draft.narrow))
                      for draft in drafts(problem.effort.rounds)]
    return [usual, *(other for other in others if _is_of_use(*other, usual[1]))]


def _is_of_use(draft: Draft, shape: Shapes, usual: Shapes) -> bool:
    """Whether some region suits a draft: has another shape than usual, or is in rings, if the draft is for such."""
    has_others = draft.narrow == NARROW or bool((shape.has_lanes != usual.has_lanes).any())
    is_for_rings = draft.apart > 0.0
    return has_others and not (is_for_rings and shape.has_lanes[1:].all())


def _rings(problem: Problem, paper: Swept, shape: Shapes, draft: Draft) -> List[Stretch]:
    """Rings that clean what was missed along walls, and where there are to be no lanes; they are driven on paper."""
    ground, brush = problem.context.ground, problem.context.robot.brush.width
    spare = (1.0 - problem.context.target_coverage) * paper.reachable_area
    found = rings(ground, paper, problem.labels, shape, brush, draft.ring_pass, spare)
    return [stretch(chain, brush) for chain in chains(found)]


def _lanes(problem: Problem, paper: Swept, shape: Shapes, draft: Draft) -> List[Stretch]:
    """Lanes that clean what was missed beside the rings, but for crumbs; they are driven on paper."""
    context, labels = problem.context, problem.labels
    ground = context.ground
    missed = (paper.missing_share() > draft.missed) & problem.around
    compared = draft.layouts[:layouts(float(missed.sum()) * ground.plan.resolution ** 2)]
    found: List[Stretch] = []
    for region, part, window in _by_region(ground, missed, labels):
        if shape.has_lanes[region]:
            found += laid_out(context, paper, part, region, problem.angle, compared, window)
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
