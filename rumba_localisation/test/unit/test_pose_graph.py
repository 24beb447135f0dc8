"""Pose graphs whose solutions are known, and key frames that move with them."""

import math

import numpy as np
import pytest

from rumba_localisation.mapping.key_frames import KeyFrames
from rumba_localisation.mapping.pose_graph import Link, optimised
from rumba_localisation.scan import Scan
from rumba_sim.model.common.geometry import Pose, compose, inverse

EQUAL = np.eye(3)
TRUE = [Pose(0.3, -0.2, 0.4), Pose(1.3, 0.1, 1.0), Pose(1.5, 1.2, 2.6), Pose(0.2, 1.0, -2.9)]
NOTHING = Scan(np.empty((0, 2)), np.empty((0, 2)))


def link(one, other, information=EQUAL, off=(0.0, 0.0, 0.0), is_robust=False):
    """A measurement from one of the true poses to another, with an error."""
    measured = np.array(compose(inverse(TRUE[one]), TRUE[other])) + off
    return Link(one, other, tuple(measured.tolist()), information, is_robust)


def along(links, lengths=(0.0, 1.0, 2.0, 3.0)):
    """Optimised poses of a chain on the x axis."""
    return optimised(np.array([[x, 0.0, 0.0] for x in lengths]), links)


def step(one, other, length, weight=1.0, is_robust=False):
    """A measurement along the x axis."""
    return Link(one, other, (length, 0.0, 0.0), weight * EQUAL, is_robust)


def test_poses_that_measurements_without_errors_determine_are_found():
    begun = np.array(TRUE) + np.array([[0.0] * 3, [0.2, -0.1, 0.2], [-0.3, 0.1, -0.3], [0.1, 0.3, 0.3]])
    found = optimised(begun, [link(0, 1), link(1, 2), link(2, 3), link(0, 3), link(3, 1)])
    assert found[:, :2] == pytest.approx(np.array(TRUE)[:, :2], abs=1e-6)
    assert np.cos(found[:, 2] - np.array(TRUE)[:, 2]) == pytest.approx(1.0)


def test_the_first_pose_stays():
    found = optimised(np.array(TRUE), [link(0, 1, off=(0.1, 0.2, 0.1)), link(1, 2), link(2, 3), link(0, 3)])
    assert found[0].tolist() == list(TRUE[0])


def test_the_error_of_a_loop_is_spread_by_how_certain_each_measurement_is():
    """Three steps of 1 m say 3 m, the loop says 3.5 m; the second step is four times less certain than each other."""
    found = along([step(0, 1, 1.0), step(1, 2, 1.0, 0.25), step(2, 3, 1.0), step(0, 3, 3.5)])
    parts = 1.0 + 4.0 + 1.0 + 1.0  # variances
    assert found[:, 0] == pytest.approx([0.0, 1.0 + 0.5 / parts, 2.0 + 2.5 / parts, 3.0 + 3.0 / parts])
    assert found[:, 1:] == pytest.approx(0.0)


def test_a_bend_that_a_heading_makes_is_straightened():
    """Two steps of 1 m that turn by 0.2 rad in all, and a loop that says: they are straight."""
    weak = np.diag([1e6, 1e6, 1.0])
    bent = [Link(0, 1, (1.0, 0.0, 0.2), weak, False), Link(1, 2, (1.0, 0.0, 0.0), weak, False),
            Link(0, 2, (2.0, 0.0, 0.0), 1e6 * EQUAL, False)]
    begun = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.2], [1.0 + math.cos(0.2), math.sin(0.2), 0.2]])
    found = optimised(begun, bent)
    assert found == pytest.approx(np.array([[0.0] * 3, [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]]), abs=1e-3)


def test_a_measurement_that_all_others_contradict_counts_little():
    chain = [step(0, 1, 1.0, 1e4), step(1, 2, 1.0, 1e4), step(2, 3, 1.0, 1e4), step(0, 2, 2.0, 1e4)]
    assert along([*chain, step(0, 3, 4.0, 1e4)])[3, 0] > 3.2
    assert along([*chain, step(0, 3, 4.0, 1e4, is_robust=True)])[3, 0] == pytest.approx(3.0, abs=0.01)


def chain(count, closing=None):
    """Key frames 1 m apart on the x axis, and the last one found elsewhere from the first."""
    frames = KeyFrames()
    for number in range(count):
        pose = Pose(float(number), 0.0, 0.0)
        frames.add(pose, NOTHING)
        if number:
            frames.link(number - 1, number, pose, np.diag([0.01, 0.01, 0.0001]))
    if closing is not None:
        frames.link(0, count - 1, closing, np.diag([1e-6, 1e-6, 1e-6]))
    return frames


def test_ways_are_along_links():
    frames = chain(11)
    assert frames.ways(10).lengths == pytest.approx(np.arange(10.0, -1.0, -1.0), abs=1e-4)
    frames.link(2, 9, Pose(9.0, 0.0, 0.0), EQUAL)
    assert frames.near(3.2, 0.0, 1.5).tolist() == [3, 4, 2]
    around = chain(11)
    around.poses[10] = Pose(0.0, 1.0, 0.0)
    around.link(0, 10, around.poses[10], EQUAL)
    assert around.ways(10).lengths[[0, 3, 8]] == pytest.approx([1.0, 4.0, 9.0], abs=1e-4)


def test_doubt_grows_along_a_way_by_errors_of_places_and_of_headings():
    """Ten links with variances of 0.01 + 0.01 m^2 and 0.0001 rad^2 each, 10 m."""
    frames = chain(11)
    assert frames.doubt(frames.ways(10), 0) == pytest.approx(math.sqrt(0.2 + 0.001 * 100.0 / 3.0), abs=1e-4)
    assert frames.doubt(frames.ways(10), 10) == 0.0


def test_what_was_found_on_a_map_moves_with_the_nearest_frame():
    frames = chain(6, Pose(5.5, 0.0, 0.0))
    frames.optimise()
    assert [pose.x for pose in frames.poses] == pytest.approx([0.0, 1.1, 2.2, 3.3, 4.4, 5.5], abs=1e-3)
    assert frames.moved(Pose(2.3, 0.4, 0.7)) == pytest.approx(Pose(2.5, 0.4, 0.7), abs=1e-3)
    assert frames.moved(Pose(-0.1, 0.1, 0.0)) == pytest.approx(Pose(-0.1, 0.1, 0.0))
