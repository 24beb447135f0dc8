"""Commands and pen of a turtle, without a master."""

import types

import pytest
import rospy

from rumba_sim.model.errors import ConfigError, WorldError
from rumba_sim.model.geometry import Pose
from rumba_sim.model.robot import Twist
from rumba_sim.ros.turtlesim_body import turtle

PEN = (1, 2, 3, 8, False)


@pytest.fixture()
def told(monkeypatch):
    """The velocities that a turtle gets, and the calls of its services by name."""
    told = types.SimpleNamespace(velocities=[], calls=[], fail=False)

    def call(name, _):
        def proxy(*arguments):
            if told.fail:
                raise rospy.ServiceException('no')
            told.calls.append((name, arguments))
        return proxy
    monkeypatch.setattr(turtle, 'PoseMessage', object)
    monkeypatch.setattr(turtle, 'SetPen', object, raising=False)
    monkeypatch.setattr(turtle, 'TeleportAbsolute', object, raising=False)
    monkeypatch.setattr(turtle.threading, 'Thread', lambda **_: types.SimpleNamespace(start=lambda: None))
    monkeypatch.setattr(turtle.rospy, 'Subscriber', lambda *_, **__: None)
    monkeypatch.setattr(turtle.rospy, 'Publisher', lambda *_, **__: types.SimpleNamespace(
        publish=lambda linear, angular: told.velocities.append((linear.x, angular.z))))
    monkeypatch.setattr(turtle.rospy, 'wait_for_service', lambda *_: None)
    monkeypatch.setattr(turtle.rospy, 'ServiceProxy', call)
    return told


def served(subject):
    """Make the calls that are in the queue of the thread."""
    while not subject._calls.empty():
        subject._calls.get()()


def test_a_velocity_is_sent_when_it_changes_and_again_before_turtlesim_stops(told):
    subject = turtle.Turtle('turtle1', None)
    for _ in range(turtle.REMINDER + 1):
        subject.drive(Twist(0.3, -0.5))
    assert told.velocities == [(0.3, -0.5)] * 2
    for _ in range(100):
        subject.drive(Twist(0.0, 0.0))
    assert told.velocities[2:] == [(0.0, 0.0)]


def test_a_new_turtle_gets_velocity_and_pen_at_once(told):
    subject = turtle.Turtle('turtle1', None)
    subject.drive(Twist(0.3, -0.5))
    subject.hold_pen(PEN)
    subject.peer_subscribe('/turtle1/cmd_vel', None, None)
    subject.drive(Twist(0.3, -0.5))
    subject.hold_pen(PEN)
    served(subject)
    assert told.velocities == [(0.3, -0.5)] * 2
    assert told.calls == [('turtle1/set_pen', PEN)] * 2


def test_a_pen_that_does_not_change_is_set_once(told):
    subject = turtle.Turtle('turtle1', None)
    for pen in (PEN, PEN, (*PEN[:4], True)):
        subject.hold_pen(pen)
    served(subject)
    assert told.calls == [('turtle1/set_pen', PEN), ('turtle1/set_pen', (1, 2, 3, 8, True))]


def test_a_teleport_lifts_the_pen_until_it_is_set_again(told):
    subject = turtle.Turtle('turtle1', None)
    subject.teleport(Pose(3.0, 4.0, 0.5), PEN)
    subject.hold_pen(PEN)
    served(subject)
    assert told.calls == [('turtle1/set_pen', (1, 2, 3, 8, True)), ('turtle1/teleport_absolute', (3.0, 4.0, 0.5)),
                          ('turtle1/set_pen', PEN)]


def test_a_teleport_that_fails_names_the_turtle(told, monkeypatch):
    monkeypatch.setattr(turtle.rospy, 'resolve_name', lambda name: f'/{name}')
    told.fail = True
    with pytest.raises(WorldError, match='^/turtle1: no$'):
        turtle.Turtle('turtle1', None).teleport(Pose(3.0, 4.0, 0.5), PEN)


def test_without_turtlesim_the_message_says_how_to_install_it(monkeypatch):
    monkeypatch.setattr(turtle, 'PoseMessage', None)
    with pytest.raises(ConfigError, match='install turtlesim .*, or build compat/turtlesim'):
        turtle.Turtle('turtle1', None)
