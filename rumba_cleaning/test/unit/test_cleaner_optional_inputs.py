"""Messages of any type on the topics that a robot of others may have: read, or named and ignored."""

import io
from types import SimpleNamespace

import pytest
import roslib.message
import rospy
from sensor_msgs.msg import BatteryState
from std_msgs.msg import Float32, String

from rumba_cleaning.own_robot.inputs import READERS
from rumba_cleaning.ros.cleaner.robots import optional_inputs
from rumba_cleaning.ros.cleaner.robots.optional_inputs import OptionalInputs
from rumba_msg.msg import Bumper, Cliff


@pytest.fixture
def robot(monkeypatch):
    """Inputs, what is subscribed to, and what was complained of."""
    topics, complaints = {}, []
    monkeypatch.setattr(rospy, 'Subscriber', lambda name, kind, callback, argument, **_: topics.update(
        {name: lambda message: callback(message, argument)}))
    monkeypatch.setattr(optional_inputs, '_complain', complaints.append)
    return SimpleNamespace(state=OptionalInputs('rumba').state, topics=topics, complaints=complaints)


def sent(message, kind=None, md5sum=None, topic='/it'):
    """A message as rospy hands it to a subscriber of any type."""
    buffer = io.BytesIO()
    message.serialize(buffer)
    header = {'type': kind or message._type, 'md5sum': md5sum or message._md5sum, 'topic': topic}
    return SimpleNamespace(_connection_header=header, _buff=buffer.getvalue())


def test_it_listens_to_every_topic_for_which_there_is_a_reader(robot):
    assert sorted(robot.topics) == sorted(f'rumba/{name}' for name in READERS)


def test_messages_are_read_by_their_types(robot):
    robot.topics['rumba/battery_state'](sent(Float32(0.5)))
    assert robot.state.charge == 0.5
    robot.topics['rumba/battery_state'](sent(BatteryState(percentage=0.25)))
    assert robot.state.charge == 0.25
    robot.topics['rumba/bumper'](sent(Bumper(is_left_pressed=True)))
    assert robot.state.bumper == (True, False)
    robot.topics['rumba/cliff'](sent(Cliff(is_cliff_right=True)))
    assert robot.state.cliffs == (False, False, False, True)
    assert robot.complaints == []


def test_a_package_that_is_not_installed_is_named(robot):
    robot.topics['rumba/bumper'](sent(String('x'), kind='kobuki_msgs/BumperEvent', topic='/mobile_base/events/bumper'))
    assert robot.complaints == [
        '/mobile_base/events/bumper has type kobuki_msgs/BumperEvent: ignored, since the package kobuki_msgs is not '
        'installed: install it, or source the workspace that has it']
    assert robot.state.bumper == (False, False)


def test_one_that_is_installed_is_used(robot, monkeypatch):
    class BumperEvent(Float32):
        """Its fields, without its package."""

        state, bumper = 1, 2
    monkeypatch.setattr(roslib.message, 'get_message_class', {'kobuki_msgs/BumperEvent': BumperEvent}.get)
    robot.topics['rumba/bumper'](sent(Float32(0.0), kind='kobuki_msgs/BumperEvent'))
    assert robot.state.bumper == (False, True)
    assert robot.complaints == []


def test_other_types_and_other_versions_are_ignored_and_named(robot):
    robot.topics['rumba/bumper'](sent(String('x')))
    robot.topics['rumba/bumper'](sent(Bumper(), md5sum='0'))
    assert robot.complaints == [
        '/it has type std_msgs/String: ignored, since bumper must be one of ' + ', '.join(READERS['bumper']),
        '/it has another version of rumba_msg/Bumper than the one that is installed: ignored']
