"""From the model to messages: units, signs and frames, without a master."""

import math

import numpy as np
import pytest
import rospy
from sensor_msgs.msg import BatteryState
from std_msgs.msg import Header

from rumba_sim.model.common.config import from_mapping
from rumba_sim.model.settings.battery import Battery, BatteryConfig
from rumba_sim.model.settings.laser_config import LaserConfig
from rumba_sim.model.settings.robot_config import OdometryConfig
from rumba_sim.ros.common import conversions
from rumba_sim.ros.common.frames import frames

HEADER = Header(frame_id='base')


@pytest.mark.parametrize('charge, is_docked, status', [
    (0.5, False, BatteryState.POWER_SUPPLY_STATUS_DISCHARGING),
    (1.0, False, BatteryState.POWER_SUPPLY_STATUS_DISCHARGING),
    (0.999, True, BatteryState.POWER_SUPPLY_STATUS_CHARGING), (1.0, True, BatteryState.POWER_SUPPLY_STATUS_FULL)])
def test_the_status_of_the_battery_follows_dock_and_charge(charge, is_docked, status):
    message = conversions.battery_state(Battery(BatteryConfig(), charge, -0.7), is_docked, HEADER)
    assert message.power_supply_status == status
    assert message.percentage == pytest.approx(charge)
    assert message.charge == pytest.approx(2.7 * charge)
    assert message.current == -0.7
    assert message.power_supply_technology == BatteryState.POWER_SUPPLY_TECHNOLOGY_NIMH


def test_an_empty_battery_is_dead():
    message = conversions.battery_state(Battery(BatteryConfig(), 0.0), False, HEADER)
    assert (message.percentage, message.power_supply_health) == (0.0, BatteryState.POWER_SUPPLY_HEALTH_DEAD)


def test_what_a_battery_does_not_measure_is_nan():
    message = conversions.battery_state(Battery(BatteryConfig(), 0.5), False, HEADER)
    assert len(message.cell_voltage) == 12 and all(map(math.isnan, message.cell_voltage))
    for name in {'temperature', 'cell_temperature'} & set(message.__slots__):
        assert np.isnan(getattr(message, name)).all()


@pytest.mark.parametrize('beams', [1, 7, 360, 1000])
def test_the_angles_of_a_scan_fit_its_ranges(beams):
    message = conversions.scan(np.full(beams, 2.0), LaserConfig(beams=beams), 0.1, HEADER)
    assert len(message.ranges) == beams
    assert message.angle_min == -math.pi
    assert message.angle_max == message.angle_min + (beams - 1) * message.angle_increment
    assert beams * message.angle_increment == pytest.approx(2.0 * math.pi)


@pytest.mark.parametrize('x, y, yaw, upside_down', [
    (0.0, 0.0, 0.0, False), (0.1, -0.05, 0.7, False), (0.1, -0.05, 0.7, True), (0.0, 0.2, -2.5, True)])
def test_the_transform_of_the_laser_is_its_mounting(x, y, yaw, upside_down):
    laser = LaserConfig(x=x, y=y, yaw=yaw, upside_down=upside_down)
    base, mounted = conversions.static_transforms(frames('rumba'), rospy.Time(), 0.072, laser)
    place, turn = mounted.transform.translation, mounted.transform.rotation
    assert (mounted.header.frame_id, mounted.child_frame_id) == ('base_link', 'laser')
    assert (place.x, place.y, place.z) == (x, y, 0.07) and base.transform.translation.z == 0.036
    for angle in (0.0, 1.0, -2.0):
        seen = rotated(turn, (math.cos(angle), math.sin(angle), 0.0))
        there = yaw + (-angle if upside_down else angle)
        assert seen == pytest.approx((math.cos(there), math.sin(there), 0.0))
    assert rotated(turn, (0.0, 0.0, 1.0)) == pytest.approx((0.0, 0.0, -1.0 if upside_down else 1.0))


def rotated(turn, vector):
    """A vector turned by a quaternion."""
    axis = np.array([turn.x, turn.y, turn.z])
    across = 2.0 * np.cross(axis, vector)
    return vector + turn.w * across + np.cross(axis, across)


def test_the_angles_of_a_scan_are_those_of_the_laser():
    laser = from_mapping(LaserConfig, {'model': 'urg04lx', 'clockwise': True}, 'test')
    message = conversions.scan(np.full(682, 2.0), laser, 0.1, HEADER)
    assert message.angle_min == pytest.approx(-340 * 2.0 * math.pi / 1024)
    assert message.angle_increment == pytest.approx(-2.0 * math.pi / 1024)
    assert message.angle_max == message.angle_min + 681 * message.angle_increment
    assert (message.range_min, message.range_max, message.intensities) == (0.02, 5.6, [])


def test_a_quaternion_turns_counter_clockwise():
    turn = conversions.quaternion(math.pi / 2.0)
    assert (turn.x, turn.y) == (0.0, 0.0)
    assert (turn.z, turn.w) == pytest.approx((math.sqrt(0.5), math.sqrt(0.5)))


def test_the_variance_of_odometry_is_that_of_two_wheels():
    """After 2 m, a wheel errs by 2 m * 0.01 and by 0.002 m * sqrt(2); the heading by the difference / wheel base."""
    wheel = (2.0 * 0.01) ** 2 + 0.002 ** 2 * 2.0
    place, heading = conversions.odometry_variance(2.0, OdometryConfig(), 0.235)
    assert place == pytest.approx(wheel / 2.0)
    assert heading == pytest.approx(2.0 * wheel / 0.235 ** 2)


def test_the_frames_of_all_robots_except_the_first_have_a_prefix():
    assert frames('rumba') == ('odom', 'base_footprint', 'base_link', 'laser')
    assert frames('rumba2') == ('rumba2/odom', 'rumba2/base_footprint', 'rumba2/base_link', 'rumba2/laser')
