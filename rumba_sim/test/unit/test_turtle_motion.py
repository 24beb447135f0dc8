"""What turtlesim's poses tell: what was driven, what got lost, and where the turtle was put elsewhere."""

import math

import numpy as np
import pytest

from rumba_sim.model.geometry import Pose, wrap_angle
from rumba_sim.model.turtle_motion import FRAME, MOST_LOST, TurtleMotion


def rounded(pose):
    """A pose as it comes in a message: float32."""
    return Pose(*(float(np.float32(number)) for number in pose))


def frames(pose, v, w, count):
    """So many frames of a turtle from a pose: it turns, then goes along its new heading."""
    for _ in range(count):
        theta = wrap_angle(pose.theta + w * FRAME)
        pose = Pose(pose.x + v * FRAME * math.cos(theta), pose.y + v * FRAME * math.sin(theta), theta)
        yield pose


def begun(pose, v=0.0, w=0.0):
    """A motion that has seen a pose."""
    motion = TurtleMotion()
    motion.driven(rounded(pose), abs(v), w)
    return motion


BEGIN = Pose(3.0, 7.0, 3.0)


def test_the_first_pose_is_no_drive():
    assert TurtleMotion().driven(BEGIN, 0.3, 0.1) == []


@pytest.mark.parametrize('v, w', [(0.3, 0.0), (-0.3, 0.7), (0.0, -1.9), (0.5, 1.9), (0.0, 0.0), (1e-5, 0.0)])
def test_frame_after_frame_is_driven_around_the_circle_too(v, w):
    motion = begun(BEGIN, v, w)
    for pose in frames(BEGIN, v, w, 200):
        assert motion.driven(rounded(pose), abs(v), w) == [rounded(pose)]


@pytest.mark.parametrize('lost', [1, 2, 7, MOST_LOST])
def test_poses_that_got_lost_are_filled_in(lost):
    v, w = 0.3, 0.5
    way = list(frames(BEGIN, v, w, lost + 1))
    found = begun(BEGIN, v, w).driven(rounded(way[-1]), v, w)
    assert len(found) == lost + 1
    for pose, wanted in zip(found, way):
        assert pose[:2] == pytest.approx(wanted[:2], abs=0.01)
        assert wrap_angle(pose.theta - wanted.theta) == pytest.approx(0.0, abs=1e-3)


def test_lost_poses_while_it_slows_down_are_measured_by_its_higher_speed():
    way = list(frames(BEGIN, 0.3, 0.0, 3))
    assert len(begun(BEGIN, 0.3).driven(rounded(way[-1]), 0.1, 0.0)) == 3


def test_at_the_edge_it_comes_less_far_than_it_went():
    before, after = Pose(11.08, 5.0, 0.0), Pose(11.0888, 5.0, 0.0)
    assert begun(before, 2.0).driven(after, 2.0, 0.0) == [after]


@pytest.mark.parametrize('pose', [Pose(3.001, 7.0, 3.0), Pose(3.0, 6.9, 3.0), Pose(3.0, 7.0, 3.01),
                                  Pose(8.0, 1.0, 3.0), Pose(3.0, 7.0, -3.0)])
def test_one_that_stood_was_put_where_it_now_stands(pose):
    motion = begun(BEGIN)
    assert motion.driven(rounded(pose), 0.0, 0.0) == []
    assert motion.driven(rounded(pose), 0.0, 0.0) == [rounded(pose)]


@pytest.mark.parametrize('pose', [Pose(3.0, 7.5, 3.0), Pose(2.9952, 7.0, 2.5)])
def test_one_that_drove_was_put_where_it_cannot_have_driven(pose):
    assert begun(BEGIN, 0.3).driven(rounded(pose), 0.3, 0.0) == []
