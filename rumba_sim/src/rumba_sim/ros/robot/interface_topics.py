"""The topics and frames by which another robot is known, of a robot of a world."""

import functools
import importlib
from typing import Any, Callable, Dict, List, Optional

import rospy
from geometry_msgs.msg import TransformStamped
from std_msgs.msg import Header

from rumba_sim.model.common.errors import ConfigError
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.kernel import Array
from rumba_sim.model.settings.interfaces import AT_SCAN, COMMAND, CREATE, INTERFACES, Topic, is_due
from rumba_sim.model.simulation.world import World
from rumba_sim.ros.common.conversions import transform
from rumba_sim.ros.common.frames import frames, prefix
from rumba_sim.ros.participants.requests import Requests
from rumba_sim.ros.robot.create_body import CreateBody
from rumba_sim.ros.robot.interface_messages import MAKERS, Reading
from rumba_sim.ros.robot.latecomers import Latecomers
from rumba_sim.ros.robot.packed import OdometryPacker

QUEUE = 100  # messages that a subscriber may be behind, at speed 0 too, before it misses one


class InterfaceTopics:
    """Publishers and subscribers of an interface; only `publish` and `note_scan` read the world.

    Attributes:
        commands: the subscriber of velocities.
    """

    def __init__(self, interface: str, world: World, name: str, requests: Requests, is_held: Callable[[], bool],
                 on_command: Callable[[Any, str, bool], None], drive: Callable[[float, float], None]) -> None:
        """Open the topics.

        Args:
            interface: its name.
            world: where the robot is.
            name: of the robot.
            requests: to the owner of the world.
            is_held: whether the world waits for those who come late: they are sent what they have missed.
            on_command: called with each velocity, the full name of its topic and whether the robot obeys it, in a
                thread of rospy.
            drive: has the robot drive at a velocity [m/s, rad/s]; called by `publish`.

        Raises:
            ConfigError: a message of the interface is not installed.
        """
        self._interface = INTERFACES[interface]
        self._world = world
        self._name = name
        self._is_held = is_held
        self._on_command = on_command
        self._body = CreateBody(world, name, requests, drive) if interface == CREATE else None
        self._makers = {**MAKERS, **({} if self._body is None else self._body.makers())}
        self._before = prefix(name)  # of frames
        self._below = f'{name}/{interface}/' if self._before else ''  # of topics: below the name are those of Rumba
        odom, child = (self._before + frame for frame in ('odom', self._interface.odometry_child))
        self._odometry = OdometryPacker(odom, child)
        self._ranges: Optional[Array] = None  # of the newest scan
        self._period = 0.0  # [s] of scans
        self._newest: Dict[str, Callable[[], Any]] = {}  # makes a message of a topic
        self._publishers = {
            topic.name: rospy.Publisher(
                self._below + topic.name, message_class(topic.type, interface),
                Latecomers(requests, functools.partial(self._missed, topic.name),
                           functools.partial(self._newest.get, topic.name)), queue_size=QUEUE)
            for topic in self._interface.topics}
        inputs = dict(self._interface.inputs)
        self.commands = rospy.Subscriber(self._below + COMMAND, message_class(inputs.pop(COMMAND), interface),
                                         self._on_velocity, queue_size=1)
        self._subscribers = [self.commands] + [
            rospy.Subscriber(self._below + topic, message_class(kind, interface), self._on_input, topic, queue_size=10)
            for topic, kind in inputs.items()]

    def close(self) -> None:
        """Close the topics."""
        for topic in (*self._subscribers, *self._publishers.values()):
            topic.unregister()

    def _on_velocity(self, twist: Any) -> None:
        self._on_command(twist, self.commands.resolved_name, self._body is None or not self._body.is_passive)

    def _on_input(self, message: Any, topic: str) -> None:
        if self._body is not None:
            self._body.obey(message, topic)

    def note_scan(self, ranges: Array, period: float) -> None:
        """The laser has measured these ranges (beams) [m]; it does so each `period` [s]."""
        self._ranges, self._period = ranges, period

    def publish(self, stamp: rospy.Time) -> None:
        """Publish what is due at the present tick."""
        if self._body is not None:
            self._body.step()
        for topic in self._interface.topics:
            if self._is_due(topic):
                self._tell(topic, stamp)
        self._ranges = None

    def _is_due(self, topic: Topic) -> bool:
        if topic.rate == AT_SCAN:
            return self._ranges is not None
        return is_due(topic.rate, self._world.tick, int(self._world.step_rate))

    def _tell(self, topic: Topic, stamp: rospy.Time) -> None:
        """Make and publish a message if somebody listens: most of the cost is in making it."""
        header = Header(stamp=stamp, frame_id=self._before + topic.frame if topic.frame else '')
        make = functools.partial(self._message, topic.name, header, self._ranges)
        self._newest[topic.name] = make
        publisher = self._publishers[topic.name]
        if publisher.get_num_connections():
            message = make()
            if message is not None:
                publisher.publish(message)

    def _message(self, topic: str, header: Header, ranges: Optional[Array]) -> Any:
        return self._makers[topic](Reading(self._interface, self._world, self._world.robots[self._name], header,
                                           self._odometry, ranges, self._period))

    def _missed(self, topic: str) -> Any:
        """What a new subscriber of a topic is sent."""
        return self._newest[topic]() if topic in self._newest and self._is_held() else None

    def static_transforms(self, laser: TransformStamped) -> List[TransformStamped]:
        """The frames that the interface adds to a robot whose laser is mounted as a transform tells."""
        parts, stamp, base = [], laser.header.stamp, frames(self._name).base_link
        frame = self._before + self._interface.laser_frame
        if self._interface.laser_frame and frame != laser.child_frame_id:
            parts.append(TransformStamped(laser.header, frame, laser.transform))
        return parts + [transform(base, self._before + each, Pose(0.0, 0.0, 0.0), stamp)
                        for each in self._interface.frames]


def message_class(kind: str, interface: str) -> Any:
    """The class of a message, given as `package/Message`.

    Raises:
        ConfigError: its package is not installed.
    """
    package, name = kind.split('/')
    try:
        return getattr(importlib.import_module(f'{package}.msg'), name)
    except ImportError:
        raise ConfigError(f'interface is {interface}, but there is no package {package}: ./rumba builds a stand-in; in '
                          f'another workspace, link compat/{package} of Rumba into its src and build it') from None
