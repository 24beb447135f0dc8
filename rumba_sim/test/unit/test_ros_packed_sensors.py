"""What a robot senses, packed: the messages that subscribers get."""

import io
import math
import types

import pytest
import rospy
from sensor_msgs.msg import BatteryState
from std_msgs.msg import Header

from rumba_msg.msg import Bumper, Cliff, DockStatus
from rumba_sim.model.settings.battery import Battery, BatteryConfig
from rumba_sim.model.simulation.robot import Infrared
from rumba_sim.ros.common import conversions
from rumba_sim.ros.robot.packed_sensors import SensorPackers

STAMP = rospy.Time(12, 34)


@pytest.fixture
def packers():
    return SensorPackers('rumba2/base')


def unpacked(message, kind):
    """What a subscriber gets; exactly so many bytes as the definition has."""
    buffer, again = io.BytesIO(), io.BytesIO()
    message.serialize(buffer)
    found = kind().deserialize(buffer.getvalue())
    found.serialize(again)
    assert again.getvalue() == buffer.getvalue()
    assert (found.header.stamp, found.header.frame_id) == (STAMP, 'rumba2/base')
    return found


@pytest.mark.parametrize('has_fallen', [False, True])
def test_cliff_has_the_sensors_from_left_to_right_and_a_separate_field_for_the_wheels(packers, has_fallen):
    robot = types.SimpleNamespace(has_fallen=has_fallen)
    message = unpacked(packers.cliff(robot, (True, False, True, False), STAMP), Cliff)
    assert (message.is_cliff_left, message.is_cliff_front_left) == (True, False)
    assert (message.is_cliff_front_right, message.is_cliff_right) == (True, False)
    assert message.is_wheel_dropped is has_fallen


@pytest.mark.parametrize('pressed', [(True, False), (False, True)])
def test_bumper_has_left_and_right(packers, pressed):
    message = unpacked(packers.bumper(types.SimpleNamespace(bumper=pressed), STAMP), Bumper)
    assert (message.is_left_pressed, message.is_right_pressed) == pressed


@pytest.mark.parametrize('infrared, is_visible', [(Infrared(1, 4, 8), True), (Infrared(0, 0, 0), False)])
def test_dock_status_has_contacts_and_beams(packers, infrared, is_visible):
    message = unpacked(packers.dock_status(types.SimpleNamespace(is_docked=True), infrared, STAMP), DockStatus)
    assert (message.dock_visible, message.is_docked) == (is_visible, True)
    assert (message.infrared_omni, message.infrared_left, message.infrared_right) == infrared


def test_messages_of_a_topic_are_numbered(packers):
    robot = types.SimpleNamespace(bumper=(False, False))
    assert [unpacked(packers.bumper(robot, STAMP), Bumper).header.seq for _ in range(3)] == [1, 2, 3]


@pytest.mark.parametrize('charge, is_docked', [(0.0, False), (0.5, False), (0.7, True), (1.0, True)])
def test_the_battery_is_that_of_the_conversion(packers, charge, is_docked):
    robot = types.SimpleNamespace(battery=Battery(BatteryConfig(), charge, -0.7), is_docked=is_docked)
    message = unpacked(packers.battery_state(robot, STAMP), BatteryState)
    buffer = io.BytesIO()
    conversions.battery_state(robot.battery, is_docked, Header(1, STAMP, 'rumba2/base')).serialize(buffer)
    expected = BatteryState().deserialize(buffer.getvalue())
    for name in message.__slots__[1:]:
        mine, theirs = getattr(message, name), getattr(expected, name)
        assert mine == theirs or all(map(math.isnan, mine if isinstance(mine, (list, tuple)) else [mine])), name
