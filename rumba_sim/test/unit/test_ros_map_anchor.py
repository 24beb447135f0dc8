"""Where the map of a robot is in the world: its first pose is compared with the true one of that moment."""

import math
import time

import pytest
import rospy
from geometry_msgs.msg import PoseWithCovarianceStamped
from pytest import approx

from rumba_sim.model.common.geometry import Pose, compose
from rumba_sim.ros.common.conversions import quaternion
from rumba_sim.ros.participants.requests import Requests
from rumba_sim.ros.robot import localisation, map_anchor

FRAME = Pose(4.0, -3.0, 2.0)  # of the map, in the world


class Subscriber:
    """A fake subscriber of rospy."""

    def __init__(self, topic, _, callback):
        assert topic == 'rumba/amcl_pose'
        Subscriber.hear = staticmethod(callback)


class Anchored:
    """An anchor, and what it found."""

    def __init__(self):
        self.found, self._requests = [], Requests()
        self.anchor = map_anchor.MapAnchor('rumba', self._requests, self.found.append)

    def hear(self, pose, second, number):
        """The mapper tells a pose in a frame, as its message of a number."""
        message = PoseWithCovarianceStamped()
        message.header.seq, message.header.stamp = number, rospy.Time(second)
        message.pose.pose.position.x, message.pose.pose.position.y = pose.x, pose.y
        message.pose.pose.orientation = quaternion(pose.theta)
        Subscriber.hear(message)
        self._requests.serve(time.monotonic())


@pytest.fixture
def anchored(monkeypatch):
    """An anchor that knows where the robot was in two seconds."""
    monkeypatch.setattr(rospy, 'Subscriber', Subscriber)
    anchored = Anchored()
    for second, pose in ((1, Pose(1.0, 0.5, 0.3)), (2, Pose(2.0, -0.5, -0.4))):
        anchored.anchor.note(rospy.Time(second), compose(FRAME, pose))
    return anchored


@pytest.mark.parametrize('second, believed', [(1, Pose(1.0, 0.5, 0.3)), (2, Pose(2.0, -0.5, -0.4))])
def test_the_pose_is_compared_with_the_true_one_of_its_moment(anchored, second, believed):
    anchored.hear(believed, second, 1)
    assert anchored.found == [approx(FRAME)]


def test_later_poses_are_not_compared_since_they_err_until_another_mapper_begins(anchored):
    anchored.hear(Pose(1.0, 0.5, 0.3), 1, 1)
    anchored.hear(Pose(2.1, -0.5, -0.4), 2, 2)
    assert len(anchored.found) == 1
    anchored.hear(Pose(0.0, 0.0, 0.0), 2, 1)
    assert anchored.found[1] == approx(compose(FRAME, Pose(2.0, -0.5, -0.4)))


def test_a_mapper_that_began_before_the_simulator_is_heard_too_once_it_tells_something_sensible(anchored):
    anchored.hear(Pose(1.0, 0.5, 0.3), 0, 70)  # latched, of another simulation
    for odd in (Pose(1.0, 0.5, math.nan), Pose(1e300, 0.5, 0.3)):
        anchored.hear(odd, 1, 71)
    assert anchored.found == []
    anchored.hear(Pose(2.0, -0.5, -0.4), 2, 72)
    assert anchored.found == [approx(FRAME)]


@pytest.mark.parametrize('who, is_exam, topic, frame', [
    ('truth', False, '/map', 'map'), ('mcl', True, '/map', 'map'), ('none', False, '/map', 'map'),
    ('slam', False, 'simulator/map', 'world'), ('slam', True, None, 'world')])
def test_the_true_map_is_for_onlookers_if_the_robot_makes_its_own_and_secret_in_an_examination(
        who, is_exam, topic, frame):
    assert (localisation.map_topic(who, is_exam), localisation.true_frame(who)) == (topic, frame)
