"""A robot goes back by the way that it came, without the loops in it."""

import math

import numpy as np
import pytest

from rumba_cleaning.edges.trail import LENGTH, OFF, Trail
from rumba_sim.model.common.geometry import Pose

HALF = 0.12  # [m]
STEP = 0.01  # [m] back at a time


def noted(poses):
    """The trail of a robot that was at poses."""
    trail = Trail(HALF)
    for pose in poses:
        trail.note(pose)
    return trail


def bend(radius=0.3, angle=1.2, count=40):
    """Poses on a bend to the left that begins at the origin, along the x axis."""
    return [Pose(radius * math.sin(turned), radius * (1.0 - math.cos(turned)), turned)
            for turned in np.linspace(0.0, angle, count)]


def returned(trail, pose):
    """Where a robot comes that drives as it is told, until the trail ends."""
    found = [pose]
    for _ in range(1000):
        motion = trail.back(pose)
        if motion is None:
            return found
        ahead, turn = motion
        share = min(STEP / (abs(ahead) + HALF * abs(turn)), 1.0)
        along = pose.theta + 0.5 * share * turn
        pose = Pose(pose.x + share * ahead * math.cos(along), pose.y + share * ahead * math.sin(along),
                    pose.theta + share * turn)
        found.append(pose)
    raise AssertionError('it does not come to an end')


def test_it_goes_back_along_a_bend_and_not_straight_back():
    poses = bend()
    found = returned(noted(poses), poses[-1])
    middle = Pose(0.0, 0.3, 0.0)
    assert all(math.dist(pose[:2], middle[:2]) == pytest.approx(0.3, abs=0.005) for pose in found)
    assert found[-1] == pytest.approx(poses[0], abs=0.02)


def test_beside_its_trail_it_comes_back_onto_it():
    start = Pose(0.5, 0.01, 0.0)
    found = returned(noted([Pose(x, 0.0, 0.0) for x in np.arange(0.0, 0.51, 0.02)]), start)
    assert [abs(pose.y) < 0.002 for pose in found[-10:]] == [True] * 10
    assert min(pose.y for pose in found) > -0.005 and found[-1].x < 0.03


def test_it_turns_back_where_it_turned_on_the_spot():
    turns = [Pose(0.3, 0.0, theta) for theta in np.arange(0.0, -0.8, -0.1)]
    found = returned(noted([Pose(x, 0.0, 0.0) for x in np.arange(0.0, 0.3, 0.02)] + turns), turns[-1])
    assert all(abs(pose.theta) < 0.1 for pose in found if pose.x < 0.27)
    assert min(pose.x for pose in found) < 0.03


def test_what_it_drove_until_it_was_back_at_a_place_is_left_out():
    way = [Pose(x, 0.0, 0.0) for x in np.arange(0.0, 0.5, 0.02)]
    aside = [Pose(way[-1].x, 0.0, theta) for theta in np.arange(0.0, 1.0, 0.1)]
    found = returned(noted(way + aside + aside[::-1]), way[-1])
    assert max(abs(pose.theta) for pose in found) < 0.01 and found[-1].x < 0.03


def test_a_robot_that_is_not_on_its_trail_any_more_has_none():
    trail = noted(bend())
    end = bend()[-1]
    assert trail.back(end) is not None
    assert trail.back(end._replace(x=end.x + OFF + 0.01)) is None and trail.back(end) is None


def test_a_robot_that_was_put_elsewhere_has_no_trail_from_there():
    trail = noted([*bend(), Pose(5.0, 5.0, 0.0)])
    assert trail.back(Pose(5.0, 5.0, 0.0)) is None


def test_the_newest_poses_are_remembered():
    way = [Pose(x, 0.0, 0.0) for x in np.arange(0.0, 10.0, 0.012)]
    found = returned(noted(way), way[-1])
    assert 0.012 * LENGTH - 0.05 < way[-1].x - found[-1].x < 2 * 0.012 * LENGTH
