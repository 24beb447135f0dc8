"""The compiled parts of the planner do what plain formulas do."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rumba_cleaning.belief.compiled_footing import are_marked, stamp
from rumba_cleaning.belief.search import is_clear
from rumba_cleaning.planning.compiled_lanes import NO_ROW, lowest, runs
from rumba_cleaning.planning.compiled_ways import cornered_length

ORIGIN, RESOLUTION = (-1.0, 2.0), 0.1


@settings(deadline=None, max_examples=300)
@given(st.lists(st.booleans(), max_size=30), st.integers(0, 4))
def test_runs_hold_all_that_is_set_and_are_farther_apart_than_the_gap(flags, gap):
    found = runs(np.array(flags, np.bool_), gap).tolist()
    inside = {index for first, after in found for index in range(first, after)}
    assert {index for index, flag in enumerate(flags) if flag} <= inside
    assert all(flags[first] and flags[after - 1] for first, after in found)
    assert all(following[0] - run[1] > gap for run, following in zip(found, found[1:]))
    for first, after in found:
        holes = ''.join('x' if flag else ' ' for flag in flags[first:after]).split('x')
        assert max(map(len, holes)) <= gap


def test_the_lowest_row_is_that_with_a_long_run_and_short_ones_of_the_whole_width_are_forgotten():
    remaining = np.zeros((5, 10), np.bool_)
    remaining[1, 2:4] = remaining[3, 1:3] = remaining[3, 5:9] = True
    assert lowest(remaining, 0, 5, 0, 9, 0, 3) == (3, 5, 9)
    assert remaining[1].any()  # not the whole width
    assert lowest(remaining, 0, 5, 0, 10, 0, 3) == (3, 5, 9)
    assert not remaining[1].any()
    assert lowest(remaining, 0, 5, 0, 10, 2, 3) == (3, 1, 9)  # both are one
    assert lowest(remaining, 4, 5, 0, 10, 0, 3)[0] == NO_ROW


@pytest.mark.parametrize('path, length', [
    ([(0.0, 0.0)], 0.0), ([(0.0, 0.0), (3.0, 4.0)], 5.0), ([(0.0, 0.0), (1.0, 0.0), (1.0, 0.0), (1.0, 2.0)], 3.0),
    ([(0.0, 0.0), (-1.0, 1e-3), (-2.0, 0.0)], 2.0)])
def test_each_corner_of_a_path_counts_by_its_angle_the_short_way_round(path, length):
    turns = {1: 0.0, 2: 0.0, 3: 2e-3, 4: math.pi / 2.0}[len(path)]
    assert cornered_length(np.array(path), 0.1) == pytest.approx(length + 0.1 * turns, abs=1e-6)


@settings(deadline=None, max_examples=200)
@given(st.lists(st.floats(-2.0, 2.0), min_size=4, max_size=4), st.integers(0, 2 ** 32 - 1))
def test_a_line_is_clear_if_all_nodes_along_it_are(ends, seed):
    clearance = np.random.default_rng(seed).random((12, 15))
    start, end = np.array(ends[:2]) + ORIGIN, np.array(ends[2:]) + ORIGIN
    count = int(np.hypot(*(end - start)) / (0.5 * RESOLUTION)) + 2
    share = np.linspace(0.0, 1.0, count)[:, np.newaxis]
    nodes = np.rint((start * (1.0 - share) + end * share - ORIGIN) / RESOLUTION).astype(int)[:, ::-1]
    nodes = np.clip(nodes, 0, np.array(clearance.shape) - 1)
    least = float(clearance[nodes[:, 0], nodes[:, 1]].min())
    for needed in (least, least + 1e-9):
        assert is_clear(clearance, ORIGIN, RESOLUTION, tuple(start), tuple(end), needed) == (needed == least)


def test_floor_is_marked_where_a_robot_has_its_points_and_found_beside_them():
    floor = np.zeros((6, 8), np.bool_)
    stamp(floor, *ORIGIN, RESOLUTION, np.array([[-0.5, 2.25, 0.5 * math.pi]]), np.array([[0.1, 0.15], [9.0, -0.05]]))
    assert np.argwhere(floor).tolist() == [[3, 3], [5, 5]]  # the second point is off the floor, above its edge
    points = np.array([[-0.65, 2.35], [-0.55, 2.25], [-0.35, 2.35], [-9.0, 2.35]])
    for cells, found in ((0, [True, False, False, False]), (1, [True, True, False, False]),
                         (2, [True, True, True, False]), (3, [True, True, True, True])):
        assert are_marked(floor, *ORIGIN, RESOLUTION, points, cells).tolist() == found
