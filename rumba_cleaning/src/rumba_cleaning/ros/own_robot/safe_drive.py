"""safe_drive: stands between who commands a robot that is not ours and its wheels.

It subscribes, below the robot's name, to
  cmd_vel          geometry_msgs/Twist: of the cleaner
  teleop/cmd_vel   geometry_msgs/Twist: of a person, which goes before it
  odom             nav_msgs/Odometry
  scan             sensor_msgs/LaserScan
  seek_dock        std_msgs/Empty: of the cleaner, in place of cmd_vel, to a robot that finds its dock by itself
and publishes there
  safe_cmd_vel     geometry_msgs/Twist: for the robot; remap it to the topic that the robot takes
  odom             nav_msgs/Odometry: with the parameter odometry_from_tf, made of the transform in /tf
  dock_status      rumba_msg/DockStatus: with the parameter create
It serves, below the robot's name,
  stop             std_srvs/SetBool: stands still, whoever commands, until it is called with false
  set_brushes_up   std_srvs/SetBool: with the parameter create

With the parameter create, the namespace of the node create_driver of create_robot, it subscribes there to
  mode, battery/charging_state   create_msgs/Mode, ChargingState
  ir_omni                        std_msgs/UInt16
and publishes there
  dock, undock                   std_msgs/Empty
  main_brush_motor, side_brush_motor, vacuum_motor   create_msgs/MotorSetpoint

The robot stops if the cleaner, its odometry or its scan is silent for the time of the parameter silence, and if its
odometry moves the other way than it is commanded. It never drives faster than its file allows. A second after a stop,
the node is silent, until the next command. A robot that seeks its dock by itself is stopped by undock, unless it
charges.

Parameters, as in `rosrun rumba_cleaning safe_drive _own_robot:=my_robot.yaml`:
"""

import dataclasses
import threading
import time

import rospy
from geometry_msgs.msg import Point, Pose, PoseWithCovariance, Twist, TwistWithCovariance, Vector3
from nav_msgs.msg import Odometry
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Empty
from std_srvs.srv import SetBool, SetBoolResponse
from tf2_msgs.msg import TFMessage

from rumba_cleaning.own_robot.agreement import STANDS, Agreement
from rumba_cleaning.own_robot.gate import CLEANER, PERSON, SEEK_DOCK, STOP, Gate, Moment, Velocity
from rumba_cleaning.ros.own_robot.create import Create
from rumba_cleaning.ros.own_robot.publishing import publish
from rumba_sim.model.common.config import setting
from rumba_sim.model.common.errors import ConfigError
from rumba_sim.ros.common import teleop
from rumba_sim.ros.common.conversions import plane_pose
from rumba_sim.ros.common.names import check_names
from rumba_sim.ros.common.own_robots import own_robot, own_robot_setting
from rumba_sim.ros.running import node

PERIOD = 0.02  # [s] of the wall clock between two looks
LAST = 3  # stops that are sent at the end
COMPLAINT_PERIOD = 5.0  # [s]


@dataclasses.dataclass(frozen=True)
class Settings:
    """The node's private parameters."""

    robot: str = setting('rumba', 'name of the robot, below which its topics are')
    own_robot: str = own_robot_setting()
    silence: float = setting(0.4, 'how long the cleaner, the odometry and the scan may be silent until the robot is '
                                  'stopped', 's', 0.05, 5.0)
    odometry_from_tf: bool = setting(False, 'whether to publish odom from /tf, for a robot that has no such topic')
    create: str = setting('', 'namespace of create_driver, as /, for a Create or a Roomba; empty: another robot')
    docked: bool = setting(True, 'whether a Create stands on its dock at first')

    def __post_init__(self) -> None:
        """Check the robot's name."""
        check_names(self, 'robot')


def main() -> None:
    """Run the node."""
    node.run('safe_drive', Settings, lambda settings: SafeDrive(settings).run(), is_single=True)


