"""Routes are rebuilt of pieces: the best ones, in the best order, and each from the better end."""

import itertools

import numpy as np
import pytest
from floors import BRUSH, knowing
from hypothesis import given, settings
from hypothesis import strategies as st
from pytest import approx
from rooms import room

from rumba_cleaning.planning.common.effort import effort
from rumba_cleaning.planning.decompose.regions import regions
from rumba_cleaning.planning.search.compiled_pieces import FAR
from rumba_cleaning.planning.search.compiled_rebuilding import GOAL, NONE, START, Net, State, number, rebuilt, turned
from rumba_cleaning.planning.search.edits import dense
from rumba_cleaning.planning.search.rebuilding import rebuilt as rebuilt_route
from rumba_cleaning.planning.simulate.rehearsal import Rehearsal
from rumba_cleaning.planning.swaths.problem import Problem
from rumba_cleaning.planning.swaths.walls import Walls
from rumba_cleaning.route import Route
from rumba_sim.model.common.geometry import Pose

BEGIN = Pose(0.5, 0.5, 0.0)
FLOOR = room(4.0, 3.0, 0.02)
PRICE = 0.5  # [s] of a cell
CELLS = 12


def net_of(seed, count, far=0.0):
    """Pieces of a cell or more each, with random links, a share of which is not known."""
    random = np.random.default_rng(seed)
    ends = np.repeat(random.uniform(0.0, 4.0, (count + 2, 2)), 2, axis=0)
    ends[4:] += random.uniform(-0.5, 0.5, ends[4:].shape)
    links = np.hypot(*(ends[:, np.newaxis] - ends).transpose(2, 0, 1)).astype(np.float32)
    blocked = np.triu(random.random(links.shape) < far, 1)
    links[blocked | blocked.T] = FAR
    own = np.arange(len(ends)) ^ 1
    links[np.arange(len(ends)), own] = links[np.arange(len(ends)), np.arange(len(ends))] = FAR
    near = np.argsort(links, axis=1).astype(np.int32)
    near[np.take_along_axis(links, near, 1) == FAR] = NONE
    sizes = np.append([0, 0], random.integers(1, 5, count))
    cells = np.concatenate([random.choice(CELLS, size, False) for size in sizes]).astype(np.int32)
    return Net(near, links, np.append([0.0, 0.0], random.uniform(0.1, 1.0, count)), ends[::2], cells,
               np.cumsum([0, *sizes]), PRICE)


def cost(net, tour):
    """What a tour takes, less what it is worth [s]."""
    links = sum(float(net.links[one ^ 1, other]) for one, other in zip(tour, tour[1:]))
    swept = {cell for end in tour for cell in net.cells[net.stops[end >> 1]:net.stops[(end >> 1) + 1]].tolist()}
    return links + sum(net.durations[end >> 1] for end in tour) - net.price * len(swept)


def best(net, count):
    """The least cost of all tours over some of the pieces."""
    return min(cost(net, [2 * START, *(2 * piece + end for piece, end in zip(order, ends)), 2 * GOAL])
               for size in range(count + 1) for order in itertools.permutations(range(GOAL + 1, count + 2), size)
               for ends in itertools.product((0, 1), repeat=size))


@pytest.mark.parametrize('seed', range(6))
def test_of_few_pieces_the_best_are_driven_in_the_best_order(seed):
    net = net_of(seed, 4)
    found = rebuilt(net, 2 * np.array([START, *range(GOAL + 1, 6), GOAL]), CELLS, 300).tolist()
    assert found[0] == 2 * START and found[-1] == 2 * GOAL and len({end >> 1 for end in found}) == len(found)
    assert cost(net, found) == approx(best(net, 4), abs=1e-4)


@settings(deadline=None, max_examples=100)
@given(st.integers(0, 2 ** 32 - 1))
def test_a_part_is_turned_round_only_if_that_saves_time_although_links_that_are_not_known_count_a_lot(seed):
    net = net_of(seed, 12, 0.5)
    random = np.random.default_rng(seed)
    tour = np.concatenate([[2 * START], 2 * random.permutation(range(2, 14)) + random.integers(0, 2, 12), [2 * GOAL]])
    state = State(np.full(14, NONE), np.zeros(CELLS, np.uint8))
    number(state.place, tour, 0)
    for index in range(1, len(tour)):
        before = cost(net, tour.tolist())
        is_turned = turned(net, state.place, tour, index)
        assert (cost(net, tour.tolist()) < before - 1e-7) == is_turned
        assert (tour[state.place] >> 1 == np.arange(14)).all()


def problem_of(floor=FLOOR, end=None, **config):
    context = knowing(floor, BEGIN, **config)
    around = np.ones(context.plan.free.shape, bool)
    return Problem(context, BEGIN, end, around, regions(context.ground), Walls(context.ground), effort(context))


