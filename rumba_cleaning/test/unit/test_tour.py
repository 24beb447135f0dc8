"""Tours against all possible orders, ways against their closed form, compiled code against the same code uncompiled."""

import itertools
import pathlib
import types

import numpy as np
import pytest
from floors import ground, length, over
from hypothesis import given, settings
from hypothesis import strategies as st
from pytest import approx
from rooms import room

from rumba_cleaning.planning.common import compiled_ways
from rumba_cleaning.planning.common.compiled_ways import Needed
from rumba_cleaning.planning.common.stretches import Stretch, pair
from rumba_cleaning.planning.order import compiled_tours
from rumba_cleaning.planning.order.tour import BESIDE, Tour, order

HALL = ground(room(8.0, 6.0, 0.1))
SPEED = 0.45


def over_path(*points):
    """A stretch along a path."""
    return Stretch(pair([np.array(points, float)]), 1, 1.0)


def random_stretches(generator, count):
    """Stretches in the hall with one or two paths each."""
    found = []
    for _ in range(count):
        middle = generator.uniform((1.2, 1.2), (6.8, 4.8))
        paths = [np.array([middle, middle + generator.uniform(-0.9, 0.9, 2)]) for _ in range(generator.integers(1, 3))]
        found.append(Stretch([variant for path in paths for variant in pair([path])], 1, 1.0))
    return found


def time_of(made):
    """The time between the stretches of a tour [s]."""
    return compiled_tours.length(made._costs, made._tour)


def best_time(made, sizes):
    """The least time of all orders and variants, by the costs that a tour compares."""
    begins = np.concatenate([[0], np.cumsum(sizes)])
    times = []
    for which in itertools.permutations(range(len(sizes))):
        for variants in itertools.product(*(range(begins[index], begins[index + 1]) for index in which)):
            rows = [len(made._costs) - 1, *variants[:-1]]
            times.append(made._costs[rows, list(variants)].sum() + made._costs[variants[-1], -1])
    return min(times)


@pytest.mark.parametrize('has_end', [False, True])
@pytest.mark.parametrize('count', [1, 2, 3, 4])
def test_a_tour_of_few_stretches_is_nearly_always_the_best(count, has_end):
    generator = np.random.default_rng(10 * count + has_end)
    shares = []
    for _ in range(12):
        stretches = random_stretches(generator, count)
        end = generator.uniform((0.5, 0.5), (7.5, 5.5)) if has_end else None
        made = Tour(HALL, generator.uniform((0.5, 0.5), (7.5, 5.5)), stretches, end, SPEED)
        assert sorted(leg.stretch for leg in made.legs()) == list(range(count))
        shares.append(time_of(made) / best_time(made, [len(part.variants) for part in stretches]))
    assert max(shares) < 1.1 and np.median(shares) == approx(1.0)


def test_stretches_along_a_line_are_driven_one_after_the_other():
    stretches = [over_path((x, 3.0), (x + 0.2, 3.0)) for x in (5.0, 1.0, 3.0, 7.0, 2.0, 6.0, 4.0)]
    there = Tour(HALL, np.array([0.5, 3.0]), stretches, None, SPEED).legs()
    assert [(leg.stretch, leg.variant) for leg in there] == [(1, 0), (4, 0), (2, 0), (6, 0), (0, 0), (5, 0), (3, 0)]
    back = Tour(HALL, np.array([7.6, 3.0]), stretches, None, SPEED).legs()
    assert [(leg.stretch, leg.variant) for leg in back] == [(leg.stretch, 1) for leg in there[::-1]]


def test_a_tour_ends_near_the_end_that_is_asked_for():
    across = over_path((3.0, 4.0), (5.0, 4.0))
    for end, variant in (((0.6, 4.0), 1), ((7.4, 4.0), 0)):
        leg, = Tour(HALL, np.array([4.0, 3.0]), [across], np.array(end), SPEED).legs()
        assert leg.variant == variant


def test_a_stretch_ahead_is_nearer_than_one_behind():
    """A robot that turns back loses time."""
    first = over_path((1.0, 3.0), (4.0, 3.0))
    ahead, behind = over_path((4.7, 3.0), (4.9, 3.0)), over_path((3.5, 3.2), (3.3, 3.2))
    legs = Tour(HALL, np.array([0.9, 3.0]), [first, behind, ahead], np.array([1.0, 3.2]), SPEED).legs()
    assert [leg.stretch for leg in legs] == [0, 2, 1]


