"""Paths along walls: their distance from the wall, which walls and which parts of them, and what the brush sweeps."""

import math

import numpy as np
import pytest
from floors import BRUSH, ground, knowing, length, off, part_of, two_rooms
from hypothesis import given, settings
from hypothesis import strategies as st
from pytest import approx
from rooms import RADIUS, crooked, distances, room

from rumba_cleaning.planning import crumbs
from rumba_cleaning.planning.regions import regions
from rumba_cleaning.planning.walls import WALL_MARGIN, band, resampled, walls
from rumba_sim.model.geometry import Pose

RESOLUTIONS = pytest.mark.parametrize('resolution', [0.02, 0.05, 0.1])
FINE = pytest.mark.parametrize('resolution', [0.02, 0.05])


def reachable(plan, *boxes):
    """The cells that the brush can reach, only those in boxes if any are given: bool (rows, columns)."""
    x, y, _ = plan.most_open_pose()
    return plan.reachable(x, y, RADIUS, BRUSH) & (part_of(plan, *boxes) if boxes else plan.free)


def paths(plan, missed=None):
    """Paths along the walls of a plan; by default, all that the brush can reach was missed."""
    floor = ground(plan)
    return walls(floor, reachable(plan) if missed is None else missed.copy(), regions(floor), BRUSH)


# --- which walls ---------------------------------------------------------------------------------------------------

@RESOLUTIONS
def test_an_empty_room_has_one_closed_path_all_along_its_walls(resolution):
    plan = room(4.0, 3.0, resolution)
    wall, = paths(plan)
    away = ground(plan).reach + 0.01
    assert WALL_MARGIN == 0.01 and wall.is_closed and wall.waypoints[0] == approx(wall.waypoints[-1])
    exact = distances(plan, wall.waypoints)
    assert min(exact) >= away - 1e-9 and max(exact) < away + resolution
    assert sorted(exact)[int(0.95 * len(exact))] == approx(away)  # farther off in corners, which are cut
    assert length(wall.waypoints) == approx(2.0 * (4.0 + 3.0 - 4.0 * away), abs=2.4 * resolution)
    assert wall.waypoints.min(axis=0) == approx([away, away])
    assert wall.waypoints.max(axis=0) == approx([4.0 - away, 3.0 - away])
    assert 0.01 < np.hypot(*np.diff(wall.waypoints, axis=0).T).max() < 0.03


@RESOLUTIONS
def test_an_island_has_a_path_of_its_own(resolution):
    plan = room(4.0, 3.0, resolution, [(1.7, 1.3, 2.2, 1.7)])
    found = paths(plan)
    away = ground(plan).reach + 0.01
    outer, island = found
    assert outer.is_closed and island.is_closed and length(outer.waypoints) > length(island.waypoints)
    assert length(island.waypoints) == approx(2.0 * (0.5 + 0.4) + 2.0 * math.pi * away, rel=0.01)
    exact = distances(plan, island.waypoints)
    assert exact == approx(away, abs=0.009 if resolution == 0.1 else 0.003)
    assert min(exact) >= ground(plan).reach
    x, y = island.waypoints.mean(axis=0)
    assert (x, y) == approx((1.95, 1.5), abs=0.02)


def long_paths(plan, missed):
    """Paths along walls, except the short ones past single cells beside a bend."""
    return [wall for wall in paths(plan, missed) if length(wall.waypoints) > 0.3]


@pytest.mark.parametrize('swept', ['outer', 'island'])
@FINE
def test_a_wall_is_left_out_if_the_floor_beside_it_was_swept_before(resolution, swept):
    plan = room(4.0, 3.0, resolution, [(1.7, 1.3, 2.2, 1.7)])
    outer, island = paths(plan)
    gone, kept = (outer, island) if swept == 'outer' else (island, outer)
    context = knowing(plan, Pose(0.5, 0.5, 0.0))
    crumbs.drive(context.swept, gone.waypoints)
    wall, = long_paths(plan, context.swept.missed())
    assert wall.waypoints == approx(kept.waypoints) and wall.is_closed
    crumbs.drive(context.swept, kept.waypoints)
    assert context.swept.missed().any() and long_paths(plan, context.swept.missed()) == []
    assert paths(plan, np.zeros(plan.occupancy.shape, bool)) == []


def test_what_the_paths_clean_is_no_longer_missed():
    plan = room(4.0, 3.0, 0.02, [(1.7, 1.3, 2.2, 1.7)])
    floor = ground(plan)
    before = reachable(plan)
    missed = before.copy()
    found = walls(floor, missed, regions(floor), BRUSH)
    bands = np.any([band(floor, wall.waypoints, BRUSH) for wall in found], axis=0)
    assert (missed == (before & ~bands)).all() and 0.2 < bands.sum() / before.sum() < 0.6


