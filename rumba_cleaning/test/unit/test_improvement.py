"""Routes are improved until they meet the target: they take less time then, or sweep what they would have left."""

import itertools

import numba
import numpy as np
import pytest
from floors import knowing, wiped_but
from rooms import crooked, room

from rumba_cleaning.planning import planner
from rumba_cleaning.planning.common import effort as efforts
from rumba_cleaning.planning.common.effort import Effort, effort
from rumba_cleaning.planning.order.route import through
from rumba_cleaning.planning.search import improvement
from rumba_cleaning.planning.search.edits import dense
from rumba_cleaning.planning.search.improvement import improved
from rumba_cleaning.planning.search.shifts import shifts
from rumba_cleaning.planning.simulate import compiled_changes
from rumba_cleaning.planning.simulate.rehearsal import Rehearsal
from rumba_cleaning.planning.swaths.drafting import DRAFTS, IN_RINGS, Draft, choices, drafted
from rumba_cleaning.planning.swaths.lanes import Layout
from rumba_cleaning.planning.swaths.problem import need
from rumba_cleaning.route import Route
from rumba_sim.model.common.geometry import Pose

START = Pose(0.5, 0.5, 0.3)
# numba's class of compiled functions, wherever its version keeps that
DISPATCHER = next(kind for kind in type(compiled_changes.changes).__mro__ if 'typeof_pyval' in vars(kind))


def problem_of(floor, pose=START, **config):
    return planner.posed(knowing(floor, pose, **config), pose)


def first_draft(problem, overlap=0.05):
    """The route of a planner that improves nothing."""
    draft, = drafted(problem, [Draft(Layout(overlap), 0.3, strip=np.inf)])
    return through(problem, draft.stretches)


@pytest.mark.parametrize('width, height, rings', [(5.0, 3.0, 0), (8.0, 1.2, 0), (8.0, 0.7, 2)])
def test_there_are_drafts_for_rings_only_where_a_region_has_such(width, height, rings):
    assert choices(problem_of(room(width, height))) == (*DRAFTS, *IN_RINGS[:rings])


@pytest.mark.parametrize('rounds, count, rings', [(0, 1, 0), (1, 1, 1), (2, 2, 1), (5, 3, 2)])
def test_fewer_drafts_are_rehearsed_on_a_floor_that_is_worth_fewer_rounds(rounds, count, rings):
    problem = problem_of(room(8.0, 0.7))._replace(effort=Effort(rounds))
    assert choices(problem) == (*DRAFTS[:count], *IN_RINGS[:rings])


def test_no_two_of_the_routes_that_are_rehearsed_are_the_same():
    """In a corridor without lanes, drafts that differ in these alone are one."""
    routes = [route.waypoints for route in planner.drafts(problem_of(room(8.0, 0.8)))]
    assert len(routes) == 2
    assert not any(np.array_equal(one, other) for one, other in itertools.combinations(routes, 2))


def test_an_improved_route_meets_the_target_sooner_than_one_with_all_lanes():
    problem = problem_of(crooked(0.02), target_coverage=0.95)
    draft = first_draft(problem)
    before = Rehearsal(problem.context, START, dense(draft))
    after = Rehearsal(problem.context, START, improved(problem, [draft]))
    assert before.swept.coverage > 0.96 and after.is_complete
    assert after.swept.coverage >= 0.95 and after.seconds < 0.97 * before.seconds


def test_an_improved_route_sweeps_what_lanes_without_overlap_and_corners_would_leave():
    problem = problem_of(crooked(0.02), target_coverage=0.992)
    draft = first_draft(problem, 0.0)
    before = Rehearsal(problem.context, START, dense(draft))
    after = Rehearsal(problem.context, START, improved(problem, [draft]))
    assert before.swept.coverage < 0.991 and after.swept.coverage >= 0.992
    assert after.seconds < 1.15 * before.seconds


@pytest.mark.parametrize('size, wanted, count', [((4.0, 2.0), 5, 5), ((4.0, 2.0), 2, 2), ((4.0, 2.0), 0, 0),
                                                 ((12.0, 7.0), 5, 2), ((16.0, 12.0), 5, 1), ((16.0, 12.0), 0, 0),
                                                 ((16.0, 16.0), 5, 0)])
def test_there_are_as_many_rounds_as_are_wanted_and_as_the_floor_is_worth(size, wanted, count):
    assert effort(knowing(room(*size), START, planning_rounds=wanted)).rounds == count


def test_on_a_large_floor_a_route_is_edited_once(monkeypatch):
    problem = problem_of(crooked(0.02), target_coverage=0.95)
    monkeypatch.setattr(efforts, 'WORK', 1.1 * problem.context.swept.reachable_area)
    problem = problem._replace(effort=effort(problem.context))
    assert problem.effort.rounds == 1
    before = min(Rehearsal(problem.context, START, dense(route)).seconds for route in planner.drafts(problem))
    after = Rehearsal(problem.context, START, planner.plan(problem.context, START))
    assert after.swept.coverage >= 0.95 and after.seconds < 0.95 * before