def test_ways_lead_around_walls_and_end_at_the_stretches():
    floor = ground(room(4.0, 3.0, 0.05, [(1.9, 0.0, 2.1, 2.2)]))
    gap = [over_path((x, 2.55), (x + 0.1, 2.55)) for x in (1.5, 1.95, 2.3)]
    stretches = [*gap, over_path((3.5, 0.5), (3.5, 0.6))]
    start = np.array([0.5, 0.5])
    legs = Tour(floor, start, stretches, None, SPEED).legs()
    here, total = start, 0.0
    for leg in legs:
        path = stretches[leg.stretch].variants[leg.variant].path()
        assert leg.way[0] == approx(here, abs=1e-3) and leg.way[-1] == approx(path[0], abs=1e-3)
        total += length(leg.way) + length(path)
        here = path[-1]
    assert total >= over((0.5, 0.5), (1.9, 2.2), (2.1, 2.2), (3.5, 0.5), floor.reach) - 0.05
    assert legs[-1].stretch == 3


def test_walls_do_not_vanish_from_ways():
    floor = ground(room(4.0, 3.0, 0.05, [(1.95, 0.0, 2.0, 2.2)]))
    near = np.array([[1.7, 0.5], [2.3, 0.5]])
    metres, _ = compiled_ways.lengths(floor.clearance, Needed(floor.reach, floor.reach, 0.0, 0.05),
                                      (near - floor.plan.origin) / floor.plan.resolution, np.arange(2))
    assert metres[0, 1] == np.inf and metres[0, 0] == 0.0


@pytest.mark.parametrize('off, is_free', [(0.004, True), (-0.003, False)])
def test_near_its_ends_a_way_may_be_nearer_to_a_post_but_not_touch_it(off, is_free):
    reach, radius, resolution = 0.17, 0.02, 0.01
    y, x = resolution * np.mgrid[-60:61, -60:61]
    clearance = np.hypot(x, y + reach + off + radius) - radius
    needed = Needed(reach + 0.03, reach, 0.15 / resolution, resolution)
    along = 0.12 / resolution
    for way in ((-along, 0.0, along, 0.0), (along, 0.0, -along, 0.0), (0.0, along, 0.0, -along)):
        nodes = 60.0 + np.array(way)
        field = clearance if way[1] == 0.0 else np.ascontiguousarray(clearance.T)
        assert compiled_ways.sight(field, needed, *nodes) == is_free
        assert not compiled_ways.sight(field, needed._replace(near=0.0), *nodes)


@given(st.integers(0, 10 ** 6))
@settings(max_examples=50)
def test_a_line_of_sight_is_free_wherever_one_looks_although_free_floor_is_skipped(seed):
    generator = np.random.default_rng(seed)
    posts = generator.uniform(0.0, 5.0, (6, 2))
    y, x = 0.05 * np.mgrid[0:101, 0:101]
    clearance = np.min([np.hypot(x - post[0], y - post[1]) for post in posts], axis=0)
    needed = Needed(0.2, 0.2, 0.0, 0.05)
    ends = generator.uniform(0.1, 4.9, (30, 2, 2))
    for start, end in ends:
        line = start + np.linspace(0.0, 1.0, 500)[:, np.newaxis] * (end - start)
        least = np.min([np.hypot(*(line - post).T) for post in posts])
        if abs(least - 0.2) > 0.02:  # otherwise the grid decides
            assert compiled_ways.sight(clearance, needed, *start / 0.05, *end / 0.05) == (least > 0.2)


def test_a_way_keeps_off_walls_except_at_its_ends():
    """A robot that presses against a corner is stuck."""
    floor = ground(room(4.0, 3.0, 0.02, [(1.5, 0.0, 2.5, 1.0)]))
    corner = floor.reach + 1.0
    for above, longest in ((0.05, 1.951), (0.002, 2.1)):
        points = np.array([[1.0, corner + above], [3.0, corner + above]])
        stretches = [over_path(point, point + [0.05, 0.0]) for point in points]
        way = Tour(floor, points[0] - [0.3, 0.0], stretches, None, SPEED).legs()[1].way
        assert 1.949 < length(way) < longest
        assert way[1:-1, 1].min(initial=9.0) > corner + BESIDE


def test_a_tour_is_the_same_each_time():
    stretches = random_stretches(np.random.default_rng(8), 9)
    one, other = (Tour(HALL, np.array([0.5, 0.5]), stretches, None, SPEED).legs() for _ in range(2))
    assert [leg[:2] for leg in one] == [leg[:2] for leg in other]


def test_places_are_visited_once_each_by_a_short_way():
    places = np.random.default_rng(3).uniform(0.0, 10.0, (7, 2))
    times = np.hypot(*(places[:, np.newaxis] - places).transpose(2, 0, 1))
    costs = np.concatenate([times, np.hypot(*places.T)[np.newaxis]])
    best = min(costs[[7, *which[:-1]], list(which)].sum() for which in itertools.permutations(range(7)))
    costs = np.column_stack([costs, np.zeros(8)])
    found = order(costs)
    assert sorted(found) == list(range(7)) and costs[[7, *found[:-1]], found].sum() == approx(best, rel=0.05)
    costs[:, 3] = costs[3] = np.inf  # nothing leads there
    assert sorted(order(costs)) == list(range(7))


