"""Driving on paper, and what is done to paths before that."""

import math

import numpy as np
from floors import BRUSH, knowing, length, off
from hypothesis import given
from hypothesis import strategies as st
from pytest import approx
from rooms import room

from rumba_cleaning.planning.common.polyline import resampled, simplified, strides
from rumba_cleaning.planning.simulate.paper import drive
from rumba_sim.model.common.geometry import Pose

PATHS = st.lists(st.tuples(st.floats(0.0, 3.0), st.floats(0.0, 3.0)), min_size=2, max_size=12).map(
    lambda points: np.array(points))
CIRCLE = np.array([[2.0 + math.cos(angle), 1.5 + math.sin(angle)] for angle in np.linspace(0.0, 2.0 * math.pi, 200)])


def swept_area(path):
    """Area that is swept by driving a path in an empty room [m^2]."""
    context = knowing(room(4.0, 3.0, 0.02), Pose(0.5, 0.5, 0.0))
    drive(context.swept, np.array(path, float))
    return context.swept.coverage * context.swept.reachable_area


def test_a_drive_on_paper_sweeps_a_lane_as_wide_as_the_brush():
    assert swept_area([[0.5, 1.5], [3.5, 1.5]]) == approx(3.0 * BRUSH, rel=0.01)
    assert swept_area([[0.5, 0.7], [3.5, 2.3]]) == approx(math.hypot(3.0, 1.6) * BRUSH, rel=0.01)


def test_a_drive_on_paper_turns_on_the_spot_at_corners():
    quarter = math.pi * (0.5 * BRUSH) ** 2 / 4.0
    expected = 2.0 * BRUSH - (0.5 * BRUSH) ** 2 + quarter
    assert swept_area([[1.0, 1.0], [2.0, 1.0], [2.0, 2.0]]) == approx(expected, abs=0.002)


def test_a_closed_path_is_swept_all_round():
    assert swept_area(np.concatenate([CIRCLE * 0.8, CIRCLE[:1] * 0.8])) == approx(2.0 * math.pi * 0.8 * BRUSH, rel=0.02)


def test_a_path_of_one_waypoint_sweeps_nothing():
    assert swept_area([[1.0, 1.0]]) == 0.0


@given(PATHS, st.floats(0.01, 1.0))
def test_strides_are_no_longer_than_asked_for_and_keep_the_path(path, longest):
    dense = strides(path, longest)
    assert max(np.hypot(*np.diff(dense, axis=0).T)) <= longest + 1e-9
    assert length(dense) == approx(length(path)) and dense[[0, -1]] == approx(path[[0, -1]])


@given(PATHS, st.floats(0.01, 0.5))
def test_what_is_left_of_a_simplified_path_is_near_all_of_it(path, away):
    simple = simplified(path, away)
    assert (simple[[0, -1]] == path[[0, -1]]).all()
    for point in path:
        assert min(float(off(point[np.newaxis], *ends)[0]) for ends in zip(simple[:-1], simple[1:])) <= away + 1e-9


def test_a_closed_path_is_simplified_to_corners():
    square = resampled(np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]]), 0.1)
    assert len(simplified(square, 0.005)) == 5


def test_a_resampled_path_has_waypoints_all_the_way():
    path = resampled(np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 2.0]]), 0.1)
    assert np.hypot(*np.diff(path, axis=0).T) == approx(0.1, abs=0.03) and len(path) == 31
