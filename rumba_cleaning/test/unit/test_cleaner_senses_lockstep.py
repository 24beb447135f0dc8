"""In lockstep, a reading is complete once everything of its tick has come that is to come."""

import pytest
import rospy
from robot_topics import WORLD, Robot, believes, odometry, parts_of
from std_msgs.msg import Header

from rumba_msg.msg import Lockstep


@pytest.mark.parametrize('last', sorted(parts_of(rospy.Time(1))))
def test_in_lockstep_a_reading_is_complete_once_everything_of_its_tick_has_come(monkeypatch, last):
    robot = Robot(monkeypatch, lockstep=WORLD)
    for stamp in rospy.Time(1), rospy.Time(2):
        parts = parts_of(stamp)
        before = robot.readings
        for topic in [topic for topic in parts if topic != last]:
            parts[topic](robot)
        assert robot.readings == before
        parts[last](robot)
        assert (robot.readings, robot.senses.stamp) == (before + 1, stamp)


def test_in_lockstep_a_topic_that_is_never_published_is_not_waited_for(monkeypatch):
    robot = Robot(monkeypatch, lockstep=WORLD)
    parts = parts_of(rospy.Time(1))
    for topic in 'bumper', 'cliff', 'dock_status', 'battery_state':
        parts[topic](robot)
    robot.senses.on_tick(Lockstep(header=Header(stamp=rospy.Time(1)), run=WORLD[0]))
    assert robot.readings == 1


def test_in_lockstep_a_reading_of_another_world_counts_once_that_is_known(monkeypatch):
    robot = Robot(monkeypatch, lockstep=('run', 1))
    for part in parts_of(rospy.Time(5)).values():
        part(robot)
    assert robot.readings == 0
    robot.lockstep = WORLD
    robot.senses.forget(rospy.Time(4), is_new_run=False)
    assert (robot.readings, robot.senses.stamp) == (1, rospy.Time(5))
    assert robot.senses.look() is not None


@pytest.mark.parametrize('last', ['amcl_pose', 'correction', 'tick'])
def test_in_lockstep_a_localisation_is_waited_for_if_there_is_one(monkeypatch, last):
    robot, stamp = Robot(monkeypatch, lockstep=WORLD), rospy.Time(1)
    parts = {**parts_of(stamp), 'tf': lambda robot: robot.transforms(odometry(stamp=stamp)),
             'amcl_pose': lambda robot: robot.tells('amcl_pose', believes(stamp)),
             'correction': lambda robot: robot.transforms(odometry(stamp=stamp, frame='map', child='odom')),
             'tick': lambda robot: robot.senses.on_tick(Lockstep(Header(stamp=stamp), *WORLD, stamp, stamp, stamp))}
    for topic in [topic for topic in parts if topic != last]:
        parts[topic](robot)
    assert robot.readings == 0
    parts[last](robot)
    assert robot.readings == 1


@pytest.mark.parametrize('silence, readings', [(0.5, 0), (1.5, 1)])
def test_in_lockstep_a_correction_is_not_waited_for_while_the_laser_is_silent(monkeypatch, silence, readings):
    robot, scanned = Robot(monkeypatch, lockstep=WORLD), rospy.Time(1)
    stamp = scanned + rospy.Duration(silence)
    robot.transforms(odometry(stamp=scanned, frame='map', child='odom'))
    for topic, tell in {**parts_of(stamp), 'tf': lambda robot: robot.transforms(odometry(stamp=stamp))}.items():
        if topic != 'tick':
            tell(robot)
    robot.tells('amcl_pose', believes(stamp))
    robot.senses.on_tick(Lockstep(Header(stamp=stamp), *WORLD, stamp, stamp, stamp))
    assert robot.readings == readings


def test_in_lockstep_a_scan_without_a_localisation_is_not_waited_for(monkeypatch):
    robot, stamp = Robot(monkeypatch, lockstep=WORLD), rospy.Time(1)
    robot.connections = 0
    for part in parts_of(stamp).values():
        part(robot)
    robot.senses.on_tick(Lockstep(Header(stamp=stamp), *WORLD, stamp, rospy.Time(9), stamp))
    assert robot.readings == 1


def test_in_lockstep_a_localisation_that_was_there_before_is_waited_for_although_it_is_not_connected_yet(monkeypatch):
    robot, stamp = Robot(monkeypatch, lockstep=WORLD, expected='rumba/amcl_pose'), rospy.Time(1)
    robot.connections = 0
    for topic, tell in parts_of(stamp).items():
        if topic != 'tick':
            tell(robot)
    robot.senses.on_tick(Lockstep(Header(stamp=stamp), *WORLD, stamp, rospy.Time(1), stamp))
    assert robot.readings == 0
    robot.tells('amcl_pose', believes(stamp))
    assert robot.readings == 1
