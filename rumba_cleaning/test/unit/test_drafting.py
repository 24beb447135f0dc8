"""Drafts: how lanes are laid out, and what they sweep on paper."""

import numpy as np
import pytest
from floors import knowing, wiped
from rooms import crooked

from rumba_cleaning.planning import planner
from rumba_cleaning.planning.simulate.paper import drive
from rumba_cleaning.planning.swaths.drafting import Draft, drafted
from rumba_cleaning.planning.swaths.lanes import Layout
from rumba_sim.model.common.geometry import Pose

PLAN, START = crooked(0.02), Pose(1.0, 1.0, 0.0)


def draft_of(context, layout=Layout()):
    """What one draft comes to, without strips."""
    found, = drafted(planner.posed(context, START), [Draft(layout, 0.3, strip=np.inf)])
    return found


def test_what_a_draft_sweeps_is_swept_on_paper_once_and_the_context_stays_as_it_is():
    context = knowing(PLAN, START)
    found = draft_of(context)
    assert context.swept.coverage == 0.0 and found.paper.coverage > 0.9
    again = context.swept.copy()
    for stretch in found.stretches:
        drive(again, stretch.variants[0].path())
    assert again.coverage == pytest.approx(found.paper.coverage, abs=2e-3)


@pytest.mark.parametrize('change, is_longer', [({'overlap': 0.15}, True), ({'needed': 0.5}, False)])
def test_each_layout_lays_lanes_its_own_way(change, is_longer):
    context = knowing(PLAN, START)
    areas = [sum(part.area for part in draft_of(context, layout).stretches) for layout in (Layout(), Layout(**change))]
    lengths = [sum(np.hypot(*np.diff(part.variants[0].path(), axis=0).T).sum()
                   for part in draft_of(context, layout).stretches) for layout in (Layout(), Layout(**change))]
    assert (lengths[1] > lengths[0]) == is_longer and areas[0] > 0.0


def test_a_draft_of_a_floor_that_is_swept_has_no_stretches():
    context = wiped(knowing(PLAN, START), (0.0, 0.0, 9.0, 9.0))
    assert draft_of(context).stretches == []


def test_drafts_that_come_to_the_same_appear_once():
    problem = planner.posed(knowing(PLAN, START), START)
    one, other = Draft(Layout(), 0.3), Draft(Layout(0.09), 0.3)
    assert len(list(drafted(problem, [one, other, one]))) == 2
