"""turtlesim_body: makes a turtle of a running turtlesim the body of a Rumba.

Below the robot's name it publishes
  battery_status   rumba_msg/BatteryStatus    battery_state   sensor_msgs/BatteryState
  odom             nav_msgs/Odometry          ground_truth    nav_msgs/Odometry
  bumper           rumba_msg/Bumper           cliff           rumba_msg/Cliff
  dock_status      rumba_msg/DockStatus       cleaning_status rumba_msg/CleaningStatus
  coverage         nav_msgs/OccupancyGrid
subscribes to
  cmd_vel          geometry_msgs/Twist: linear.x [m/s], angular.z [rad/s]
  teleop/cmd_vel   geometry_msgs/Twist: the same from a person; overrides cmd_vel until 0.5 s after its last message
and serves
  set_brushes_up   std_srvs/SetBool: lifts or lowers the brushes, and the turtle's pen with them
  teleport         rumba_msg/Teleport: by the turtle's teleport_absolute
It publishes simulator/state (rumba_msg/SimulatorState, latched), /map, /tf and /tf_static. It serves /static_map and,
below its own name, reset (std_srvs/Trigger), which makes the floor dirty and charges the battery; the parameters
NAME/settings are the settings in force. A turtle has no laser, so there is no scan.
It uses TURTLE/pose (turtlesim/Pose), TURTLE/cmd_vel (geometry_msgs/Twist), TURTLE/set_pen, TURTLE/teleport_absolute and
clear of turtlesim. Time passes with the poses, 16 ms with each: without poses it stands still. Without a turtle for
10 s, the topics and services of the robot are closed until the turtle is there.

Parameters, as in `rosrun rumba_sim turtlesim_body _turtle:=turtle2 _battery/drain:=10`:
"""

import dataclasses
import math
import time
from typing import Any, Optional, Tuple

import rospy
from std_srvs.srv import Trigger, TriggerResponse
from tf2_msgs.msg import TFMessage

from rumba_sim.model.common.config import part, section, setting
from rumba_sim.model.common.errors import one_line
from rumba_sim.model.common.geometry import Pose, wrap_angle
from rumba_sim.model.maps import map_file
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation.guided_world import GuidedWorld
from rumba_sim.model.simulation.turtle_motion import FRAME_RATE, PIXELS_PER_METRE, TurtleMotion
from rumba_sim.model.simulation.world import World
from rumba_sim.ros.common.names import check_names
from rumba_sim.ros.participants.maps import map_path, refuse_second, tell_map
from rumba_sim.ros.participants.requests import Requests
from rumba_sim.ros.participants.simulator_client import SETTINGS
from rumba_sim.ros.robot import packed
from rumba_sim.ros.robot.localisation import TRUTH, localisation_setting
from rumba_sim.ros.robot.rates import Rates
from rumba_sim.ros.robot.robot_node import RobotNode
from rumba_sim.ros.robot.state_publisher import StatePublisher
from rumba_sim.ros.running import node
from rumba_sim.ros.turtlesim_body.turtle import Pen, Turtle, turtles
from rumba_sim.ros.turtlesim_body.watch import Watch

RATES = Rates(scan=0)
FRAME_NS = round(1e9 / FRAME_RATE)
MAX_LAG = 10_000_000_000  # [ns] by which counted time may be behind /clock
LARGEST = 1000.0  # [m], [rad] in a pose: the field is 11 m wide
PERIOD = 0.1  # [s] of the wall clock between two looks whether ROS shuts down
LANDING = 10  # [frames] after a teleport in which the pen stays up: turtlesim may draw the line late


@dataclasses.dataclass(frozen=True)
class PenSettings:
    """The line that shows the cleaned floor."""

    red: int = setting(240, 'red part of the colour', '', 0, 255)
    green: int = setting(240, 'green part of the colour', '', 0, 255)
    blue: int = setting(255, 'blue part of the colour', '', 0, 255)
    width: int = setting(0, 'width of the line; 0: that of the brush, at 45 pixels per metre', 'pixels', 0, 255)


