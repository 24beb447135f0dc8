"""Which layout of lanes is chosen, and on what it depends."""

import numpy as np
import pytest
from floors import BRUSH, knowing
from pytest import approx
from rooms import crooked

from rumba_cleaning.planning.common import effort
from rumba_cleaning.planning.common.effort import AREA
from rumba_cleaning.planning.swaths import layouts
from rumba_cleaning.planning.swaths.lanes import Layout, blocks
from rumba_cleaning.planning.swaths.layouts import DRAFTS, IN_RINGS, OTHER_SHAPES, drafts, laid_out
from rumba_sim.model.common.geometry import Pose

PLAN = crooked(0.02)
LAYOUTS = DRAFTS[0].layouts
SPEED = 0.3


def chosen(among=LAYOUTS):
    """The paths of the best of some layouts, and what is swept when they were driven on paper."""
    context = knowing(PLAN, Pose(1.0, 1.0, 0.0))
    paper = context.swept.copy()
    found = laid_out(context, paper, context.swept.missed(), 1, 0.0, among)
    return [stretch.variants[0].path() for stretch in found], paper


def cost(paths, paper):
    """Time along paths and their turns [s], and 50 times as much as a lane takes for what they leave.

    Corners, which take time too, are not looked at: so this differs from the planner's figure by a little.
    """
    legs = [np.hypot(*np.diff(path, axis=0).T) for path in paths]
    turns = sum(np.count_nonzero(lengths > 0.1) - 1 for lengths in legs)  # lanes are longer, half circles are not
    left = 50.0 * (1.0 - paper.coverage) * paper.reachable_area / (BRUSH * SPEED)
    return sum(lengths.sum() for lengths in legs) / SPEED + 3.0 * len(legs) + 3.0 * turns + left


def test_of_all_layouts_the_one_is_chosen_that_costs_least():
    among = [Layout(overlap=0.4), *LAYOUTS, Layout(needed=0.7)]  # the first takes long, the last leaves much
    costs = [cost(*chosen((layout,))) for layout in among]
    assert min(costs[0], costs[-1]) > max(costs[1:-1]) + 10.0
    for tried in (among, among[::-1]):
        assert cost(*chosen(tried)) < min(costs) + 3.0


def test_what_the_lanes_sweep_is_swept_on_paper_once():
    context = knowing(PLAN, Pose(1.0, 1.0, 0.0))
    paths, paper = chosen()
    assert context.swept.coverage == 0.0 and paper.coverage > 0.5
    again = context.swept.copy()
    for path in paths:
        layouts.drive(again, path)
    assert again.coverage == paper.coverage


def test_a_single_layout_is_taken_as_it_is():
    context = knowing(PLAN, Pose(1.0, 1.0, 0.0))
    paths, _ = chosen(LAYOUTS[:1])
    found = blocks(context.ground, context.swept.missed(), BRUSH, SPEED, 0.0, LAYOUTS[0])
    assert len(paths) == len(found) and [path[0].tolist() for path in paths] == [
        block.lanes[0][0].tolist() for block in found]


@pytest.mark.parametrize('area, count', [(0.0, 1), (0.9, 1), (1.0, 3), (AREA / 2.5, 2), (2.0 * AREA, 1)])
def test_several_layouts_are_tried_if_there_is_much_to_clean_but_fewer_on_a_large_floor(area, count):
    assert len(LAYOUTS[:effort.layouts(area)]) == count


@pytest.mark.parametrize('rounds, count, rings, others', [(0, 1, 0, 0), (1, 1, 1, 0), (2, 2, 1, 1), (5, 3, 2, 3)])
def test_fewer_drafts_are_rehearsed_on_a_floor_that_is_worth_fewer_rounds(rounds, count, rings, others):
    assert drafts(rounds) == (*DRAFTS[:count], *IN_RINGS[:rings], *OTHER_SHAPES[:others])


@pytest.mark.parametrize('change, fewer', [({'overlap': 0.15}, False), ({'needed': 0.5}, True)])
def test_each_layout_lays_lanes_its_own_way(change, fewer):
    context = knowing(PLAN, Pose(1.0, 1.0, 0.0))
    missed = context.swept.missed()
    counts = [sum(len(block.lanes) for block in blocks(context.ground, missed, BRUSH, SPEED, 0.0, layout))
              for layout in (Layout(), Layout(**change))]
    assert (counts[1] < counts[0]) == fewer and counts[1] != counts[0]


def test_lanes_of_a_floor_that_is_swept_are_none():
    context = knowing(PLAN, Pose(1.0, 1.0, 0.0))
    paper = context.swept.copy()
    assert laid_out(context, paper, np.zeros_like(PLAN.free), 1, 0.0, LAYOUTS) == [] and paper.coverage == approx(0.0)
