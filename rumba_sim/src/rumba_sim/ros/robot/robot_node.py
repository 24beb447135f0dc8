"""One robot as a part of the node that moves it: its topics, services and frames."""

import functools
import math
import threading
import time
from typing import Any, Callable, Dict, List, Optional, Tuple

import rospy
from geometry_msgs.msg import TransformStamped, Twist
from nav_msgs.msg import OccupancyGrid, Odometry
from sensor_msgs.msg import BatteryState, LaserScan
from std_msgs.msg import Header
from std_srvs.srv import SetBool, SetBoolResponse

from rumba_msg.msg import BatteryStatus, Bumper, CleaningStatus, Cliff, DockStatus
from rumba_msg.srv import Teleport, TeleportResponse
from rumba_sim.model.common.errors import RumbaError, WorldError
from rumba_sim.model.common.geometry import Pose, compose, inverse
from rumba_sim.model.settings.interfaces import RUMBA
from rumba_sim.model.simulation.robot import Robot
from rumba_sim.model.simulation.world import World
from rumba_sim.ros.common import conversions, teleop
from rumba_sim.ros.common.frames import MAP, frames
from rumba_sim.ros.running.shared_reception import share
from rumba_sim.ros.participants.examiner import ExaminerServer
from rumba_sim.ros.participants.requests import Requests
from rumba_sim.ros.robot.interface_topics import InterfaceTopics
from rumba_sim.ros.robot.latecomers import Latecomers
from rumba_sim.ros.robot.packed import OdometryPacker, TransformPacker, odometry_message
from rumba_sim.ros.robot.packed_sensors import SensorPackers
from rumba_sim.ros.robot.rates import Due, Rates
from rumba_sim.ros.robot.velocity_mux import Input, VelocityMux
from rumba_sim.ros.running import peers

COMPLAINT_PERIOD = 1.0  # [s]
QUEUE = 100  # messages that a subscriber may be behind, at speed 0 too, before it misses one
SECRET = ('ground_truth', 'cleaning_status', 'coverage')  # what the world knows, and the robot does not
UNTOLD = ('coverage',)  # to the judge of an examination
PROGRAMS = 'cmd_vel'  # the input of those who are no persons
# Who may drive, below the robot's name; times are those of the wall clock.
INPUTS = (Input(teleop.TOPIC, 100, teleop.TIMEOUT), Input(PROGRAMS, 10, 0.5))


