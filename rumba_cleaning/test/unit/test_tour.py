"""The order of stretches against all possible orders, and lengths of paths against their closed form."""

import itertools
import math

import numpy as np
import pytest
from floors import ground, over
from pytest import approx
from rooms import crooked, room

from rumba_cleaning.planning.tour import FAR, Stretch, distances, tour

HALL = ground(room(8.0, 6.0, 0.1))


def either_end(*points):
    """A stretch that may be driven from either end of a path."""
    path = np.array(points, float)
    return Stretch([path, path[::-1]])


def only(*points):
    """A stretch that may be driven only from the first end of a path."""
    return Stretch([np.array(points, float)])


def cost(start, stretches, order, end=None):
    """Distance [m] straight from stretch to stretch, and from the last one to the end if there is an end."""
    here, total = np.array(start), 0.0
    for index, variant in order:
        path = stretches[index].variants[variant]
        total += math.hypot(*(path[0] - here))
        here = path[-1]
    return total + (math.hypot(*(here - np.array(end))) if end is not None else 0.0)


def cheapest(start, stretches, end=None):
    """Cost [m] of the best of all orders and variants."""
    variants = [range(len(stretch.variants)) for stretch in stretches]
    return min(cost(start, stretches, list(zip(order, [which[index] for index in order])), end)
               for order in itertools.permutations(range(len(stretches)))
               for which in itertools.product(*variants))


def random_stretches(generator, count):
    """Stretches in the hall with one to four variants each."""
    stretches = []
    for _ in range(count):
        middle = generator.uniform((1.2, 1.2), (6.8, 4.8))
        one, other = (np.array([middle, middle + generator.uniform(-0.9, 0.9, 2)]) for _ in range(2))
        stretches.append(Stretch([one, one[::-1], other, other[::-1]][:generator.integers(1, 5)]))
    return stretches


@pytest.mark.parametrize('has_end', [False, True])
@pytest.mark.parametrize('count', [1, 2, 3, 4])
def test_a_tour_of_few_stretches_is_nearly_always_the_best(count, has_end):
    generator = np.random.default_rng(10 * count + has_end)
    shares = []
    for _ in range(15):
        start, stretches = generator.uniform((0.5, 0.5), (7.5, 5.5)), random_stretches(generator, count)
        end = generator.uniform((0.5, 0.5), (7.5, 5.5)) if has_end else None
        order = tour(HALL, start, stretches, None if end is None else np.array(end))
        assert sorted(index for index, _ in order) == list(range(count))
        shares.append(cost(start, stretches, order, end) / cheapest(start, stretches, end))
    assert max(shares) < 1.15 and np.median(shares) == approx(1.0) and np.mean(shares) < 1.03


def test_a_tour_of_many_stretches_along_a_line_drives_them_one_after_the_other():
    stretches = [either_end((x, 3.0), (x + 0.2, 3.0)) for x in (5.0, 1.0, 3.0, 7.0, 2.0, 6.0, 4.0)]
    order = tour(HALL, np.array([0.5, 3.0]), stretches)
    assert order == [(1, 0), (4, 0), (2, 0), (6, 0), (0, 0), (5, 0), (3, 0)]
    back = tour(HALL, np.array([7.6, 3.0]), stretches)
    assert back == [(index, 1) for index, _ in order[::-1]]


def test_lanes_side_by_side_are_driven_to_and_fro():
    stretches = [either_end((1.0, y), (6.0, y)) for y in (2.0, 1.0, 4.0, 3.0)]
    assert tour(HALL, np.array([0.7, 0.7]), stretches) == [(1, 0), (0, 1), (3, 0), (2, 1)]


def test_a_stretch_with_one_direction_is_not_driven_in_the_other():
    there, back = only((1.0, 1.0), (6.0, 1.0)), only((6.0, 2.0), (1.0, 2.0))
    assert tour(HALL, np.array([0.7, 0.7]), [back, there]) == [(1, 0), (0, 0)]


def test_a_tour_ends_near_the_end_that_is_asked_for():
    start = np.array([4.0, 3.0])
    left, right = only((1.0, 3.0), (1.0, 3.5)), only((7.0, 3.0), (7.0, 3.5))
    assert tour(HALL, start, [left, right], np.array([0.6, 3.0])) == [(1, 0), (0, 0)]
    assert tour(HALL, start, [left, right], np.array([7.4, 3.0])) == [(0, 0), (1, 0)]
    across = either_end((3.0, 4.0), (5.0, 4.0))
    assert tour(HALL, start, [across], np.array([0.6, 4.0])) == [(0, 1)]
    assert tour(HALL, start, [across], np.array([7.4, 4.0])) == [(0, 0)]


def test_one_stretch_is_driven_from_its_nearer_end():
    stretch = either_end((2.0, 3.0), (6.0, 3.0))
    assert tour(HALL, np.array([1.0, 3.0]), [stretch]) == [(0, 0)]
    assert tour(HALL, np.array([7.0, 3.0]), [stretch]) == [(0, 1)]
    assert tour(HALL, np.array([1.0, 3.0]), [only((6.0, 3.0), (2.0, 3.0))]) == [(0, 0)]


