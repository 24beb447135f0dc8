"""Makes the messages of interfaces; those of a Create are in `create_messages`."""

from typing import Any, Callable, Dict, NamedTuple, Optional

from geometry_msgs.msg import Vector3
from sensor_msgs.msg import Imu, JointState, LaserScan
from std_msgs.msg import Header

from rumba_sim.model.common.geometry import TURN
from rumba_sim.model.devices.laser_scan import intensities
from rumba_sim.model.kernel import Array
from rumba_sim.model.settings.interfaces import Interface
from rumba_sim.model.simulation.robot import Robot
from rumba_sim.model.simulation.world import World
from rumba_sim.ros.common import conversions
from rumba_sim.ros.robot.packed import OdometryPacker, odometry_message

GRAVITY = 9.80665  # [m/s^2]
# Variances of the IMU of OpenCR (libraries/turtlebot3/src/turtlebot3_sensor.cpp).
ORIENTATION, ANGULAR_VELOCITY, ACCELERATION = 0.0025, 0.02, 0.04


class Reading(NamedTuple):
    """What messages are made of."""

    interface: Interface
    world: World
    robot: Robot
    header: Header
    odometry: OdometryPacker
    ranges: Optional[Array]  # (beams) [m], if there is a scan
    period: float  # [s] of scans


def scan(reading: Reading) -> LaserScan:
    """The scan; as the driver of the LDS-01 has it, angle_max of a full turn is one increment past the last beam."""
    laser = reading.robot.config.laser
    message = conversions.scan(reading.ranges, laser, reading.period, reading.header)
    if laser.model == 'lds01':
        message.angle_max = message.angle_min + len(message.ranges) * message.angle_increment
    message.intensities = intensities(reading.ranges, laser).tolist()
    return message


def odom(reading: Reading) -> Any:
    """What the encoders tell of pose and velocity."""
    return odometry_message(reading.odometry, reading.world, reading.robot, reading.header.stamp)


def imu(reading: Reading) -> Imu:
    """Heading and turn rate, by the encoders: the robot has no other sensor for them."""
    twist = reading.robot.odometry_twist
    return Imu(
        header=reading.header, orientation=conversions.quaternion(reading.robot.odometry.theta),
        angular_velocity=Vector3(0.0, 0.0, twist.w),
        linear_acceleration=Vector3(0.0, twist.v * twist.w, GRAVITY),
        orientation_covariance=_diagonal(ORIENTATION), angular_velocity_covariance=_diagonal(ANGULAR_VELOCITY),
        linear_acceleration_covariance=_diagonal(ACCELERATION))


def _diagonal(variance: float) -> Any:
    return [variance if index % 4 == 0 else 0.0 for index in range(9)]


def battery_state(reading: Reading) -> Any:
    """The battery, as Rumba tells it."""
    return conversions.battery_state(reading.robot.battery, reading.robot.is_docked, reading.header)


def joint_states(reading: Reading) -> JointState:
    """Angles [rad] and speeds [rad/s] of the wheels, left and right."""
    drive, twist = reading.robot.config.drive, reading.robot.odometry_twist
    sides = (-0.5 * drive.wheel_base * twist.w, 0.5 * drive.wheel_base * twist.w)
    return JointState(
        header=reading.header, name=list(reading.interface.joints),
        position=[ticks / drive.ticks_per_turn * TURN for ticks in reading.robot.ticks],
        velocity=[(twist.v + side) / (0.5 * drive.wheel_diameter) for side in sides], effort=[0.0, 0.0])


MAKERS: Dict[str, Callable[[Reading], Any]] = {
    'scan': scan, 'odom': odom, 'imu': imu, 'battery_state': battery_state, 'joint_states': joint_states}