def test_edits_that_were_far_from_worth_it_are_not_judged_again(monkeypatch):
    counts, judged = [], Rehearsal.judged

    def counted(rehearsal, found):
        counts.append(len(found))
        return judged(rehearsal, found)
    monkeypatch.setattr(Rehearsal, 'judged', counted)
    problem, poor = problem_of(crooked(0.02), target_coverage=0.95), set()
    rehearsal = Rehearsal(problem.context, START, dense(first_draft(problem)))
    found = list(shifts(problem.context, rehearsal.route))
    first, second = (improvement._edited(problem, rehearsal, found, poor)[0] for _ in range(2))
    assert counts[0] == len(found) > 100 and 0 < counts[1] < 0.6 * counts[0]
    assert first.seconds == second.seconds and first.swept.coverage == second.swept.coverage


@pytest.mark.thorough
def test_the_better_of_two_routes_is_improved():
    problem = problem_of(crooked(0.02), target_coverage=0.95)
    good = first_draft(problem)
    bad = Route(np.concatenate([good.waypoints, good.waypoints[-2::-1]]),
                np.concatenate([good.speeds, good.speeds[::-1]]))
    chosen = Rehearsal(problem.context, START, improved(problem, [bad, good]))
    alone = Rehearsal(problem.context, START, improved(problem, [good]))
    assert chosen.seconds == alone.seconds and chosen.swept.coverage == alone.swept.coverage


def test_a_route_with_more_turns_is_to_sweep_more_since_each_is_driven_otherwise_than_rehearsed():
    problem, points = problem_of(room(4.0, 3.0)), np.linspace((0.5, 0.5), (3.5, 0.5), 16)
    zigzag = points + np.array([[0.0, 0.1 * (index % 2)] for index in range(16)])
    few, many = (Rehearsal(problem.context, START, Route(route, np.full(15, 0.3))) for route in (points, zigzag))
    for rehearsal in (few, many):
        beyond = improvement._need(problem.context, rehearsal) - need(problem.context, rehearsal.swept)
        assert beyond == pytest.approx(improvement.MARGIN * rehearsal.turned)
    assert many.turned > 4.0 * few.turned > 0.0


def test_a_route_over_crumbs_takes_no_longer_if_it_is_improved(monkeypatch):
    context = wiped_but(knowing(room(4.0, 3.0, 0.02), START, target_coverage=0.99), (0.4, 0.5, 0.5, 0.7),
                        (2.0, 0.5, 2.1, 0.7), (3.3, 1.2, 3.5, 1.3), (1.0, 1.6, 1.2, 1.8), (2.6, 2.2, 2.8, 2.5))
    found = Rehearsal(context, START, dense(planner.plan(context, START)))
    monkeypatch.setattr(planner, 'effort', lambda _: Effort(0))
    plain = Rehearsal(context, START, dense(planner.plan(context, START)))
    assert found.seconds <= plain.seconds and found.swept.coverage >= 0.99


def test_a_route_that_nobody_can_follow_stays_as_it_is():
    problem = problem_of(room(4.0, 3.0, 0.02, [(1.9, 0.0, 2.1, 3.0)]))
    through = Route(np.array([[0.5, 0.5], [3.5, 0.5]]), np.array([0.3]))
    assert improved(problem, [through]).waypoints.tolist() == dense(through).waypoints.tolist()


@pytest.mark.parametrize('has_marks', [False, True])
def test_a_route_over_crumbs_is_improved_unless_the_robot_met_obstacles(monkeypatch, has_marks):
    context, given = knowing(room(4.0, 3.0, 0.02), START), []
    if has_marks:
        context.ground.mark(3.0, 2.0, 0.05)
    through = Route(np.array([START[:2], (0.6, 1.5), (3.5, 1.5)]), np.full(2, 0.3))
    monkeypatch.setattr(planner, 'drafts', lambda _: [])
    monkeypatch.setattr(planner, 'through', lambda *_: through)
    monkeypatch.setattr(planner, 'improved', lambda _, routes: given.extend(routes) or routes[0])
    assert planner.plan(context, START) is through and len(given) == 1 - has_marks


def test_plans_repeat():
    problem = problem_of(crooked(0.05))
    draft = first_draft(problem)
    one, other = improved(problem, [draft]), improved(problem, [draft])
    assert np.array_equal(one.waypoints, other.waypoints) and np.array_equal(one.speeds, other.speeds)


def test_numba_does_not_take_the_types_of_what_a_plan_calls_for_new_ones(monkeypatch):
    """It keeps each of them for good: a robot that planned every day held ever more memory."""
    def asked(dispatcher, value):
        names.add(dispatcher.py_func.__name__)
        return typeof(dispatcher, value)

    names, floor = set(), crooked(0.02)
    for _ in range(2):  # the first knows none
        planner.plan(knowing(floor, START), START)
    typeof = DISPATCHER.typeof_pyval
    monkeypatch.setattr(DISPATCHER, 'typeof_pyval', asked)
    planner.plan(knowing(floor, START), START)
    few = {'sweep_trace', 'passed', 'changes'}  # with many arrays: these are few calls
    if numba.__version__ < '0.49':  # it loses more of the texts
        few |= {'rehearse'}
    assert names <= few
