"""Movements between poses of turtlesim: driven ones, lost poses, and turtles that are put elsewhere."""

import math

import numpy as np
import pytest

from rumba_sim.model.common.geometry import Pose, wrap_angle
from rumba_sim.model.simulation.turtle_motion import FASTEST, FRAME, MOST_LOST, TurtleMotion


def rounded(pose):
    """A pose with the precision of a message: float32."""
    return Pose(*(float(np.float32(number)) for number in pose))


def frames(pose, v, w, count):
    """The next poses of a turtle: in each frame it turns, then moves along its new heading."""
    for _ in range(count):
        theta = wrap_angle(pose.theta + w * FRAME)
        pose = Pose(pose.x + v * FRAME * math.cos(theta), pose.y + v * FRAME * math.sin(theta), theta)
        yield pose


def begun(pose, v=0.0, w=0.0):
    """A motion after its first pose."""
    motion = TurtleMotion()
    motion.driven(rounded(pose), abs(v), w)
    return motion


BEGIN = Pose(3.0, 7.0, 3.0)


def test_the_first_pose_is_not_driven_to():
    assert TurtleMotion().driven(BEGIN, 0.3, 0.1) == []


@pytest.mark.parametrize('v, w', [(0.3, 0.0), (-0.3, 0.7), (0.0, -1.9), (0.5, 1.9), (0.0, 0.0), (1e-5, 0.0)])
def test_each_frame_is_driven_even_if_the_heading_wraps(v, w):
    motion = begun(BEGIN, v, w)
    for pose in frames(BEGIN, v, w, 200):
        assert motion.driven(rounded(pose), abs(v), w) == [rounded(pose)]


@pytest.mark.parametrize('lost', [1, 2, 7, MOST_LOST])
def test_poses_that_got_lost_are_filled_in(lost):
    v, w = 0.3, 0.5
    path = list(frames(BEGIN, v, w, lost + 1))
    found = begun(BEGIN, v, w).driven(rounded(path[-1]), v, w)
    assert len(found) == lost + 1
    for pose, wanted in zip(found, path):
        assert pose[:2] == pytest.approx(wanted[:2], abs=0.01)
        assert wrap_angle(pose.theta - wanted.theta) == pytest.approx(0.0, abs=1e-3)


def test_poses_lost_while_the_turtle_slows_down_are_counted_by_the_higher_speed():
    path = list(frames(BEGIN, 0.3, 0.0, 3))
    assert len(begun(BEGIN, 0.3).driven(rounded(path[-1]), 0.1, 0.0)) == 3


def test_at_the_edge_of_the_field_a_turtle_moves_less_than_its_speed():
    before, after = Pose(11.08, 5.0, 0.0), Pose(11.0888, 5.0, 0.0)
    assert begun(before, 2.0).driven(after, 2.0, 0.0) == [after]


@pytest.mark.parametrize('pose', [Pose(3.001, 7.0, 3.0), Pose(3.0, 6.9, 3.0), Pose(3.0, 7.0, 3.01),
                                  Pose(8.0, 1.0, 3.0), Pose(3.0, 7.0, -3.0)])
def test_a_turtle_that_stood_still_was_put_at_its_new_pose(pose):
    motion = begun(BEGIN)
    assert motion.driven(rounded(pose), 0.0, 0.0) == []
    assert motion.driven(rounded(pose), 0.0, 0.0) == [rounded(pose)]


@pytest.mark.parametrize('pose', [Pose(3.0, 7.5, 3.0), Pose(2.9952, 7.0, 2.5)])
def test_a_turtle_that_drove_was_put_at_a_pose_that_it_could_not_reach(pose):
    assert begun(BEGIN, 0.3).driven(rounded(pose), 0.3, 0.0) == []


@pytest.mark.parametrize('speed, turn_rate', [(3e38, 0.0), (-1e9, 3e38), (1e4, -1e9)])
@pytest.mark.parametrize('pose', [Pose(4.0, 7.0, 3.0), Pose(-1e9, 3e38, 3.0)])
def test_a_turtle_was_put_where_none_could_drive_whatever_speed_it_tells(speed, turn_rate, pose):
    assert begun(BEGIN, speed, turn_rate).driven(rounded(pose), speed, turn_rate) == []


def test_a_turtle_that_is_faster_than_any_drives_for_longer():
    path = begun(BEGIN, 3.0 * FASTEST).driven(Pose(BEGIN.x - 3.0 * FASTEST * FRAME, BEGIN.y, BEGIN.theta), 6.0, 0.0)
    assert [BEGIN.x - pose.x for pose in path] == pytest.approx([FASTEST * FRAME * frame for frame in (1, 2, 3)])
