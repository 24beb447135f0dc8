"""The compiled parts of behaviours and the planner do what plain formulas do."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from rumba_cleaning.behaviours.compiled_follower import nearest, piece_of
from rumba_cleaning.behaviours.follower import drive_of
from rumba_cleaning.belief.compiled_ground import are_of_one_part
from rumba_cleaning.belief.search import Costs, Lattice, cheapest, is_clear, path_lengths
from rumba_cleaning.edges.compiled_cliff_map import DRIVEN, SEEN, are_marked, stamp
from rumba_cleaning.edges.compiled_preview import HOLD_STEPS, STEP, path
from rumba_cleaning.planning.swaths.compiled_lanes import NO_ROW, lowest, runs
from rumba_sim.model.settings.robot_config import DriveConfig

NO_SLIP = (0.0, 1.0)
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


def length_of(path):
    return float(np.hypot(*np.diff(path, axis=0).T).sum())


@settings(deadline=None, max_examples=200)
@given(st.integers(0, 2 ** 32 - 1))
def test_the_cheapest_path_is_the_shortest_where_all_nodes_cost_the_same(seed):
    generator = np.random.default_rng(seed)
    is_free = generator.random((14, 11)) < generator.uniform(0.3, 0.8)  # about half of them are cut in two
    is_free[2, 3] = is_free[12, 9] = True
    costs = Costs(np.ones(is_free.shape), is_free, 0.5, 0.1, 2.0)
    found = cheapest(costs, Lattice(0, 0, 14, 11, 1), (2, 3), (12, 9))
    shortest = path_lengths(is_free, 2, 3)[12, 9]
    if len(found) == 0:
        assert np.isinf(shortest)
        return
    assert found[0].tolist() == [2, 3] and found[-1].tolist() == [12, 9] and is_free[tuple(found.T)].all()
    assert np.abs(np.diff(found, axis=0)).max() == 1 and length_of(found) == pytest.approx(shortest)


def test_the_cheapest_path_keeps_off_the_walls_where_that_costs_less():
    clearance = np.minimum(np.arange(9), 6) * np.ones((20, 1)) * 0.05  # one wall, to the left
    costs = Costs(clearance, np.ones(clearance.shape, bool), 0.05, 0.1, 2.0)
    found = cheapest(costs, Lattice(0, 0, 20, 9, 1), (0, 1), (19, 1))
    assert (found[2:-2, 1] == 3).all() and len(found) == 22  # sideways at once: diagonally is dearer
    assert cheapest(costs, Lattice(0, 1, 20, 1, 1), (0, 0), (19, 0))[:, 1].max() == 0  # there is no other column
    odd = cheapest(costs, Lattice(1, 1, 10, 2, 2), (0, 0), (9, 0))  # rows 1, 3, ..., columns 1 and 3
    assert odd[:, 1].max() == 1 and length_of(odd) == pytest.approx(7.0 + 2.0 * math.sqrt(2.0))


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
    floor = np.zeros((6, 8), np.uint8)
    stamp(floor, *ORIGIN, RESOLUTION, (-0.5, 2.25, 0.5 * math.pi), (0.0, 0.0, 0.0), 1,
          np.array([[0.1, 0.15], [9.0, -0.05]]), SEEN)
    assert np.argwhere(floor).tolist() == [[3, 3], [5, 5]]  # the second point is off the floor, above its edge
    points = np.array([[-0.65, 2.35], [-0.55, 2.25], [-0.35, 2.35], [-9.0, 2.35]])
    for cells, found in ((0, [True, False, False, False]), (1, [True, True, False, False]),
                         (2, [True, True, True, False]), (3, [True, True, True, True])):
        assert [are_marked(floor, *ORIGIN, RESOLUTION, points[[index]], cells, SEEN) for index in range(4)] == found
        assert are_marked(floor, *ORIGIN, RESOLUTION, points, cells, SEEN) == all(found)


def test_floor_beside_cells_counts_only_if_their_marks_are_high_enough_and_no_mark_becomes_less():
    floor = np.zeros((6, 8), np.uint8)
    here, beside = np.array([[-0.65, 2.35]]), np.array([[-0.55, 2.35]])
    for mark, found in ((DRIVEN, (True, True, False)), (SEEN, (True, True, True)), (DRIVEN, (True, True, True))):
        stamp(floor, *ORIGIN, RESOLUTION, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), 1, here, mark)
        assert found == tuple(are_marked(floor, *ORIGIN, RESOLUTION, points, 1, least)
                              for points, least in ((here, SEEN), (beside, DRIVEN), (beside, SEEN)))


def test_the_nodes_of_a_window_are_of_one_part_if_those_that_are_free_have_one_number():
    parts = np.array([[0, 2, 2, 0], [0, 2, 0, 1], [0, 0, 0, 1]])
    windows = {(0, 3, 0, 3): True, (0, 3, 0, 4): False, (1, 9, 2, 9): True, (2, 3, 0, 2): True, (0, 2, 1, 4): False}
    for window, answer in windows.items():
        assert are_of_one_part(parts, *window) == answer, window


def test_floor_is_marked_along_the_way_of_a_robot_but_not_where_it_began():
    floor = np.zeros((6, 8), np.uint8)
    stamp(floor, *ORIGIN, RESOLUTION, (ORIGIN[0] + 0.05, ORIGIN[1] + 0.05, 0.0), (0.3, 0.0, 0.0), 3,
          np.array([[0.0, 0.0]]), SEEN)
    assert np.argwhere(floor).tolist() == [[0, 1], [0, 2], [0, 3]]


def piece_over(waypoints):
    return piece_of(waypoints, np.full(len(waypoints) - 1, 0.3), drive_of(DriveConfig()))


@settings(deadline=None, max_examples=100)
@given(st.lists(st.tuples(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0)), min_size=2, max_size=8, unique=True),
       st.floats(-1.5, 1.5), st.floats(-1.5, 1.5))
def test_the_nearest_point_of_a_route_is_nearer_than_all_its_others(corners, x, y):
    waypoints = np.array(corners)
    assume(np.hypot(*np.diff(waypoints, axis=0).T).min() > 1e-3)
    piece = piece_over(waypoints)
    lengths = piece.lengths
    distance, off = nearest(piece, x, y, 0.0, 100.0)
    along = np.append(np.linspace(0.0, lengths[-1], 2000), distance)
    offs = np.hypot(np.interp(along, lengths, waypoints[:, 0]) - x, np.interp(along, lengths, waypoints[:, 1]) - y)
    assert off == pytest.approx(offs[-1], abs=1e-9) and off <= offs.min() + 1e-8


def test_only_a_part_of_a_route_is_looked_at():
    piece = piece_over(np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]))
    assert nearest(piece, 0.1, 0.9, 0.0, 0.5) == pytest.approx((0.1, 0.9))
    assert nearest(piece, 0.1, 0.2, 1.5, 0.5) == pytest.approx((2.9, 0.8))


def test_a_command_leads_as_far_as_the_wheels_take_to_change_their_speed_and_to_stop():
    middle, left, right = path((1.0, 2.0, 0.5 * math.pi), (0.2, 0.2), (0.2, 0.2), NO_SLIP, 0.1, 1.0, HOLD_STEPS)
    held, braked = 0.1 * 0.2, 0.5 * 0.2 ** 2 / 1.0
    assert middle[-1] == pytest.approx([1.0, 2.0 + held + braked], abs=0.2 * STEP)
    assert (left - middle)[-1] == pytest.approx([-0.1, 0.0]) and (right - middle)[-1] == pytest.approx([0.1, 0.0])
    middle, left, _ = path((0.0, 0.0, 0.0), (0.0, 0.0), (-0.1, 0.1), NO_SLIP, 0.1, 1.0, HOLD_STEPS)
    assert np.abs(middle).max() < 1e-12
    assert np.hypot(*left.T) == pytest.approx(np.full(len(left), 0.1))
    assert left[-1][0] == pytest.approx(-0.1 * math.sin(0.1), abs=0.002)  # 0.1 s to full speed, and as long to stop


def test_a_robot_that_slides_moves_aside_and_makes_less_way():
    middle, _, _ = path((0.0, 0.0, 0.0), (0.3, 0.3), (0.3, 0.3), (0.1, 0.5), 0.1, 1.0, HOLD_STEPS)
    straight, _, _ = path((0.0, 0.0, 0.0), (0.3, 0.3), (0.3, 0.3), NO_SLIP, 0.1, 1.0, HOLD_STEPS)
    assert middle[:, 0] == pytest.approx(0.5 * straight[:, 0])
    assert middle[-1, 1] == pytest.approx(straight[-1, 0] / 3.0)
