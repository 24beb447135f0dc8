"""Commands and pen of a turtle, and what happens without one, without a master."""

import math
import types

import pytest
import rospy

from rumba_sim.model.common.errors import ConfigError, WorldError
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.simulation.robot import Twist
from rumba_sim.ros.participants.requests import Requests
from rumba_sim.ros.turtlesim_body import turtle, turtlesim_body
from rumba_sim.ros.turtlesim_body.watch import GONE_AFTER, HUNG_AFTER, SILENT_AFTER, UNHEARD_AFTER, Watch

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


@pytest.mark.parametrize('dead, known', [
    ([], ['/b/turtle1', '/turtle1', '/turtle2']), (['/killed'], ['/b/turtle1', '/turtle2']), (['/killed', '/b'], [])])
def test_only_turtles_of_nodes_that_answer_are_there(monkeypatch, dead, known):
    nodes = {'/turtle1/pose': ['/killed'], '/turtle2/pose': ['/killed', '/b'], '/b/turtle1/pose': ['/b'],
             '/b/pose': ['/b'], '/turtle1/color_sensor': ['/b']}
    kinds = {'/b/pose': 'geometry_msgs/Pose', '/turtle1/color_sensor': 'turtlesim/Color'}
    monkeypatch.setattr(turtle.rospy, 'get_published_topics',
                        lambda: [(topic, kinds.get(topic, 'turtlesim/Pose')) for topic in nodes])
    monkeypatch.setattr(turtle.peers, 'publishers', nodes.get)
    monkeypatch.setattr(turtle.peers, 'is_alive', lambda node: node not in dead)
    assert turtle.turtles() == known


def test_a_master_that_does_not_answer_knows_no_turtle(monkeypatch):
    def fail(*_):
        raise ConnectionRefusedError
    monkeypatch.setattr(turtle.rospy, 'get_published_topics', lambda: [('/turtle1/pose', 'turtlesim/Pose')])
    monkeypatch.setattr(turtle.peers, 'publishers', fail)
    assert turtle.turtles() == []


# --- no turtle ------------------------------------------------------------------------------------------------------

def said(watch, until, is_heard=False, since=100.0):
    """The lines of a watch by the time since its start [s], asked every 0.25 s."""
    times = [since + 0.25 * step for step in range(int(4 * until))]
    found = [(now - since, watch.line(now, is_heard)) for now in times]
    return [(passed, line) for passed, line in found if line]


def test_a_turtle_that_is_missing_is_told_soon_and_every_10_s():
    assert said(Watch('/a/pose', 100.0), 33) == [
        (passed, 'no turtle: nothing publishes /a/pose') for passed in (UNHEARD_AFTER, 12.0, 22.0, 32.0)]


def test_a_turtlesim_that_hangs_is_told_later():
    assert said(Watch('/a/pose', 100.0), 15, is_heard=True) == [
        (SILENT_AFTER, 'no pose on /a/pose for 10 s: turtlesim hangs, or its time stands still')]


def test_while_poses_come_there_is_nothing_to_say():
    watch = Watch('/a/pose', 100.0)
    for now in range(101, 200):
        assert not watch.see(now)
        assert watch.line(now + 0.9, True) is None
        assert not watch.is_gone(now + 0.9, True)


def test_a_turtle_that_comes_back_is_noticed_once_and_missed_anew():
    watch = Watch('/a/pose', 100.0)
    assert watch.line(103.0, False)
    assert [watch.see(104.0), watch.see(104.1)] == [True, False]
    assert watch.line(106.2, False)


def test_poses_that_are_not_finite_do_not_count():
    watch = Watch('/a/pose', 100.0)
    watch.see(101.0)
    watch.see_odd(102.0)
    assert watch.line(103.5, True) == (
        '/a/pose has numbers that are not finite, or too large: turtlesim may miss its pictures; ignored')
    assert not watch.is_gone(101.0 + GONE_AFTER, True)
    assert watch.is_gone(101.1 + GONE_AFTER, True)


@pytest.mark.parametrize('is_heard, bound', [(False, GONE_AFTER), (True, HUNG_AFTER)])
def test_the_robot_is_gone_after_a_bound(is_heard, bound):
    watch = Watch('/a/pose', 100.0)
    assert not watch.is_gone(100.0 + bound, is_heard)
    assert watch.is_gone(100.1 + bound, is_heard)


def idle_body(monkeypatch):
    """A body without topics and without a world: each pose that it obeys is an error."""
    monkeypatch.setattr(turtlesim_body.rospy, 'is_shutdown', lambda: False)
    body = turtlesim_body.TurtlesimBody.__new__(turtlesim_body.TurtlesimBody)
    body._requests, body._watch = Requests(), Watch('/a/pose', 0.0)
    return body


POSE = {'x': 1.0, 'y': 2.0, 'theta': 0.5, 'linear_velocity': 0.0, 'angular_velocity': 0.0}


def test_an_error_at_a_pose_ends_the_node(monkeypatch):
    body = idle_body(monkeypatch)
    body._requests.post(lambda: body._on_pose(types.SimpleNamespace(**POSE)))
    with pytest.raises(AttributeError):
        body.run()


@pytest.mark.parametrize('field, value', [
    *((field, value) for field in POSE for value in (math.nan, math.inf, -math.inf)),
    *((field, value) for field in ('x', 'y', 'theta') for value in (3e38, -1001.0))])
def test_a_pose_that_no_turtle_can_have_is_not_passed_on(monkeypatch, field, value):
    body = idle_body(monkeypatch)
    body._on_pose(types.SimpleNamespace(**{**POSE, field: value}))
    assert body._watch.is_gone(GONE_AFTER + 0.1, True)