def test_what_lies_behind_a_wall_is_driven_last():
    floor = ground(room(4.0, 3.0, boxes=[(1.9, 0.0, 2.1, 2.2)]))
    beyond, on_this_side = only((2.4, 0.5), (2.4, 0.6)), only((0.4, 1.2), (0.4, 1.3))
    assert tour(floor, np.array([1.6, 0.5]), [beyond, on_this_side]) == [(1, 0), (0, 0)]


def test_stretches_that_cannot_be_reached_are_still_listed_once():
    floor = ground(room(4.0, 2.0, boxes=[(1.9, 0.0, 2.1, 2.0)]))
    stretches = [either_end((x, 0.5), (x, 1.5)) for x in (3.0, 0.5, 3.5, 1.0)]
    for end in (None, np.array([3.0, 1.0])):
        order = tour(floor, np.array([0.3, 0.3]), stretches, end)
        assert sorted(index for index, _ in order) == [0, 1, 2, 3]


@pytest.mark.parametrize('points', [[(3, 4), (3, 3), (7, 1), (6, 3), (5, 3), (1, 4)],
                                    [(3, 4), (7, 5), (3, 5), (6, 4), (5, 4), (2, 5)],
                                    [(5, 5), (2, 2), (3, 5), (2, 5), (3, 1), (1, 3)]])
def test_neighbours_are_moved_together_if_that_shortens_a_tour(points):
    start, stretches = (0.5, 0.5), [only(point, point) for point in points]
    order = tour(HALL, np.array(start), stretches)
    assert cost(start, stretches, order) == approx(cheapest(start, stretches))


def test_a_tour_is_the_same_each_time():
    stretches = random_stretches(np.random.default_rng(8), 7)
    assert tour(HALL, np.array([0.5, 0.5]), stretches) == tour(HALL, np.array([0.5, 0.5]), stretches)


# --- lengths of paths ----------------------------------------------------------------------------------------------

STARTS, ENDS = np.array([[0.5, 0.5], [0.3, 1.9], [1.2, 0.3]]), np.array([[3.5, 0.5], [3.0, 0.4]])


@pytest.mark.parametrize('resolution', [0.02, 0.05, 0.1])
def test_lengths_through_a_gap_are_about_those_of_the_shortest_paths(resolution):
    floor = ground(room(4.0, 3.0, resolution, [(1.9, 0.0, 2.1, 2.2)]))
    found = distances(floor, STARTS, ENDS)
    shortest = np.array([[over(start, (1.9, 2.2), (2.1, 2.2), end, floor.reach) for end in ENDS] for start in STARTS])
    assert found.shape == (3, 2) and (0.97 * shortest <= found).all() and (found <= 1.12 * shortest).all()
    assert distances(floor, ENDS, STARTS) == approx(found.T, rel=0.03)


@pytest.mark.parametrize('resolution', [0.02, 0.1])
def test_lengths_through_a_gap_far_away_are_found_too(resolution):
    floor = ground(room(4.0, 8.0, resolution, [(1.9, 0.0, 2.1, 7.2)]))
    shortest = over((0.5, 0.5), (1.9, 7.2), (2.1, 7.2), (3.5, 0.5), floor.reach)
    found = distances(floor, STARTS[:1], ENDS[:1])
    assert 0.97 * shortest <= found[0, 0] <= 1.1 * shortest


def test_lengths_through_a_passage_narrower_than_a_node_of_the_coarse_graph_are_found():
    for bottom in np.arange(2.0, 2.2, 0.02):  # wherever the coarse nodes lie
        floor = ground(room(6.0, 4.4, 0.02, [(2.0, 0.0, 4.0, bottom), (2.0, bottom + 0.38, 4.0, 4.4)]))
        ends = np.array([[1.0, bottom + 0.2], [5.0, bottom + 0.2]])
        assert distances(floor, ends[:1], ends[1:])[0, 0] == approx(4.0, abs=0.3)


def test_lengths_over_free_floor_are_never_shorter_than_straight_and_little_longer():
    generator = np.random.default_rng(2)
    starts, ends = (generator.uniform((0.3, 0.3), (7.7, 5.7), (20, 2)) for _ in range(2))
    straight = np.hypot(*(starts[:, np.newaxis] - ends).transpose(2, 0, 1))
    found = distances(HALL, starts, ends)
    assert (found >= straight - 1e-9).all() and (found <= 1.09 * straight + 0.2).all()
    assert np.diagonal(distances(HALL, starts, starts)) == approx(0.0)


def test_the_length_to_a_point_that_cannot_be_reached_is_large_and_finite():
    floor = ground(room(4.0, 2.0, boxes=[(1.9, 0.0, 2.1, 2.0)]))
    points = np.array([[0.5, 0.5], [1.0, 1.0], [3.0, 1.0]])
    found = distances(floor, points, points)
    assert (found[[0, 1, 2, 2], [2, 2, 0, 1]] == FAR).all()
    assert found[0, 1] == approx(math.hypot(0.5, 0.5), abs=0.1) and found[2, 2] == 0.0


def test_obstacles_that_were_met_make_paths_longer():
    floor = ground(crooked())
    before = distances(floor, np.array([[0.8, 1.5]]), np.array([[2.2, 1.5]]))[0, 0]
    for y in (1.1, 1.4, 1.7):
        floor.mark(1.5, y, 0.1)
    assert distances(floor, np.array([[0.8, 1.5]]), np.array([[2.2, 1.5]]))[0, 0] > before + 0.2