class RobotNode:
    """Publishers, subscribers and services of one robot; only `publish` and `apply_command` touch the world."""

    def __init__(self, world: World, name: str, requests: Requests, has_localisation: bool,
                 stamp: rospy.Time, has_laser: bool = True, is_held: Callable[[], bool] = lambda: False,
                 on_command: Callable[[str], None] = lambda _: None,
                 examiner: Optional[ExaminerServer] = None, frame: str = MAP, interface: str = RUMBA) -> None:
        """Open the robot's topics and services below its name.

        Args:
            world: where the robot is.
            name: of the robot.
            requests: to the owner of the world.
            has_localisation: whether `transforms` has the correction of odometry.
            stamp: the present time.
            has_laser: whether there is a scan.
            is_held: whether the world waits for those who come late: they are sent what they have missed.
            on_command: called after each command, with the full name of its topic, in a thread of rospy.
            examiner: in an examination, gets everything, while others get only what the robot can know, and nobody can
                teleport the robot.
            frame: that of the world.
            interface: name of a robot whose topics and frames there are too.

        Raises:
            WorldError: another node has a robot of that name.
            ConfigError: the interface needs messages that are not installed.
        """
        self._world = world
        self._name = name
        self._frames = frames(name)
        self._frame = frame
        odom, base = self._frames.odom, self._frames.base_footprint
        self._odometry, self._truth = OdometryPacker(odom, base), OdometryPacker(frame, base)
        self._sensors = SensorPackers(self._frames.base_link)
        self._body, self._correction = TransformPacker(odom, base), TransformPacker(MAP, odom)
        self._has_localisation = has_localisation
        self._mux, self._mux_lock = VelocityMux(INPUTS), threading.Lock()
        self._command: Optional[Tuple[float, float]] = None  # guarded by the lock, as the mux
        self._stamp = stamp
        self._requests = requests
        self._is_held = is_held
        self._report_command = on_command
        self._examiner = examiner
        self._newest: Dict[str, Callable[[], Any]] = {'coverage': self._coverage_message}  # makes a message of a topic
        self._inputs = {each.name: rospy.resolve_name(f'{name}/{each.name}') for each in INPUTS}  # full names
        refuse_twin(name)
        kinds = {'battery_status': BatteryStatus, 'battery_state': BatteryState, 'odom': Odometry,
                 'ground_truth': Odometry, **({'scan': LaserScan} if has_laser else {}), 'bumper': Bumper,
                 'cliff': Cliff, 'dock_status': DockStatus, 'cleaning_status': CleaningStatus,
                 'coverage': OccupancyGrid}
        self._publishers = {
            topic: rospy.Publisher(f'{name}/{topic}', message,
                                   Latecomers(requests, functools.partial(self._missed, topic),
                                              functools.partial(self._newest.get, topic)),
                                   queue_size=2 if message is OccupancyGrid else QUEUE)
            for topic, message in kinds.items() if examiner is None or topic not in SECRET}
        self._told = {} if examiner is None else {
            topic: rospy.resolve_name(f'{name}/{topic}') for topic in kinds if topic not in UNTOLD}  # full names
        if examiner is not None:
            for topic, full_name in self._told.items():
                examiner.declare(full_name, kinds[topic])
        share(*self._inputs.values())
        self._subscribers = [
            rospy.Subscriber(f'{name}/{each.name}', Twist, self._on_command, each.name, queue_size=1)
            for each in INPUTS]
        self._interface = None if interface == RUMBA else InterfaceTopics(
            interface, world, name, requests, is_held, self._on_interface_command, self._take)
        self._services = [
            rospy.Service(f'{name}/set_brushes_up', SetBool, self._on_brushes),
            *([] if examiner is not None else [rospy.Service(f'{name}/teleport', Teleport, self._on_teleport)])]

    @property
    def _robot(self) -> Robot:
        return self._world.robots[self._name]

    def close(self) -> None:
        """Close the robot's topics and services."""
        for service in self._services:
            service.shutdown('the robot is gone')
        for topic in (*self._subscribers, *self._publishers.values()):
            topic.unregister()
        if self._interface is not None:
            self._interface.close()

    # --- commands and services ------------------------------------------------------------------------------------

    def _on_command(self, twist: Twist, topic: str) -> None:
        self._obey(twist, topic, self._inputs[topic])

    def _on_interface_command(self, twist: Twist, full_name: str, is_obeyed: bool) -> None:
        self._obey(twist, PROGRAMS, full_name, is_obeyed)

    def _obey(self, twist: Twist, topic: str, full_name: str, is_obeyed: bool = True) -> None:
        """Take a command that came on a topic, given by its full name, as one of an input."""
        if self._examiner is not None:
            self._examiner.tell_command(full_name, twist, self._stamp, peers.caller(twist))
        v, w = twist.linear.x, twist.angular.z
        if math.isfinite(v) and math.isfinite(w):
            if is_obeyed:
                self._take(v, w, topic)
        else:
            rospy.logerr_throttle(COMPLAINT_PERIOD, f'{full_name[1:]}: linear.x {v} m/s, angular.z {w} rad/s: '
                                                    'must be finite numbers; ignored')
        self._report_command(full_name)

    def _take(self, v: float, w: float, topic: str = PROGRAMS) -> None:
        """Drive so from the next tick on, unless an input of higher priority overrides this one."""
        with self._mux_lock:  # each input has a thread of its own
            if self._mux.passes(topic, time.monotonic()):
                self._command = v, w

    def is_commanded(self, topic: str) -> bool:
        """Whether a topic, given by its full name, is one of this robot's commands, and has a publisher."""
        subscribers = [*self._subscribers, *([] if self._interface is None else [self._interface.commands])]
        return any(each.resolved_name == topic and each.get_num_connections() > 0 for each in subscribers)

    def apply_command(self) -> None:
        """Give the robot the newest command that counts, if one came since the last tick."""
        with self._mux_lock:  # a command that comes at this moment is kept for the next tick
            command, self._command = self._command, None
        if command is not None:
            self._robot.command(*command, self._world.tick)

    def forget_command(self) -> None:
        """Do not give the robot what came since the last tick."""
        with self._mux_lock:
            self._command = None

    def _on_brushes(self, request: Any) -> SetBoolResponse:
        def set_brushes() -> None:
            self._robot.brushes_up = request.data
        self._requests.call(set_brushes)
        return SetBoolResponse(True, f'brushes {"up" if request.data else "down"}')

    def _on_teleport(self, request: Any) -> TeleportResponse:
        pose = Pose(request.pose.x, request.pose.y, request.pose.theta)
        try:
            self._teleport(pose)
        except RumbaError as error:
            return TeleportResponse(False, str(error))
        return TeleportResponse(True, '')

    def _teleport(self, pose: Pose) -> None:
        self._requests.call(lambda: self._world.teleport(self._name, pose))

    # --- messages -------------------------------------------------------------------------------------------------

    def publish(self, due: Due, rates: Rates, stamp: rospy.Time) -> None:
        """Publish the messages that are due, all with the same stamp."""
        self._stamp = stamp
        robot = self._robot
        if due.scan:
            ranges = self._world.prepared_scan(self._name)  # most of a scan is not made if nobody listens
            self._tell('scan', lambda: conversions.scan(
                ranges(), robot.config.laser, 1.0 / rates.scan, self._header(self._frames.laser)))
            if self._interface is not None:
                self._interface.note_scan(ranges(), 1.0 / rates.scan)
        if due.odom:
            self._tell('odom', lambda: odometry_message(self._odometry, self._world, robot, stamp))
        if due.ground_truth:
            self._tell('ground_truth', lambda: self._truth.message(stamp, robot.pose, robot.twist))
        if due.sensors:
            self._publish_sensors()
        if due.battery:
            pose = robot.pose if self._examiner is None else robot.odometry
            self._tell('battery_status', lambda: conversions.battery_status(
                robot.battery, pose, robot.brushes_up, conversions.trouble(robot)))
        if due.cleaning:
            self._tell('cleaning_status', lambda: conversions.cleaning_status(
                robot, self._world.floor, self._header(self._frame)))
            self._tell('coverage', self._coverage_message)
        if self._interface is not None:
            self._interface.publish(stamp)

    def _publish_sensors(self) -> None:
        self._tell('battery_state', lambda: self._sensors.battery_state(self._robot, self._stamp))
        self._tell('bumper', lambda: self._sensors.bumper(self._robot, self._stamp))
        self._tell('cliff', lambda: self._sensors.cliff(self._robot, self._world.cliffs(self._name), self._stamp))
        self._tell('dock_status', lambda: self._sensors.dock_status(
            self._robot, self._world.infrared(self._name), self._stamp))

    def _tell(self, topic: str, message: Callable[[], Any]) -> None:
        """Make and publish a message if somebody listens: most of the cost is in making it."""
        self._newest[topic] = message
        publisher = self._publishers.get(topic)
        is_heard = publisher is not None and publisher.get_num_connections()
        if is_heard or topic in self._told:
            made = message()
            if self._examiner is not None and topic in self._told:
                self._examiner.tell(self._told[topic], made, self._stamp)
            if publisher is not None and is_heard:
                publisher.publish(made)

    def _missed(self, topic: str) -> Any:
        """What a new subscriber of a topic is sent: the coverage in any case."""
        return self._newest[topic]() if topic == 'coverage' or topic in self._newest and self._is_held() else None

    def _header(self, frame: str) -> Header:
        return Header(stamp=self._stamp, frame_id=frame)

    def transforms(self) -> List[bytes]:
        """The pose by odometry, and its correction, at the stamp of what was published last, as parts for tf."""
        odometry = self._robot.odometry
        found = [self._body.part(self._stamp, odometry)]
        if self._has_localisation:
            found.append(self._correction.part(self._stamp, compose(self._robot.pose, inverse(odometry))))
        return found

    def static_transforms(self) -> List[TransformStamped]:
        """The parts of the robot that do not move against each other."""
        config = self._robot.config
        parts = conversions.static_transforms(self._frames, self._stamp, config.drive.wheel_diameter, config.laser)
        return parts + ([] if self._interface is None else self._interface.static_transforms(parts[-1]))

    def _coverage_message(self) -> OccupancyGrid:
        return conversions.grid(self._world.plan, self._world.swept(), self._stamp, self._frame)


def refuse_twin(name: str) -> None:
    """Refuse a robot that another node has already: both would obey the same commands.

    Raises:
        WorldError: another node has a robot of that name.
    """
    service = rospy.resolve_name(f'{name}/teleport')
    if peers.is_served(service):
        raise WorldError(f'there is already a robot {name!r} (another node serves {service}): end that node')