class SafeDrive:
    """Hands on commands as they come, and looks after silence in a loop."""

    def __init__(self, settings: Settings) -> None:
        """Open all topics and the service.

        Raises:
            ConfigError: no file is named, or it is wrong; or the messages of a Create are not installed.
        """
        own = own_robot(settings.own_robot)
        if own is None:
            raise ConfigError('own_robot is not given: must be the path of a YAML file with the limits of the robot')
        name = self._name = settings.robot
        odom, scan = (rospy.resolve_name(f'{name}/{topic}') for topic in ('odom', 'scan'))
        self._gate = Gate(own.config.drive, settings.silence, [odom, scan])
        self._agreement = Agreement()
        self._lock, self._has_ended = threading.Lock(), False
        self._publisher = rospy.Publisher(f'{name}/safe_cmd_vel', Twist, queue_size=1)
        self._create = Create(name, settings.create, own.frames.base.lstrip('/'), settings.docked,
                              self._lock) if settings.create else None
        if settings.create:
            rospy.Subscriber(f'{name}/seek_dock', Empty, self._seek_dock, queue_size=1)
        rospy.Subscriber(f'{name}/cmd_vel', Twist, self._take, CLEANER, queue_size=1)
        rospy.Subscriber(f'{name}/{teleop.TOPIC}', Twist, self._take, PERSON, queue_size=1)
        rospy.Subscriber(odom, Odometry, self._compare, odom, queue_size=10)
        rospy.Subscriber(scan, LaserScan, self._hear, scan, queue_size=1)
        rospy.Service(f'{name}/stop', SetBool, self._stop)
        if settings.odometry_from_tf:
            self._link = own.frames.odom.lstrip('/'), own.frames.base.lstrip('/')
            self._odometry = rospy.Publisher(odom, Odometry, queue_size=10)
            rospy.Subscriber('/tf', TFMessage, self._convert, queue_size=100)
        rospy.on_shutdown(self._end)

    def run(self) -> None:
        """Work until ROS shuts down."""
        while not rospy.is_shutdown():
            with self._lock:
                self._drive()
            time.sleep(PERIOD)

    def _take(self, message: Twist, who: str) -> None:
        with self._lock:
            self._gate.command(who, Velocity(message.linear.x, message.angular.z), _now())
            self._drive()

    def _seek_dock(self, _: Empty) -> None:
        with self._lock:
            self._gate.command(CLEANER, SEEK_DOCK, _now())
            self._drive()

    def _hear(self, _: LaserScan, source: str) -> None:
        with self._lock:
            self._gate.hear(source, _now())

    def _compare(self, message: Odometry, source: str) -> None:
        with self._lock:
            self._gate.hear(source, _now())
            pose, stamp = plane_pose(message.pose.pose), message.header.stamp
            if self._create is not None:
                self._create.take_odometry(pose, stamp)
            fault = self._agreement.observe(pose, stamp.to_sec())
            if fault == STANDS:
                rospy.logwarn_throttle(COMPLAINT_PERIOD, f'{source}: {fault}: is the robot held, or does it not take '
                                                         f'{self._publisher.resolved_name}?')
            elif fault:
                self._gate.stop(f'{source}: {fault}; call the service {self._name}/stop with false to drive again')

    def _convert(self, message: TFMessage) -> None:
        for each in message.transforms:
            if (each.header.frame_id.lstrip('/'), each.child_frame_id.lstrip('/')) == self._link:
                moved = each.transform
                pose = Pose(Point(moved.translation.x, moved.translation.y, moved.translation.z), moved.rotation)
                publish(self._odometry, Odometry(each.header, each.child_frame_id,
                                                 PoseWithCovariance(pose, [0.0] * 36), TwistWithCovariance()))

    def _drive(self) -> None:
        """Command what the gate says, until the node ends."""
        if self._has_ended:
            return
        velocity = self._gate.output(_now())
        if self._gate.reason:
            rospy.logerr_throttle(COMPLAINT_PERIOD, f'stopped: {self._gate.reason}')
        if self._create is not None:
            self._create.follow(velocity)
        if velocity is not None:
            self._agreement.command(velocity.v, velocity.w)
        if velocity is not None and not velocity.seeks_dock:
            publish(self._publisher, _twist(velocity))

    def _stop(self, request: SetBool) -> SetBoolResponse:
        with self._lock:
            if request.data:
                self._gate.stop('by the service stop')
            else:
                self._gate.release()
            self._drive()
        return SetBoolResponse(True, 'stopped' if request.data else 'drives again')

    def _end(self) -> None:
        """Command a stop, more than once: the threads that send messages end with the node."""
        with self._lock:
            self._has_ended = True
            if self._create is not None:
                self._create.follow(None)
        for _ in range(LAST):
            self._publisher.publish(_twist(STOP))
            time.sleep(PERIOD)


def _now() -> Moment:
    return Moment(rospy.get_time(), time.monotonic())


def _twist(velocity: Velocity) -> Twist:
    return Twist(Vector3(velocity.v, 0.0, 0.0), Vector3(0.0, 0.0, velocity.w))