# --- parts of walls ------------------------------------------------------------------------------------------------

@pytest.mark.parametrize('box, low, high', [
    ((0.0, 0.6, 0.4, 1.5), (0.18, 0.6), (0.2, 1.5)), ((3.6, 1.2, 4.0, 2.0), (3.8, 1.2), (3.82, 2.0)),
    ((1.0, 2.6, 3.0, 3.0), (1.0, 2.8), (3.0, 2.82)), ((0.9, 0.0, 1.6, 0.4), (0.9, 0.18), (1.6, 0.2)),
    ((0.0, 0.0, 0.6, 0.6), (0.18, 0.18), (0.6, 0.6)), ((0.0, 2.4, 0.6, 3.0), (0.18, 2.4), (0.6, 2.82)),
    ((3.4, 2.4, 4.0, 3.0), (3.4, 2.4), (3.82, 2.82)), ((3.4, 0.0, 4.0, 0.6), (3.4, 0.18), (3.82, 0.6))])
def test_only_that_part_of_a_wall_is_driven_beside_which_something_was_missed(box, low, high):
    plan = room(4.0, 3.0, 0.02)
    wall, = paths(plan, reachable(plan, box))
    assert not wall.is_closed
    assert wall.waypoints.min(axis=0) == approx(low, abs=0.04) and wall.waypoints.max(axis=0) == approx(high, abs=0.04)
    assert min(distances(plan, wall.waypoints)) >= ground(plan).reach


def test_a_short_swept_piece_of_a_wall_is_driven_too_and_a_long_one_is_not():
    plan = room(4.0, 3.0, 0.02)
    whole, = paths(plan, reachable(plan, (0.6, 0.0, 1.4, 0.4), (1.7, 0.0, 2.5, 0.4)))
    assert length(whole.waypoints) == approx(1.9, abs=0.06)
    one, other = paths(plan, reachable(plan, (0.6, 0.0, 1.2, 0.4), (2.2, 0.0, 3.0, 0.4)))
    assert length(one.waypoints) + length(other.waypoints) == approx(1.4, abs=0.12)


def test_all_of_a_wall_is_driven_if_nearly_all_of_it_is_needed():
    plan = room(4.0, 3.0, 0.02)
    everything = reachable(plan)
    little, much = (everything & ~part_of(plan, (1.0, 0.0, 1.0 + gap, 0.4)) for gap in (1.2, 2.4))
    wall, = paths(plan, little)
    assert wall.is_closed and length(wall.waypoints) == approx(length(paths(plan)[0].waypoints))
    wall, = paths(plan, much)
    assert not wall.is_closed and length(wall.waypoints) == approx(length(paths(plan)[0].waypoints) - 2.4, abs=0.1)
    assert not ((abs(wall.waypoints[:, 0] - 2.2) < 1.1) & (wall.waypoints[:, 1] < 0.3)).any()


def test_a_few_specks_beside_a_wall_need_no_path_along_it():
    plan = room(4.0, 3.0, 0.02)
    specks = np.zeros(plan.occupancy.shape, bool)
    specks[13, 30:170:20] = True
    assert reachable(plan)[specks].all() and paths(plan, specks) == []
    assert paths(plan, reachable(plan, (1.0, 0.0, 1.05, 0.4))) == []


# --- regions -------------------------------------------------------------------------------------------------------

@FINE
def test_a_path_through_a_door_is_cut_between_the_regions(resolution):
    plan = two_rooms(resolution)
    floor = ground(plan)
    labels = regions(floor)
    left, right = sorted(paths(plan), key=lambda wall: wall.waypoints[:, 0].min())
    assert left.region == labels[floor.node(1.0, 1.0)] and right.region == labels[floor.node(4.0, 1.0)]
    assert not left.is_closed and not right.is_closed and left.region != right.region
    away = floor.reach + WALL_MARGIN
    assert left.waypoints.min(axis=0) == approx([away, away])
    assert right.waypoints.max(axis=0) == approx([5.0 - away, 2.4 - away])
    assert left.waypoints[:, 0].max() < 3.05 and right.waypoints[:, 0].min() > 2.65
    for wall in (left, right):  # from one side of the door to its other side, without a jump
        assert np.hypot(*np.diff(wall.waypoints, axis=0).T).max() < 0.03
        assert math.hypot(*(wall.waypoints[0] - wall.waypoints[-1])) == approx(0.7 - 2.0 * away, abs=0.1)


