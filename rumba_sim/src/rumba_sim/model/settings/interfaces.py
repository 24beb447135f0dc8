"""Topics and frames of robots that people have, so that nodes written for them run on a simulated one.

Sources, by interface:
    turtlebot3: ROBOTIS, OpenCR, libraries/turtlebot3/examples/turtlebot3_burger/turtlebot3_core (its config.h: sensors
        at 30 Hz, the IMU at 200 Hz, names of topics and joints; its frames odom, base_footprint, base_link, imu_link);
        turtlebot3_bringup, launch/turtlebot3_lidar.launch (the frame base_scan); hls_lfcd_lds_driver,
        src/hlds_laser_publisher.cpp (the scan: 360 beams from straight ahead on, angle_max 2 pi, intensities).
    create: AutonomyLab, create_robot, README.md and create_driver/src/create_driver.cpp (topics and types, frames,
        joints, loop_hz 10), create_msgs/msg.
    plain: names of REP 105 and of the navigation stack; the scan is that of depthimage_to_laserscan.
"""

from typing import Any, Dict, Mapping, NamedTuple, Tuple

RUMBA = 'rumba'  # only the topics below the name of a robot
CREATE = 'create'
AT_SCAN = 0  # instead of a rate: with each scan of the laser, whose model says how often
COMMAND = 'cmd_vel'


class Topic(NamedTuple):
    """What a robot publishes."""

    name: str
    type: str  # of its messages
    rate: int  # [Hz], or AT_SCAN
    frame: str = ''  # of its headers; empty: there is none, or the driver leaves it empty


class Interface(NamedTuple):
    """The topics and frames of a robot."""

    laser: str  # model of its laser; empty: it has none
    laser_frame: str
    odometry_child: str  # frame whose velocity the odometry tells
    joints: Tuple[str, str]  # of the left and the right wheel; empty: it tells nothing of them
    frames: Tuple[str, ...]  # at base_link, beside that of the laser
    topics: Tuple[Topic, ...]
    inputs: Mapping[str, str]  # types by topics that it subscribes to


TWIST, EMPTY, FLOAT = 'geometry_msgs/Twist', 'std_msgs/Empty', 'std_msgs/Float32'
SETPOINT = 'create_msgs/MotorSetpoint'

INTERFACES: Dict[str, Interface] = {
    'turtlebot3': Interface(
        'lds01', 'base_scan', 'base_footprint', ('wheel_left_joint', 'wheel_right_joint'), ('imu_link',), (
            Topic('scan', 'sensor_msgs/LaserScan', AT_SCAN, 'base_scan'),
            Topic('odom', 'nav_msgs/Odometry', 30, 'odom'),
            Topic('imu', 'sensor_msgs/Imu', 200, 'imu_link'),
            Topic('battery_state', 'sensor_msgs/BatteryState', 30),
            Topic('joint_states', 'sensor_msgs/JointState', 30, 'base_link')),
        {COMMAND: TWIST}),
    CREATE: Interface(
        '', '', 'base_footprint', ('left_wheel_joint', 'right_wheel_joint'), (), (
            Topic('odom', 'nav_msgs/Odometry', 10, 'odom'),
            Topic('joint_states', 'sensor_msgs/JointState', 10),
            Topic('bumper', 'create_msgs/Bumper', 10, 'base_footprint'),
            Topic('cliff', 'create_msgs/Cliff', 10, 'base_footprint'),
            Topic('wheeldrop', EMPTY, 10),
            Topic('ir_omni', 'std_msgs/UInt16', 10),
            Topic('mode', 'create_msgs/Mode', 10, 'base_footprint'),
            Topic('battery/voltage', FLOAT, 10),
            Topic('battery/current', FLOAT, 10),
            Topic('battery/charge', FLOAT, 10),
            Topic('battery/capacity', FLOAT, 10),
            Topic('battery/charge_ratio', FLOAT, 10),
            Topic('battery/temperature', 'std_msgs/Int16', 10),
            Topic('battery/charging_state', 'create_msgs/ChargingState', 10, 'base_footprint')),
        {COMMAND: TWIST, 'dock': EMPTY, 'undock': EMPTY, 'main_brush_motor': SETPOINT, 'side_brush_motor': SETPOINT,
         'vacuum_motor': SETPOINT}),
    'plain': Interface(
        'camera', 'laser', 'base_link', ('', ''), (), (
            Topic('scan', 'sensor_msgs/LaserScan', AT_SCAN, 'laser'),
            Topic('odom', 'nav_msgs/Odometry', 50, 'odom')),
        {COMMAND: TWIST})}

# What the choice of an interface sets beside it.
PRESETS: Dict[str, Dict[str, Any]] = {
    RUMBA: {}, **{name: {'laser': {'model': each.laser}} if each.laser else {} for name, each in INTERFACES.items()}}


def is_due(rate: int, tick: int, step_rate: int) -> bool:
    """Whether something that comes `rate` times a second comes at a tick, 1 or more: at the first, and evenly.

    A rate that does not divide the step rate is kept over a second; a higher one than the step rate means each tick.
    """
    phase = (tick - 1) % step_rate
    return rate >= step_rate or phase * rate // step_rate > (phase - 1) * rate // step_rate
