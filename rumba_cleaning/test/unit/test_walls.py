"""Ways along walls: how far from them, which of them, where they are parted, and what a brush on them sweeps."""

import math

import numpy as np
import pytest
from floors import BRUSH, ground, knowing, length, off, part_of, two_rooms
from hypothesis import given, settings
from hypothesis import strategies as st
from pytest import approx
from rooms import RADIUS, crooked, distances, room

from rumba_cleaning.planning import crumbs
from rumba_cleaning.planning.regions import rooms
from rumba_cleaning.planning.walls import MARGIN, band, resampled, walls
from rumba_sim.model.geometry import Pose

RESOLUTIONS = pytest.mark.parametrize('resolution', [0.02, 0.05, 0.1])
FINE = pytest.mark.parametrize('resolution', [0.02, 0.05])


def reachable(plan, *boxes):
    """What the brush can reach, of the floor in boxes where there are any: bool (rows, columns)."""
    x, y, _ = plan.most_open_pose()
    return plan.reachable(x, y, RADIUS, BRUSH) & (part_of(plan, *boxes) if boxes else plan.free)


def ways(plan, missed=None):
    """Along the walls of a plan where something was missed, by default all that the brush can reach."""
    floor = ground(plan)
    return walls(floor, reachable(plan) if missed is None else missed.copy(), rooms(floor), BRUSH)


# --- which walls ---------------------------------------------------------------------------------------------------

@RESOLUTIONS
def test_an_empty_room_has_one_closed_way_all_along_its_walls(resolution):
    plan = room(4.0, 3.0, resolution)
    wall, = ways(plan)
    away = ground(plan).reach + 0.01
    assert MARGIN == 0.01 and wall.is_closed and wall.places[0] == approx(wall.places[-1])
    exact = distances(plan, wall.places)
    assert min(exact) >= away - 1e-9 and max(exact) < away + resolution
    assert sorted(exact)[int(0.95 * len(exact))] == approx(away)  # farther off in corners, which are cut
    assert length(wall.places) == approx(2.0 * (4.0 + 3.0 - 4.0 * away), abs=2.4 * resolution)
    assert wall.places.min(axis=0) == approx([away, away])
    assert wall.places.max(axis=0) == approx([4.0 - away, 3.0 - away])
    assert 0.01 < np.hypot(*np.diff(wall.places, axis=0).T).max() < 0.03


@RESOLUTIONS
def test_an_island_has_a_way_of_its_own(resolution):
    plan = room(4.0, 3.0, resolution, [(1.7, 1.3, 2.2, 1.7)])
    found = ways(plan)
    away = ground(plan).reach + 0.01
    outer, island = found
    assert outer.is_closed and island.is_closed and length(outer.places) > length(island.places)
    assert length(island.places) == approx(2.0 * (0.5 + 0.4) + 2.0 * math.pi * away, rel=0.01)
    exact = distances(plan, island.places)
    assert exact == approx(away, abs=0.009 if resolution == 0.1 else 0.003)
    assert min(exact) >= ground(plan).reach
    x, y = island.places.mean(axis=0)
    assert (x, y) == approx((1.95, 1.5), abs=0.02)


def long_ways(plan, missed):
    """Ways where something was missed, but for those past single cells beside a bend."""
    return [wall for wall in ways(plan, missed) if length(wall.places) > 0.3]


@pytest.mark.parametrize('swept', ['outer', 'island'])
@FINE
def test_a_wall_whose_band_was_swept_before_is_left_out(resolution, swept):
    plan = room(4.0, 3.0, resolution, [(1.7, 1.3, 2.2, 1.7)])
    outer, island = ways(plan)
    gone, kept = (outer, island) if swept == 'outer' else (island, outer)
    context = knowing(plan, Pose(0.5, 0.5, 0.0))
    crumbs.drive(context.swept, gone.places)
    wall, = long_ways(plan, context.swept.missed())
    assert wall.places == approx(kept.places) and wall.is_closed
    crumbs.drive(context.swept, kept.places)
    assert context.swept.missed().any() and long_ways(plan, context.swept.missed()) == []
    assert ways(plan, np.zeros(plan.occupancy.shape, bool)) == []