def test_a_way_over_places_to_a_point_is_short_too():
    places = np.random.default_rng(9).uniform(0.0, 10.0, (7, 2))
    times = np.hypot(*(places[:, np.newaxis] - places).transpose(2, 0, 1))
    costs = np.concatenate([times, np.hypot(*places.T)[np.newaxis]])
    last = np.append(np.hypot(*(places - 10.0).T), 14.0)

    def taken(which):
        return costs[[7, *which[:-1]], list(which)].sum() + last[which[-1]]

    best = min(itertools.permutations(range(7)), key=taken)
    assert taken(order(np.column_stack([costs, last]))) == approx(taken(best), rel=0.05)
    assert taken(order(np.column_stack([costs, np.zeros(8)]))) > 1.1 * taken(best)


def uncompiled(module, **names):
    """A module of the planner as plain Python, with other values for some of its names."""
    source = pathlib.Path(module.__file__).read_text().replace('@compiled', '')
    space = {}
    exec(compile(source, module.__file__, 'exec'), space)
    space.update(names)
    return types.SimpleNamespace(**space)


def test_compiled_and_uncompiled_tours_and_ways_are_equal():
    for seed in range(3):
        made = Tour(HALL, np.array([0.5, 0.5]), random_stretches(np.random.default_rng(seed), 6), None, SPEED)
        found = {}
        for name, module in (('compiled', compiled_tours), ('plain', uncompiled(compiled_tours))):
            found[name] = module.built(made._costs, made._begins)
            module.shake(made._costs, made._of, made._begins, found[name], np.array([[1, 3, 4], [2, 4, 7]]))
        assert (found['compiled'] == found['plain']).all()
        nodes = (made._points - HALL.plan.origin) / HALL.plan.resolution
        asked = (HALL.clearance, Needed(HALL.reach + 0.01, HALL.reach - 0.01, 1.0, 0.1), nodes,
                 np.arange(0, len(nodes), 2))
        assert uncompiled(compiled_ways).lengths(*asked)[0] == approx(compiled_ways.lengths(*asked)[0])


@pytest.mark.parametrize('seed', range(20))
def test_each_stretch_is_added_to_a_tour_where_it_costs_least(seed):
    generator = np.random.default_rng(seed)
    begins = np.concatenate([[0], np.cumsum([*generator.integers(1, 4, 9), 1])])
    end = begins[-2]
    costs = generator.integers(0, 12, (end + 1, end + 1)).astype(float)  # exact sums, and many that are equal
    tour = [end, end]
    for stretch in range(9):
        options = [[*tour[:place], variant, *tour[place:]] for variant in range(begins[stretch], begins[stretch + 1])
                   for place in range(1, len(tour))]
        tour = min(options, key=lambda option: compiled_tours.length(costs, np.array(option)))
    assert compiled_tours.built(costs, begins).tolist() == tour


def test_a_tour_that_is_searched_for_with_more_effort_is_shorter_or_the_same():
    times = np.array([[time_of(Tour(HALL, np.array([0.5, 0.5]), random_stretches(np.random.default_rng(seed), 40), None,
                                    SPEED, effort)) for effort in (0, 1, 10)] for seed in range(3)])
    assert (np.diff(times) <= 1e-9).all() and (times[:, 2] < times[:, 0]).all()


def test_segments_of_several_stretches_are_moved_too():
    single, several = uncompiled(compiled_tours, SEGMENTS=(1,)), compiled_tours
    times = np.zeros(2)
    for seed in range(4):
        made = Tour(HALL, np.array([0.5, 0.5]), random_stretches(np.random.default_rng(seed), 16), None, SPEED)
        for index, module in enumerate((single, several)):
            found = compiled_tours.built(made._costs, made._begins)
            for size in module.SEGMENTS:
                module.moved(made._costs, made._of, made._begins, found, size)
            times[index] += compiled_tours.length(made._costs, found)
    assert times[1] < 0.998 * times[0]


@pytest.mark.parametrize('part', ['untangled', 'moved'])
def test_an_improvement_goes_on_as_long_as_any_of_its_parts_helps(part):
    """It goes on in the next round if only one of its two parts changed anything in the last one."""
    rounds = []

    def once(*arguments):
        rounds.append(part)
        return len(rounds) == 1

    never = {name: (lambda *arguments: False) for name in ('untangled', 'moved')}
    plain = uncompiled(compiled_tours)
    plain.improve.__globals__.update({**never, part: once, 'rechosen': lambda *arguments: None, 'SEGMENTS': (1,)})
    plain.improve(None, None, None, np.zeros(9, int))
    assert len(rounds) == 2
