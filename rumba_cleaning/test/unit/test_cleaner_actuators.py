"""Whom the wheels and brushes obey: the cleaner, or a person."""

import queue
import time
import types

import rospy
from geometry_msgs.msg import Twist

from rumba_cleaning.behaviour import Command
from rumba_cleaning.ros.cleaner.robots import actuators, teleop


def test_a_person_drives_from_a_command_on_until_the_time_is_up(monkeypatch):
    topics, now = {}, [100.0]
    monkeypatch.setattr(teleop.rospy, 'Subscriber', lambda topic, _, callback, **__: topics.update({topic: callback}))
    monkeypatch.setattr(teleop.time, 'monotonic', lambda: now[0])
    person = teleop.Teleop('rumba2')
    assert not person.is_driving
    topics['rumba2/teleop/cmd_vel'](Twist())
    assert person.is_driving
    now[0] += 0.4
    topics['rumba2/teleop/cmd_vel'](Twist())
    now[0] += 0.4
    assert person.is_driving
    now[0] += 0.2
    assert not person.is_driving


def test_wheels_that_are_closed_have_stopped_and_get_no_command(monkeypatch):
    told = []
    monkeypatch.setattr(actuators.rospy, 'Publisher', lambda *_, **__: types.SimpleNamespace(
        publish=lambda twist: told.append((twist.linear.x, twist.angular.z))))
    wheels = actuators.Wheels('rumba')
    wheels.drive(Command(0.2, -1.0))
    wheels.stop()
    wheels.drive(Command(0.1, 0.5))
    wheels.close()
    wheels.drive(Command(0.3, 0.0))
    assert told == [(0.2, -1.0), (0.0, 0.0), (0.1, 0.5), (0.0, 0.0)]


def test_a_robot_that_docks_by_itself_is_told_to_in_place_of_a_velocity(monkeypatch):
    told = []
    monkeypatch.setattr(actuators.rospy, 'Publisher', lambda topic, *_, **__: types.SimpleNamespace(
        publish=lambda *_: told.append(topic)))
    wheels = actuators.Wheels('rumba', docks=True)
    seek = Command(0.0, 0.0, seeks_dock=True)
    for command in (Command(0.2, 0.0), seek, seek):
        wheels.drive(command)
    assert told == ['rumba/cmd_vel', 'rumba/seek_dock', 'rumba/seek_dock']
    wheels.close()
    wheels.drive(seek)
    assert told[3:] == ['rumba/cmd_vel']


def test_brushes_are_asked_for_what_is_new_and_again_if_that_failed(monkeypatch):
    asked, failures = queue.Queue(), [rospy.ServiceException('no'), TypeError('no'), OSError('no')]

    def serve(are_up):
        asked.put(are_up)
        if failures and are_up:
            raise failures.pop()
    monkeypatch.setattr(actuators.rospy, 'ServiceProxy', lambda *_: serve)
    monkeypatch.setattr(actuators.rospy, 'is_shutdown', lambda: False)
    monkeypatch.setattr(actuators.rospy, 'logwarn_throttle', lambda *_: None)
    brushes = actuators.Brushes('rumba')
    for are_up in (False, False, True):
        brushes.want(are_up)
    assert [asked.get(timeout=5.0), asked.get(timeout=5.0)] == [False, True]
    for _ in range(2):
        end = time.monotonic() + 5.0
        while asked.empty():
            assert time.monotonic() < end
            brushes.want(True)
        assert asked.get(timeout=5.0) is True
    end = time.monotonic() + 5.0
    while asked.empty():
        assert time.monotonic() < end
        brushes.want(True)
    assert asked.get(timeout=5.0) is True
    brushes.want(True)
    brushes.forget()
    brushes.want(True)
    assert asked.get(timeout=5.0) is True
    assert asked.empty()
