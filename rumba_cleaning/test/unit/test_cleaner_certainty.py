"""How certain the cleaner is of its pose: by what a localisation tells, and for how long it has been silent."""

import math

import pytest
import rospy
from robot_topics import believes, standing
from sensor_msgs.msg import BatteryState
from std_msgs.msg import Header

from rumba_cleaning.behaviour import CERTAIN, UNKNOWN
from rumba_sim.model.common.geometry import Pose
from rumba_sim.ros.common.conversions import transform


@pytest.fixture
def robot(monkeypatch):
    """A robot that stands at the origin, with half its charge."""
    return standing(monkeypatch)


def test_without_a_localisation_that_tells_it_the_pose_is_certain(robot):
    robot.reads(1.0)
    assert robot.senses.look().covariance == CERTAIN


def test_the_covariance_is_that_of_x_y_and_heading(robot):
    robot.reads(1.0)
    told = believes(rospy.Time(1), c0=1.0, c1=2.0, c5=3.0, c7=4.0, c11=5.0, c14=99.0, c30=6.0, c35=7.0)
    robot.tells('amcl_pose', told)
    assert robot.senses.look().covariance == ((1.0, 2.0, 3.0), (0.0, 4.0, 5.0), (6.0, 0.0, 7.0))


@pytest.mark.parametrize('number', [math.nan, math.inf])
def test_a_covariance_that_is_not_finite_means_that_nothing_is_known(robot, number):
    robot.reads(1.0)
    robot.tells('amcl_pose', believes(rospy.Time(1), c7=number))
    assert robot.senses.look().covariance == UNKNOWN and robot.senses.look().is_lost


def test_a_localisation_that_falls_silent_leaves_nothing_known_until_it_is_back(robot):
    robot.tells('amcl_pose', believes(rospy.Time(1), c0=0.01))
    for seconds, is_lost in ((1.0, False), (3.0, False), (3.1, True)):
        robot.reads(seconds)
        assert robot.senses.look().is_lost is is_lost
    robot.tells('amcl_pose', believes(rospy.Time(3), c0=0.01))
    assert not robot.senses.look().is_lost
    robot.senses.forget(rospy.Time(4), is_new_run=True)
    robot.stands()
    robot.tells('battery_state', BatteryState(header=Header(stamp=rospy.Time(90)), percentage=0.5))
    robot.reads(90.0)
    assert robot.senses.look().covariance == CERTAIN


def test_the_laser_is_silent_for_as_long_as_the_pose_is_newer_than_the_correction(robot):
    robot.reads(1.0)
    assert robot.senses.look().silence == 0.0  # nobody tells a covariance
    for stamp, silence in ((rospy.Time(0, 900_000_000), 0.0), (rospy.Time(1), 0.0), (rospy.Time(3, 500_000_000), 2.5)):
        robot.tells('amcl_pose', believes(stamp, c0=0.04))
        assert robot.senses.look().silence == silence
    robot.reads(3.5)
    assert robot.senses.look().is_lost
    robot.transforms(transform('map', 'odom', Pose(0.0, 0.0, 0.0), rospy.Time(3, 500_000_000)))
    assert robot.senses.look().silence == 0.0 and not robot.senses.look().is_lost


def test_a_correction_that_is_static_is_never_too_old(robot):
    robot.transforms(transform('map', 'odom', Pose(0.0, 0.0, 0.0), rospy.Time(1)), topic='/tf_static')
    robot.reads(9.0)
    robot.tells('amcl_pose', believes(rospy.Time(9), c0=0.04))
    assert robot.senses.look().silence == 0.0
