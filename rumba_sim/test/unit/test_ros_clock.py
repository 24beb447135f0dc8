"""Odd times on /clock do not become the time of a node, and jumps of it end nothing."""

import io

import pytest
import rospy
from rosgraph_msgs.msg import Clock
from rospy.impl import simtime
from std_msgs.msg import Header

from rumba_sim.ros import battery_status_publisher
from rumba_sim.ros.running import clock
from rumba_sim.ros.turtlesim_body import turtlesim_body


def tick(secs, nsecs=0):
    """A message with these numbers, as it comes from the wire."""
    message = Clock()
    message.clock.secs, message.clock.nsecs = secs, nsecs
    return message


@pytest.fixture
def taken(monkeypatch):
    """The times that became those of the node, and the lines that were printed."""
    times, lines = [], []
    monkeypatch.setattr(clock.rospy.rostime, '_set_rostime', times.append)
    monkeypatch.setattr(clock.rospy, 'logwarn_throttle', lambda _, line: lines.append(line))
    return times, lines


def test_a_node_listens_to_the_clock_through_the_guard(monkeypatch):
    monkeypatch.setattr(simtime, '_set_rostime_clock_wrapper', simtime._set_rostime_clock_wrapper)
    clock.guard()
    assert simtime._set_rostime_clock_wrapper is clock.take
    assert '_set_rostime_clock_wrapper' in simtime.init_simtime.__code__.co_names


@pytest.mark.parametrize('secs, nsecs', [(0, 0), (5, 999_999_999), (clock.LATEST, 0)])
def test_a_time_that_can_be_a_stamp_counts(taken, secs, nsecs):
    clock.take(tick(secs, nsecs))
    assert taken == ([rospy.Time(secs, nsecs)], [])


@pytest.mark.parametrize('secs, nsecs', [(clock.LATEST + 1, 0), (2 ** 32 - 1, 2 ** 32 - 1), (5, 10 ** 9)])
def test_any_other_time_is_ignored_and_said_in_one_line(taken, secs, nsecs):
    clock.take(tick(secs, nsecs))
    assert taken == ([], [f'/clock is {secs} s and {nsecs} ns: must be at most 2147483647 s, with less than 1000000000 '
                          'ns; ignored'])


def test_the_stamps_of_a_turtle_fit_into_messages_however_the_clock_jumps(monkeypatch):
    now = rospy.Time(clock.LATEST)
    monkeypatch.setattr(rospy.Time, 'now', lambda: now)
    monkeypatch.setattr(rospy.rostime, 'is_wallclock', lambda: False)
    body = turtlesim_body.TurtlesimBody.__new__(turtlesim_body.TurtlesimBody)
    body._stamp = body._clock = rospy.Time(5)
    for _ in range(100):
        body._stamp = body._next_stamp()
        Header(stamp=body._stamp).serialize(io.BytesIO())
    now = rospy.Time(6)
    assert body._next_stamp() == now


def test_a_clock_that_goes_back_while_the_publisher_of_the_lesson_falls_asleep_does_not_end_it(monkeypatch):
    times = [clock.LATEST, 1]
    monkeypatch.setattr(rospy.rostime, '_rostime_initialized', True)
    monkeypatch.setattr(rospy.rostime, '_rostime_current', rospy.Time(5))
    rate = rospy.Rate(10, reset=True)
    monkeypatch.setattr(rospy.rostime, 'get_rostime', lambda: rospy.Time(times.pop(0) if times[1:] else times[0]))
    battery_status_publisher.pause(rate)
