"""What the window remembers of a robot's way."""

import math

import numpy as np
import pytest
from pytest import approx

from rumba_sim.model.geometry import Pose
from rumba_viewer.scene import track
from rumba_viewer.scene.track import Glide, Trail


def driven(*places):
    """The trail of a robot that was at these places, heading anywhere."""
    trail = Trail()
    for x, y in places:
        trail.add(Pose(x, y, 1.0))
    return trail


def test_a_trail_has_the_points_but_for_those_that_are_next_to_the_last():
    path = driven((1.0, 2.0), (1.01, 2.0), (1.3, 2.1), (1.3, 2.1), (1.5, 2.0)).path
    assert path.points.tolist() == [[1.0, 2.0], [1.3, 2.1], [1.5, 2.0]]


def test_a_leap_lifts_the_pen():
    points = driven((0.0, 0.0), (0.3, 0.0), (2.0, 1.0)).path.points
    assert points[[0, 1, 3]].tolist() == [[0.0, 0.0], [0.3, 0.0], [2.0, 1.0]]
    assert np.isnan(points[2]).all()


def test_what_is_added_later_does_not_change_a_path_that_was_given_out_and_has_its_number():
    trail = driven((0.0, 0.0), (0.1, 0.0))
    early = trail.path
    for step in range(2, 3000):
        trail.add(Pose(0.1 * step, 0.0, 0.0))
    assert early.points.tolist() == [[0.0, 0.0], [0.1, 0.0]]
    assert trail.path.points[:, 0] == approx(0.1 * np.arange(3000))
    assert trail.path.number == early.number


def test_a_trail_that_was_cleared_begins_anew_with_another_number():
    trail = driven((0.0, 0.0), (0.1, 0.0))
    before = trail.path
    trail.clear()
    trail.add(Pose(5.0, 5.0, 0.0))
    assert trail.path.points.tolist() == [[5.0, 5.0]]
    assert before.points.tolist() == [[0.0, 0.0], [0.1, 0.0]]
    assert trail.path.number != before.number != Trail().path.number


def test_a_very_long_trail_keeps_its_newer_half_its_gaps_and_its_beginning(monkeypatch):
    monkeypatch.setattr(track, 'MOST_POINTS', 100)
    trail = driven((0.0, 0.0), *((0.1 * step, 1.0) for step in range(1000)))
    points = trail.path.points
    assert len(points) <= 100
    assert points[0].tolist() == [0.0, 0.0]
    assert np.isnan(points).any()
    assert points[-50:, 0] == approx(0.1 * np.arange(950, 1000))


def test_a_robot_glides_from_reading_to_reading_the_short_way_round():
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
def test_it_leaps_where_it_was_put_elsewhere_or_was_long_silent(x, now):
    glide = Glide()
    glide.add(Pose(0.0, 0.0, 0.0), 0.0)
    glide.add(Pose(x, 0.0, 0.0), now)
    assert glide.at(now) == (x, 0.0, 0.0)
    assert not glide.is_under_way(now)