def test_an_island_has_the_region_in_which_it_lies():
    plan = room(5.0, 3.0, 0.05, [(2.8, 0.0, 2.9, 0.3), (2.8, 1.0, 2.9, 3.0), (1.2, 1.2, 1.4, 1.4)])
    floor = ground(plan)
    labels = regions(floor)
    island, = [wall for wall in paths(plan) if wall.is_closed]
    assert island.region == labels[floor.node(0.8, 0.8)] == labels[floor.node(1.8, 1.8)]


def test_the_longest_path_comes_first():
    found = paths(crooked(0.02, cliff=(3.6, 2.6, 4.0, 3.0)))
    lengths = [length(wall.waypoints) for wall in found]
    assert lengths == sorted(lengths, reverse=True) and len(found) >= 3


def test_a_path_keeps_off_a_cliff_as_off_a_wall():
    plan = crooked(0.02, cliff=(3.4, 2.4, 4.0, 3.0))
    for wall in paths(plan):
        beyond = np.maximum(np.array([3.4, 2.4]) - wall.waypoints, 0.0)
        assert min(np.hypot(*beyond.T)) >= ground(plan).reach


# --- bands and steps -----------------------------------------------------------------------------------------------

def brute_band(floor, path, width):
    """Distance of the centre of each cell from a path, minus half of the width: float64 (rows, columns) [m]."""
    rows, columns = np.indices(floor.plan.occupancy.shape)
    middles = floor.points(np.stack([rows.ravel() + 0.5, columns.ravel() + 0.5], axis=1))
    away = [off(middles, start, end) for start, end in zip(path[:-1], path[1:])]
    return np.min(away, axis=0).reshape(rows.shape) - 0.5 * width


@pytest.mark.parametrize('width', [0.08, 0.17, 0.3])
@RESOLUTIONS
def test_a_band_along_the_grid_holds_exactly_the_cells_of_a_brute_force_count(resolution, width):
    floor = ground(room(3.0, 2.0, resolution))
    path = np.array([[0.5, 0.6], [2.2, 0.6], [2.2, 1.5]])
    away = brute_band(floor, path, width)
    clear = abs(away) > 1e-9  # for cells exactly on the edge both answers are right
    assert (band(floor, path, width) == (away < 0.0))[clear].all()


POINTS = st.tuples(st.integers(0, 300), st.integers(0, 200)).map(lambda point: (point[0] / 100.0, point[1] / 100.0))


@settings(max_examples=40)
@given(st.sampled_from([0.02, 0.05, 0.1]), st.sampled_from([0.1, 0.17, 0.4]),
       st.lists(POINTS, min_size=2, max_size=4, unique=True))
def test_a_band_is_that_of_a_brute_force_count_except_for_cells_on_its_edge(resolution, width, points):
    floor, path = ground(room(3.0, 2.0, resolution)), np.array(points)
    away, found = brute_band(floor, path, width), band(floor, path, width)
    spacing = length(path) / max(int(length(path) / (0.5 * resolution)), 1)  # of the points that stand for the path
    rounding = 0.25 * math.sqrt(2.0) * resolution  # of these points to half cells
    assert not found[away > rounding + 1e-9].any() and found[away < -rounding - 0.5 * spacing - 1e-9].all()


def test_waypoints_are_spread_evenly_along_a_path_and_keep_its_ends_and_its_length():
    path = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 0.5], [1.6, 1.3]])
    found = resampled(path, 0.02)
    assert (found[0] == path[0]).all() and (found[-1] == path[-1]).all() and len(found) == 126
    assert length(found) == approx(2.5, abs=0.01) and length(found) <= 2.5
    assert np.hypot(*np.diff(found, axis=0).T) == approx(0.02, abs=0.007)
    for start, end in zip(path[:-1], path[1:]):
        assert (off(found, start, end) < 1e-9).any()
    assert max(np.min([off(found, start, end) for start, end in zip(path[:-1], path[1:])], axis=0)) < 1e-9


def test_a_path_that_is_shorter_than_the_spacing_keeps_its_ends():
    assert resampled(np.array([[1.0, 2.0], [1.001, 2.0]]), 0.02).tolist() == [[1.0, 2.0], [1.001, 2.0]]
    assert resampled(np.array([[1.0, 2.0], [1.0, 2.0]]), 0.02).tolist() == [[1.0, 2.0], [1.0, 2.0]]
    assert resampled(np.array([[1.0, 2.0], [1.03, 2.0]]), 0.02).tolist() == [[1.0, 2.0], [1.03, 2.0]]
