"""A robot that does not come back as its wheels drive notices that something is behind it."""

import math

import pytest
from rooms import RADIUS

from rumba_cleaning.behaviour import Observation
from rumba_cleaning.control import CONTROL_DT
from rumba_cleaning.edges.rear import LEAST, MOST, Rear
from rumba_sim.model.common.geometry import Pose


@pytest.fixture
def seen():
    """What a robot sees that begins to back off, far from edges."""
    return Observation(CONTROL_DT, Pose(1.5, 1.0, 0.0))


def backed(rear, observation, steps, slant, free=True):
    """The last observation of a robot that is to back off by 1 cm in each step, at a slant [rad] to a wall behind it.

    If the way is not free, it slides along that wall, which is parallel to the y axis.
    """
    pose = Pose(1.5, 1.0, slant)
    for _ in range(steps):
        last = pose
        pose = Pose(last.x - (0.01 * math.cos(slant) if free else 0.0), last.y - 0.01 * math.sin(slant), slant)
        rear.watch(last, observation._replace(pose=pose), -0.01)
    return observation._replace(pose=pose)


def test_that_a_robot_could_not_back_off_says_nothing_of_another_direction(seen):
    rear = Rear(RADIUS)
    before = seen._replace(cliffs=(True, False, False, False))
    for _ in range(round(MOST / 0.01) + 1):
        rear.watch(before.pose, before._replace(pose=before.pose._replace(x=before.pose.x - 0.01)), -0.01)
    assert rear.is_closed(before)
    rear.watch(before.pose, before._replace(pose=Pose(1.5, 1.0, 0.5)), 0.0)
    assert rear.is_closed(before)
    rear.watch(before.pose, before._replace(pose=Pose(1.5, 1.0, 1.2)), 0.0)
    assert not rear.is_closed(before)


@pytest.mark.parametrize('slant', [0.0, 0.35, 1.05])
def test_a_robot_that_slides_along_a_wall_as_it_backs_off_must_not_go_back(seen, slant):
    rear = Rear(RADIUS)
    assert not rear.is_closed(backed(rear, seen, round(LEAST / 0.01) - 1, slant, free=False))
    assert rear.is_closed(backed(rear, seen, 3, slant, free=False))


@pytest.mark.parametrize('slant', [0.0, 0.35, 1.05])
def test_a_robot_that_backs_off_freely_may_go_on(seen, slant):
    rear = Rear(RADIUS)
    assert not rear.is_closed(backed(rear, seen, 20, slant))


@pytest.mark.parametrize('theta, driven', [(1.5, 0.0), (0.35, LEAST + 0.01)])
def test_once_it_has_turned_or_driven_ahead_it_may_go_back_again(seen, theta, driven):
    rear = Rear(RADIUS)
    last = backed(rear, seen, 6, 0.35, free=False)
    rear.watch(last.pose, last, 0.5 * LEAST)
    assert rear.is_closed(last)
    rear.watch(last.pose, last._replace(pose=last.pose._replace(theta=theta)), driven)
    assert not rear.is_closed(last)
