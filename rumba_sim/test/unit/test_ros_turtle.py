"""How a turtle is driven and holds its pen, without a master."""

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
    """What a turtle is told: velocities, and the calls of its services by their names."""
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
    """Make the calls that wait for the thread."""
    while not subject._wishes.empty():
        subject._wishes.get()()


def test_a_velocity_is_told_when_it_changes_and_before_turtlesim_forgets_it(told):
    subject = turtle.Turtle('turtle1', None)
    for _ in range(turtle.REMINDER + 1):
        subject.drive(Twist(0.3, -0.5))
    assert told.velocities == [(0.3, -0.5)] * 2
    for _ in range(100):
        subject.drive(Twist(0.0, 0.0))
    assert told.velocities[2:] == [(0.0, 0.0)]


def test_a_new_turtle_is_told_at_once(told):
    subject = turtle.Turtle('turtle1', None)
    subject.drive(Twist(0.3, -0.5))
    subject.hold_pen(PEN)
    subject.peer_subscribe('/turtle1/cmd_vel', None, None)
    subject.drive(Twist(0.3, -0.5))
    subject.hold_pen(PEN)
    served(subject)
    assert told.velocities == [(0.3, -0.5)] * 2
    assert told.calls == [('turtle1/set_pen', PEN)] * 2


def test_a_pen_that_it_holds_is_not_given_again(told):
    subject = turtle.Turtle('turtle1', None)
    for pen in (PEN, PEN, (*PEN[:4], True)):
        subject.hold_pen(pen)
    served(subject)
    assert told.calls == [('turtle1/set_pen', PEN), ('turtle1/set_pen', (1, 2, 3, 8, True))]


def test_a_teleport_lifts_the_pen_first_and_it_is_lowered_when_asked(told):
    subject = turtle.Turtle('turtle1', None)
    subject.teleport(Pose(3.0, 4.0, 0.5), PEN)
    subject.hold_pen(PEN)
    served(subject)
    assert told.calls == [('turtle1/set_pen', (1, 2, 3, 8, True)), ('turtle1/teleport_absolute', (3.0, 4.0, 0.5)),
                          ('turtle1/set_pen', PEN)]


def test_a_teleport_that_fails_says_whose(told, monkeypatch):
    monkeypatch.setattr(turtle.rospy, 'resolve_name', lambda name: f'/{name}')
    told.fail = True
    with pytest.raises(WorldError, match='^/turtle1: no$'):
        turtle.Turtle('turtle1', None).teleport(Pose(3.0, 4.0, 0.5), PEN)


def test_without_turtlesim_it_says_where_that_is_to_be_had(monkeypatch):
    monkeypatch.setattr(turtle, 'PoseMessage', None)
    with pytest.raises(ConfigError, match='install turtlesim .*, or build compat/turtlesim'):
        turtle.Turtle('turtle1', None)