def test_what_the_ways_clean_is_missed_no_more():
    plan = room(4.0, 3.0, 0.02, [(1.7, 1.3, 2.2, 1.7)])
    floor = ground(plan)
    before = reachable(plan)
    missed = before.copy()
    found = walls(floor, missed, rooms(floor), BRUSH)
    bands = np.any([band(floor, wall.places, BRUSH) for wall in found], axis=0)
    assert (missed == (before & ~bands)).all() and 0.2 < bands.sum() / before.sum() < 0.6


# --- parts of walls ------------------------------------------------------------------------------------------------

@pytest.mark.parametrize('box, low, high', [
    ((0.0, 0.6, 0.4, 1.5), (0.18, 0.6), (0.2, 1.5)), ((3.6, 1.2, 4.0, 2.0), (3.8, 1.2), (3.82, 2.0)),
    ((1.0, 2.6, 3.0, 3.0), (1.0, 2.8), (3.0, 2.82)), ((0.9, 0.0, 1.6, 0.4), (0.9, 0.18), (1.6, 0.2)),
    ((0.0, 0.0, 0.6, 0.6), (0.18, 0.18), (0.6, 0.6)), ((0.0, 2.4, 0.6, 3.0), (0.18, 2.4), (0.6, 2.82)),
    ((3.4, 2.4, 4.0, 3.0), (3.4, 2.4), (3.82, 2.82)), ((3.4, 0.0, 4.0, 0.6), (3.4, 0.18), (3.82, 0.6))])
def test_only_the_part_of_a_wall_is_driven_along_which_something_was_missed(box, low, high):
    plan = room(4.0, 3.0, 0.02)
    wall, = ways(plan, reachable(plan, box))
    assert not wall.is_closed
    assert wall.places.min(axis=0) == approx(low, abs=0.04) and wall.places.max(axis=0) == approx(high, abs=0.04)
    assert min(distances(plan, wall.places)) >= ground(plan).reach


def test_a_short_piece_that_needs_nothing_is_driven_too_and_a_long_one_is_not():
    plan = room(4.0, 3.0, 0.02)
    whole, = ways(plan, reachable(plan, (0.6, 0.0, 1.4, 0.4), (1.7, 0.0, 2.5, 0.4)))
    assert length(whole.places) == approx(1.9, abs=0.06)
    one, other = ways(plan, reachable(plan, (0.6, 0.0, 1.2, 0.4), (2.2, 0.0, 3.0, 0.4)))
    assert length(one.places) + length(other.places) == approx(1.4, abs=0.12)


def test_all_of_a_wall_is_driven_where_nearly_all_of_it_is_needed():
    plan = room(4.0, 3.0, 0.02)
    everything = reachable(plan)
    little, much = (everything & ~part_of(plan, (1.0, 0.0, 1.0 + gap, 0.4)) for gap in (1.2, 2.4))
    wall, = ways(plan, little)
    assert wall.is_closed and length(wall.places) == approx(length(ways(plan)[0].places))
    wall, = ways(plan, much)
    assert not wall.is_closed and length(wall.places) == approx(length(ways(plan)[0].places) - 2.4, abs=0.1)
    assert not ((abs(wall.places[:, 0] - 2.2) < 1.1) & (wall.places[:, 1] < 0.3)).any()


def test_a_few_specks_beside_a_wall_need_no_way_along_it():
    plan = room(4.0, 3.0, 0.02)
    specks = np.zeros(plan.occupancy.shape, bool)
    specks[13, 30:170:20] = True
    assert reachable(plan)[specks].all() and ways(plan, specks) == []
    assert ways(plan, reachable(plan, (1.0, 0.0, 1.05, 0.4))) == []


# --- rooms ---------------------------------------------------------------------------------------------------------

@FINE
def test_a_way_through_a_door_is_parted_by_rooms(resolution):
    plan = two_rooms(resolution)
    floor = ground(plan)
    labels = rooms(floor)
    left, right = sorted(ways(plan), key=lambda wall: wall.places[:, 0].min())
    assert left.room == labels[floor.node(1.0, 1.0)] and right.room == labels[floor.node(4.0, 1.0)]
    assert not left.is_closed and not right.is_closed and left.room != right.room
    away = floor.reach + MARGIN
    assert left.places.min(axis=0) == approx([away, away])
    assert right.places.max(axis=0) == approx([5.0 - away, 2.4 - away])
    assert left.places[:, 0].max() < 3.05 and right.places[:, 0].min() > 2.65
    for wall in (left, right):  # from one side of the door to its other side, without a leap
        assert np.hypot(*np.diff(wall.places, axis=0).T).max() < 0.03
        assert math.hypot(*(wall.places[0] - wall.places[-1])) == approx(0.7 - 2.0 * away, abs=0.1)