def lanes(order):
    """Lanes side by side, in an order of their numbers, each from the left."""
    rows = 0.3 + BRUSH * np.array(order)
    return [np.array([[0.3, row], [3.7, row]]) for row in rows]


def route_over(paths):
    waypoints = np.concatenate([[BEGIN[:2]], *paths])
    return dense(Route(waypoints, np.full(len(waypoints) - 1, 0.3)))


def rebuilt_rehearsal(problem, before, paths=()):
    route = rebuilt_route(problem, before, paths)
    return Rehearsal(problem.context, BEGIN, dense(route))


def test_lanes_in_a_bad_order_are_driven_in_a_good_one():
    problem = problem_of()
    before = Rehearsal(problem.context, BEGIN, route_over(lanes([0, 7, 3, 10, 1, 12, 5, 8, 2, 11, 4, 9, 6])))
    good = Rehearsal(problem.context, BEGIN, route_over(
        [lane[::1 - 2 * (number % 2)] for number, lane in enumerate(lanes(range(13)))]))
    after = rebuilt_rehearsal(problem, before)
    assert after.is_complete and after.seconds < min(1.02 * good.seconds, 0.75 * before.seconds)
    assert after.swept.coverage > good.swept.coverage - 0.01


def test_pieces_of_other_drafts_sweep_what_a_route_leaves():
    problem = problem_of()
    half = Rehearsal(problem.context, BEGIN, route_over(lanes(range(6))))
    after = rebuilt_rehearsal(problem, half, lanes(range(6, 13)))
    assert after.swept.coverage > half.swept.coverage + 0.35


def test_floor_that_an_obstacle_bars_is_not_driven_to():
    problem = problem_of()
    problem.around[problem.context.plan.free.shape[0] // 2:] = False
    half = Rehearsal(problem.context, BEGIN, route_over(lanes(range(6))))
    route = rebuilt_route(problem, half, lanes(range(6, 13)))
    assert 1.3 < route.waypoints[:, 1].max() < 1.7


def test_what_takes_long_for_its_area_is_swept_for_a_high_target_alone():
    swept = []
    for target in (0.5, 0.95, 0.999):
        problem = problem_of(target_coverage=target)
        lane = Rehearsal(problem.context, BEGIN, route_over(lanes([0])))
        spots = [np.array([[x, 0.72], [x, 0.8]]) for x in np.arange(0.5, 3.7, 0.4)]  # 0.0136 m^2 each, in 3 s or more
        swept.append(rebuilt_rehearsal(problem, lane, spots).swept.coverage)
    assert swept[0] == swept[1] < swept[2] - 0.005


def test_pieces_of_other_drafts_replace_what_takes_longer():
    problem = problem_of()
    zigzag = [np.stack([np.linspace(0.3, 3.7, 30), 0.3 + BRUSH * np.arange(30) % 1.0], axis=1)]
    slow = Rehearsal(problem.context, BEGIN, route_over(zigzag))
    quick = rebuilt_rehearsal(problem, slow, lanes(range(13)))
    assert quick.swept.coverage > slow.swept.coverage + 0.3
    assert quick.seconds / quick.swept.coverage < 0.75 * slow.seconds / slow.swept.coverage


@pytest.mark.parametrize('end, last', [(None, 1), (Pose(1.7, 1.2, 0.0), 1), (Pose(0.3, 2.5, 0.0), 0)])
def test_a_rebuilt_route_ends_near_where_it_should(end, last):
    """Of two parts the nearer one is cleaned first, except if the robot is to end there."""
    problem = problem_of(end=end)
    parts = [np.array([[0.3, 1.6], [0.3, 2.5]]), np.array([[1.7, 0.6], [1.7, 1.4]])]
    before = Rehearsal(problem.context, BEGIN, route_over(parts))
    route = rebuilt_route(problem, before, [])
    assert np.hypot(*(parts[last] - route.waypoints[-1]).T).min() < 1e-6


def test_a_rebuilt_route_leads_around_walls():
    problem = problem_of(room(4.0, 3.0, 0.02, [(1.9, 0.0, 2.1, 2.2)]))
    columns = [np.array([[x, 0.3], [x, 1.9]]) for x in (0.3, 0.47, 0.64, 2.4, 2.57, 2.74)]
    way = [columns[0], columns[1], columns[2][::-1], np.array([[0.64, 2.6], [2.4, 2.6]]), *columns[3:]]
    before = Rehearsal(problem.context, BEGIN, route_over(way))
    after = rebuilt_rehearsal(problem, before)
    assert before.is_complete and after.is_complete and after.seconds < 0.9 * before.seconds
    assert after.swept.coverage > before.swept.coverage - 0.02
    assert (problem.context.ground.are_free(after.route.waypoints)).mean() > 0.97
