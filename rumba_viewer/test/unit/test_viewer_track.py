"""What the window remembers of a robot's motion."""

import itertools
import math
import threading

import numpy as np
import pytest
from hammering import hammer
from pytest import approx

from rumba_sim.model.common.geometry import Pose
from rumba_viewer.scene import track
from rumba_viewer.scene.track import Glide, Trail


def driven(*points):
    """The trail of a robot that was at these points, with any heading."""
    trail = Trail()
    for x, y in points:
        trail.add(Pose(x, y, 1.0))
    return trail


def test_a_trail_leaves_out_points_that_are_close_to_the_last():
    path = driven((1.0, 2.0), (1.01, 2.0), (1.3, 2.1), (1.3, 2.1), (1.5, 2.0)).path
    assert path.points.tolist() == [[1.0, 2.0], [1.3, 2.1], [1.5, 2.0]]


def test_a_jump_interrupts_the_path():
    points = driven((0.0, 0.0), (0.3, 0.0), (2.0, 1.0)).path.points
    assert points[[0, 1, 3]].tolist() == [[0.0, 0.0], [0.3, 0.0], [2.0, 1.0]]
    assert np.isnan(points[2]).all()


def test_points_that_are_added_later_change_neither_an_earlier_path_nor_the_number():
    trail = driven((0.0, 0.0), (0.1, 0.0))
    early = trail.path
    for step in range(2, 3000):
        trail.add(Pose(0.1 * step, 0.0, 0.0))
    assert early.points.tolist() == [[0.0, 0.0], [0.1, 0.0]]
    assert trail.path.points[:, 0] == approx(0.1 * np.arange(3000))
    assert trail.path.number == early.number


def test_a_trail_that_was_cleared_starts_again_with_another_number():
    trail = driven((0.0, 0.0), (0.1, 0.0))
    before = trail.path
    trail.clear()
    trail.add(Pose(5.0, 5.0, 0.0))
    assert trail.path.points.tolist() == [[5.0, 5.0]]
    assert before.points.tolist() == [[0.0, 0.0], [0.1, 0.0]]
    assert trail.path.number != before.number != Trail().path.number


def test_a_very_long_trail_keeps_its_newer_half_its_gaps_and_its_start(monkeypatch):
    monkeypatch.setattr(track, 'MAX_POINTS', 100)
    trail = driven((0.0, 0.0), *((0.1 * step, 1.0) for step in range(1000)))
    points = trail.path.points
    assert len(points) <= 100
    assert points[0].tolist() == [0.0, 0.0]
    assert np.isnan(points).any()
    assert points[-50:, 0] == approx(0.1 * np.arange(950, 1000))


def test_a_robot_glides_from_reading_to_reading_and_turns_the_short_way():
    glide = Glide()
    assert glide.at(10.0) is None
    glide.add(Pose(0.0, 0.0, math.pi - 0.1), 10.0)
    glide.add(Pose(0.04, -0.02, 0.3 - math.pi), 10.1)
    assert glide.is_under_way(10.15)
    assert glide.at(10.15) == approx((0.02, -0.01, 0.1 - math.pi))
    assert glide.at(10.2) == glide.at(99.0) == Pose(0.04, -0.02, 0.3 - math.pi)
    assert not glide.is_under_way(10.2)


def test_it_glides_on_from_where_it_was_shown_when_a_reading_comes_early():
    glide = Glide()
    glide.add(Pose(0.0, 0.0, 0.0), 0.0)
    glide.add(Pose(0.1, 0.0, 0.0), 0.1)
    glide.add(Pose(0.2, 0.0, 0.0), 0.15)
    assert glide.at(0.15) == approx((0.05, 0.0, 0.0))
    assert glide.at(0.2) == approx((0.2, 0.0, 0.0))


@pytest.mark.parametrize('x, now', [(2.0, 0.1), (0.1, 3.0)])
def test_it_jumps_if_it_was_put_elsewhere_or_was_silent_for_long(x, now):
    glide = Glide()
    glide.add(Pose(0.0, 0.0, 0.0), 0.0)
    glide.add(Pose(x, 0.0, 0.0), now)
    assert glide.at(now) == (x, 0.0, 0.0)
    assert not glide.is_under_way(now)


def test_a_robot_is_shown_where_it_was_if_asked_for_a_moment_before_the_last_reading():
    glide = Glide()
    glide.add(Pose(0.0, 0.0, 0.0), 1.0)
    glide.add(Pose(0.1, 0.0, 0.0), 1.1)
    assert glide.at(1.05) == (0.0, 0.0, 0.0)
    glide.add(Pose(0.2, 0.0, 0.0), 1.1)  # two at the same time
    assert glide.at(1.05) == glide.at(1.1) == (0.2, 0.0, 0.0)


# --- several threads at once -----------------------------------------------------------------------------------------

def test_a_trail_can_be_extended_cleared_and_read_by_several_threads_at_once():
    trail = Trail()

    def extend():
        for step in range(40_000):
            trail.add(Pose(0.1 * step, 0.1 * step, 0.0))

    def read():
        points = trail.path.points
        assert (points[:, 0] == points[:, 1]).all() and np.diff(points[:, 0]) == approx(0.1)
    hammer(extend, trail.clear, read)


def test_a_pose_that_comes_while_the_trail_is_cleared_is_added_after_that(monkeypatch):
    trail = driven((0.0, 0.0), (0.1, 0.0))
    adding = threading.Thread(target=trail.add, args=[Pose(0.5, 0.7, 0.0)])

    def numbers():  # the trail takes one while it is cleared
        adding.start()
        adding.join(0.1)
        yield 99
    monkeypatch.setattr(trail, '_numbers', numbers())
    trail.clear()
    adding.join()
    assert trail.path.points.tolist() == [[0.5, 0.7]]


def test_a_glide_can_be_asked_while_readings_come():
    glide, clock = Glide(), itertools.count()
    now = [0.0]

    def add():
        for step in range(10_000):
            now[0] = 0.1 * next(clock)
            glide.add(Pose(0.1 * (step % 2), 0.0, 0.0), now[0])

    def ask():
        for ago in (-0.05, 0.0, 0.15):
            shown = glide.at(now[0] - ago)
            assert shown is None or -1e-9 <= shown.x <= 0.1 + 1e-9
    hammer(add, ask, ask)
