"""Detours lead past the crumbs beside a route, those first that cost least, as many as the target needs."""

import numpy as np
import pytest
from floors import knowing, length, wiped_but
from rooms import room

from rumba_cleaning.planning.common.effort import effort
from rumba_cleaning.planning.decompose.regions import regions
from rumba_cleaning.planning.search.detours import FARTHEST
from rumba_cleaning.planning.search.edits import APART
from rumba_cleaning.planning.search.improvement import DEAREST_ON_PAPER, LEAST_ON_PAPER, SURPLUS, with_detours
from rumba_cleaning.planning.simulate.paper import drive
from rumba_cleaning.planning.swaths.problem import Problem
from rumba_cleaning.planning.swaths.walls import Walls
from rumba_cleaning.route import Route
from rumba_sim.model.common.geometry import Pose

START = Pose(0.5, 1.5, 0.0)
ACROSS = Route(np.array([[0.5, 1.5], [3.5, 1.5]]), np.array([0.3]))
NEAR, FAR, BEYOND = (1.0, 1.7, 1.2, 1.9), (2.5, 1.9, 2.7, 2.1), (2.0, 2.5, 2.2, 2.7)  # crumbs: left, bottom, right, top


def detoured(*boxes, target=1.0, route=ACROSS, plan=None):
    """A route with detours on a floor that was swept except for crumbs, and the floor after it, on paper."""
    context = wiped_but(knowing(plan or room(4.0, 3.0, 0.02), START, target_coverage=target), *boxes)
    floor = context.swept.copy()
    everywhere = np.ones(context.plan.free.shape, bool)
    problem = Problem(context, START, None, everywhere, regions(context.ground), Walls(context.ground), effort(context))
    found = with_detours(problem, route, floor)
    drive(floor, found.waypoints)
    return found, floor


def passes(route, box):
    """Whether a route leads over the middle of a box."""
    middle = 0.5 * (np.array(box[:2]) + box[2:])
    return np.hypot(*(route.waypoints - middle).T).min() < 0.15


def test_a_detour_leads_past_a_crumb_and_back_onto_the_route():
    found, floor = detoured(NEAR)
    assert passes(found, NEAR) and floor.coverage > 0.999
    assert (found.waypoints[[0, -1]] == ACROSS.waypoints).all() and len(found.speeds) == len(found.waypoints) - 1
    assert (found.speeds == 0.3).all() and length(found.waypoints) < 3.0 + 1.2


def test_without_crumbs_a_route_only_has_more_waypoints():
    found, _ = detoured()
    assert length(found.waypoints) == pytest.approx(3.0) and (found.waypoints[:, 1] == 1.5).all()
    assert np.hypot(*np.diff(found.waypoints, axis=0).T).max() <= APART + 1e-9


def test_crumbs_that_cost_less_come_first_and_no_more_than_the_target_needs():
    both, _ = detoured(NEAR, FAR)
    assert passes(both, NEAR) and passes(both, FAR)
    share = 0.04 / knowing(room(4.0, 3.0, 0.02), START).swept.reachable_area
    one, _ = detoured(NEAR, FAR, target=1.0 - SURPLUS - 1.5 * share)
    assert passes(one, NEAR) and not passes(one, FAR)
    none, _ = detoured(NEAR, FAR, target=1.0 - SURPLUS - 2.5 * share)
    assert not passes(none, NEAR) and not passes(none, FAR)


def test_crumbs_that_cost_too_much_for_their_area_are_left_whatever_the_target():
    worth = (2.0, 1.7, 2.2, 1.9)
    small = (3.0, 1.9, 3.08, 1.98)
    assert 2.0 * (small[1] - 1.5) / 0.3 > DEAREST_ON_PAPER * 0.08 ** 2 > DEAREST_ON_PAPER * LEAST_ON_PAPER
    found, _ = detoured(worth, small)
    assert passes(found, worth) and not passes(found, small)


def test_crumbs_that_are_far_or_behind_a_wall_are_left():
    found, _ = detoured(BEYOND)
    assert BEYOND[1] - 1.5 > FARTHEST and (found.waypoints[:, 1] == 1.5).all()
    wall = room(4.0, 3.0, 0.02, [(0.4, 1.72, 4.0, 1.74)])
    found, _ = detoured((1.0, 1.98, 1.2, 2.15), plan=wall)
    assert (found.waypoints[:, 1] == 1.5).all()


@pytest.mark.parametrize('resolution', [0.01, 0.02, 0.025])
def test_a_detour_may_begin_beside_a_wall(resolution):
    """The nodes of the grid that are nearest to a robot there may be too near to the wall for it."""
    plan = room(4.0, 3.0, resolution)
    y = min(line[:, 1].min() for line in Walls(knowing(plan, START).ground).outlines)
    crumb = (1.5, y + 0.15, 1.7, y + 0.35)
    found, _ = detoured(crumb, route=Route(np.array([[0.5, y], [3.5, y]]), np.array([0.3])), plan=plan)
    assert passes(found, crumb)


def test_there_are_no_detours_from_where_the_robot_drives_fast_with_its_brushes_up():
    fast = Route(np.array([[0.5, 1.5], [2.0, 1.5], [3.5, 1.5]]), np.array([0.45, 0.3]))
    found, _ = detoured((0.7, 1.7, 0.9, 1.9), (3.0, 1.7, 3.2, 1.9), route=fast)
    assert not passes(found, (0.7, 1.7, 0.9, 1.9)) and passes(found, (3.0, 1.7, 3.2, 1.9))