def test_an_island_in_one_of_two_rooms_has_the_room_it_lies_in():
    plan = room(5.0, 3.0, 0.05, [(2.8, 0.0, 2.9, 0.3), (2.8, 1.0, 2.9, 3.0), (1.2, 1.2, 1.4, 1.4)])
    floor = ground(plan)
    labels = rooms(floor)
    island, = [wall for wall in ways(plan) if wall.is_closed]
    assert island.room == labels[floor.node(0.8, 0.8)] == labels[floor.node(1.8, 1.8)]


def test_ways_come_the_longest_first():
    found = ways(crooked(0.02, cliff=(3.6, 2.6, 4.0, 3.0)))
    lengths = [length(wall.places) for wall in found]
    assert lengths == sorted(lengths, reverse=True) and len(found) >= 3


def test_a_way_keeps_off_a_cliff_as_off_a_wall():
    plan = crooked(0.02, cliff=(3.4, 2.4, 4.0, 3.0))
    for wall in ways(plan):
        beyond = np.maximum(np.array([3.4, 2.4]) - wall.places, 0.0)
        assert min(np.hypot(*beyond.T)) >= ground(plan).reach


# --- bands and steps -----------------------------------------------------------------------------------------------

def brute_band(floor, places, width):
    """Distance of the middle of each cell from a way, less half of the width [m]: float64 (rows, columns)."""
    rows, columns = np.indices(floor.plan.occupancy.shape)
    middles = floor.places(np.stack([rows.ravel() + 0.5, columns.ravel() + 0.5], axis=1))
    away = [off(middles, start, end) for start, end in zip(places[:-1], places[1:])]
    return np.min(away, axis=0).reshape(rows.shape) - 0.5 * width


@pytest.mark.parametrize('width', [0.08, 0.17, 0.3])
@RESOLUTIONS
def test_a_band_along_the_grid_holds_just_the_cells_of_a_brute_force_count(resolution, width):
    floor = ground(room(3.0, 2.0, resolution))
    places = np.array([[0.5, 0.6], [2.2, 0.6], [2.2, 1.5]])
    away = brute_band(floor, places, width)
    clear = abs(away) > 1e-9  # of those just on the edge either is right
    assert (band(floor, places, width) == (away < 0.0))[clear].all()


PLACES = st.tuples(st.integers(0, 300), st.integers(0, 200)).map(lambda place: (place[0] / 100.0, place[1] / 100.0))


@settings(max_examples=40)
@given(st.sampled_from([0.02, 0.05, 0.1]), st.sampled_from([0.1, 0.17, 0.4]),
       st.lists(PLACES, min_size=2, max_size=4, unique=True))
def test_a_band_is_that_of_a_brute_force_count_but_for_cells_on_its_edge(resolution, width, places):
    floor = ground(room(3.0, 2.0, resolution))
    away = brute_band(floor, np.array(places), width)
    found = band(floor, np.array(places), width)
    assert not found[away > 0.45 * resolution].any() and found[away < -0.45 * resolution].all()


def test_places_are_spread_evenly_along_a_way_and_keep_its_ends_and_its_length():
    way = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 0.5], [1.6, 1.3]])
    found = resampled(way, 0.02)
    assert (found[0] == way[0]).all() and (found[-1] == way[-1]).all() and len(found) == 126
    assert length(found) == approx(2.5, abs=0.01) and length(found) <= 2.5
    assert np.hypot(*np.diff(found, axis=0).T) == approx(0.02, abs=0.007)
    for start, end in zip(way[:-1], way[1:]):
        assert (off(found, start, end) < 1e-9).any()
    assert max(np.min([off(found, start, end) for start, end in zip(way[:-1], way[1:])], axis=0)) < 1e-9


def test_a_way_that_is_shorter_than_a_step_keeps_its_ends():
    assert resampled(np.array([[1.0, 2.0], [1.001, 2.0]]), 0.02).tolist() == [[1.0, 2.0], [1.001, 2.0]]
    assert resampled(np.array([[1.0, 2.0], [1.0, 2.0]]), 0.02).tolist() == [[1.0, 2.0], [1.0, 2.0]]
    assert resampled(np.array([[1.0, 2.0], [1.03, 2.0]]), 0.02).tolist() == [[1.0, 2.0], [1.03, 2.0]]