@dataclasses.dataclass(frozen=True)
class Settings(RobotConfig):
    """The node's private parameters: properties of the robot, and which turtle is its body."""

    robot: str = setting('rumba', 'name of the robot, below which its topics are')
    turtle: str = setting('turtle1', 'name of the turtle that is its body')
    map: str = setting('field', "name of a map of this package, or path of a map_server YAML file, of turtlesim's "
                                'field with a dock')
    seed: int = setting(1, 'seed of the random generators', '', 0, 2 ** 31 - 1)
    percentage: float = setting(100.0, 'charge at the start', '%', 0.0, 100.0)
    brushes_up: bool = setting(False, 'whether the brushes are lifted at the start')
    localisation: str = localisation_setting()
    config: str = setting('', 'path of a YAML file with any of these; parameters override it')
    pen: PenSettings = section(PenSettings, 'the line that shows the cleaned floor')

    def __post_init__(self) -> None:
        """Check the names of robot and turtle, which are parts of the names of topics."""
        check_names(self, 'robot', 'turtle')


def main() -> None:
    """Run the node."""
    node.run('turtlesim_body', Settings, lambda settings: TurtlesimBody(settings).run(), own_parameters=[SETTINGS],
             is_single=True)


class TurtlesimBody:
    """The loop that owns the robot's world; each pose of the turtle is a tick of it."""

    def __init__(self, settings: Settings) -> None:
        """Create the world and open all topics and services.

        Raises:
            RumbaError: the map or a setting is wrong, a simulator is running, or turtlesim is not installed.
        """
        refuse_second()
        path = map_path(settings.map)
        config = part(settings, RobotConfig)
        plan = map_file.load(path, config.drive.radius)
        self._guided = GuidedWorld(plan, config, FRAME_RATE, settings.seed, settings.robot,
                                   settings.percentage / 100.0, settings.brushes_up)
        self._settings = settings
        self._requests = Requests()
        self._motion = TurtleMotion()
        self._ticks = 0
        self._landed = 0.0  # tick from which the pen may be down again; inf during a teleport
        self._stamp = self._clock = rospy.Time.now()
        self._turtle = Turtle(settings.turtle, lambda pose: self._requests.post(lambda: self._on_pose(pose)))
        self._watch = Watch(self._turtle.pose_topic, time.monotonic())
        self._node: Optional[TurtleNode] = None  # None while there is no turtle
        robot = self._open()
        self._tf = rospy.Publisher('/tf', TFMessage, queue_size=100)
        self._tf_static = rospy.Publisher('/tf_static', TFMessage, queue_size=1, latch=True)
        self._tf_static.publish(robot.static_transforms())
        tell_map(plan, self._stamp)
        rospy.Service('~reset', Trigger, lambda _: TriggerResponse(True, self._requests.call(self._reset)))
        self._state = StatePublisher(settings, path, FRAME_RATE, not rospy.rostime.is_wallclock())
        self._state.publish(self._ticks, self._stamp)

    def run(self) -> None:
        """Follow the turtle until ROS shuts down."""
        while not rospy.is_shutdown():
            self._requests.serve(time.monotonic() + PERIOD)
            self._look_for_turtle()
            self._report()

    def _open(self) -> 'TurtleNode':
        """The topics and services of the robot, which are opened if they are closed."""
        if self._node is None:
            self._node = TurtleNode(self._guided.world, self._settings.robot, self._requests,
                                    self._settings.localisation == TRUTH, self._stamp, self._teleport)
        return self._node

    def _look_for_turtle(self) -> None:
        """Say that the turtle is missing, and close the robot if it has been missing for long."""
        now, is_heard = time.monotonic(), self._turtle.is_heard
        line = self._watch.line(now, is_heard)
        if line and not is_heard:
            known = one_line(', '.join(turtles()) or 'none')
            line += f'; turtles that there are: {known}. Start turtlesim, or set the parameter turtle'
        if line:
            rospy.logwarn(line)
        if self._node is not None and self._watch.is_gone(now, is_heard):
            rospy.logerr(f'{self._settings.robot} has no body: its topics are closed until there is a turtle')
            self._node.close()
            self._node = None

    def _report(self) -> None:
        """Publish the state, if it is due."""
        if time.monotonic() >= self._state.due:
            self._state.publish(self._ticks, self._stamp)

    # --- what the turtle does -----------------------------------------------------------------------------------------

    def _on_pose(self, message: Any) -> None:
        if not (all(abs(number) <= LARGEST for number in (message.x, message.y, message.theta))  # NaN is not
                and math.isfinite(message.linear_velocity) and math.isfinite(message.angular_velocity)):
            self._watch.see_odd(time.monotonic())
            return
        if self._watch.see(time.monotonic()):
            rospy.loginfo(f'there is a turtle on {self._turtle.pose_topic}')
        pose = Pose(message.x, message.y, wrap_angle(message.theta))
        driven = self._motion.driven(pose, message.linear_velocity, message.angular_velocity)
        for each in driven:
            self._guided.follow(each)
            self._tick()
        if not driven:
            self._turtle.forget_pen()
            self._guided.jump(pose)
            self._tick()

    def _tick(self) -> None:
        self._ticks += 1
        self._stamp = self._next_stamp()
        due, robot = RATES.due(self._ticks, FRAME_RATE), self._open()
        robot.publish(due, RATES, self._stamp)
        if due.odom and self._tf.get_num_connections():
            self._tf.publish(packed.transforms(robot.transforms()))
        robot.apply_command()
        self._turtle.drive(self._guided.wish())
        if self._ticks >= self._landed:
            self._turtle.hold_pen(self._pen())
        self._report()

    def _next_stamp(self) -> rospy.Time:
        """The stamp of this tick.

        In real time, this is the time of the wall clock. In simulated time, it counts the poses, since /clock and poses
        arrive separately. If /clock runs backward or is far ahead, turtlesim was started again or poses were lost: then
        the stamp is that of /clock.
        """
        now, before = rospy.Time.now(), self._clock
        self._clock = now
        if rospy.rostime.is_wallclock():
            return max(now, self._stamp)
        counted = self._stamp.to_nsec() + FRAME_NS
        if now < before or now.to_nsec() - counted > MAX_LAG:
            return now
        return rospy.Time(*divmod(counted, 1_000_000_000))

    def _pen(self) -> Pen:
        robot, colour = self._guided.robot, self._settings.pen
        width = colour.width or max(round(robot.config.brush.width * PIXELS_PER_METRE), 1)
        return colour.red, colour.green, colour.blue, min(width, 255), robot.brushes_up or robot.battery.charge <= 0.0

    # --- what others ask ----------------------------------------------------------------------------------------------

    def _teleport(self, pose: Pose) -> None:
        def take_off() -> Tuple[Pose, Pen]:
            target = self._guided.check(pose)
            self._landed = math.inf
            return target, self._pen()

        def land() -> None:
            self._landed = self._ticks + LANDING

        target, pen = self._requests.call(take_off)
        try:
            self._turtle.teleport(target, pen)
        finally:
            self._requests.post(land)

    def _reset(self) -> str:
        pose = self._guided.robot.pose
        self._guided.reset()
        self._guided.jump(pose)
        self._turtle.clear()
        self._state.resets += 1
        self._state.publish(self._ticks, self._stamp)
        self._state.resets += 1
        self._state.publish(self._ticks, self._stamp)
        return 'the floor is dirty, and the battery is charged as at the start; the turtle stays where it is'


class TurtleNode(RobotNode):
    """A robot with a turtle as its body."""

    def __init__(self, world: World, name: str, requests: Requests, has_localisation: bool, stamp: rospy.Time,
                 teleport: Any) -> None:
        """Open the topics and services of a robot without a laser; `teleport` moves the turtle to a pose."""
        self._put = teleport
        super().__init__(world, name, requests, has_localisation, stamp, has_laser=False)

    def _teleport(self, pose: Pose) -> None:
        self._put(pose)
