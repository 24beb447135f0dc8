"""One turtle of a running turtlesim: its topics and services."""

import itertools
import queue
import threading
from typing import Any, Callable, List, Optional, Tuple

import rospy
from geometry_msgs.msg import Twist as TwistMessage
from geometry_msgs.msg import Vector3
from std_srvs.srv import Empty

from rumba_sim.model.common.errors import ConfigError, WorldError
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.simulation.robot import Twist
from rumba_sim.ros.running import peers

try:
    from turtlesim.msg import Pose as PoseMessage
    from turtlesim.srv import SetPen, TeleportAbsolute
except ImportError:  # an error only if a turtle is needed: --help works without turtlesim
    PoseMessage = None

REMINDER = 15  # [frames] after which an unchanged command is sent again: turtlesim stops the turtle after 1 s
COMPLAINT_PERIOD = 10.0  # [s]
POSE = '/pose'
STILL = Twist(0.0, 0.0)
Pen = Tuple[int, int, int, int, bool]  # red, green, blue [0..255], width [pixels], whether it is up


class Turtle(rospy.SubscribeListener):
    """Drives a turtle and sets its pen; turtle and turtlesim may end and start again."""

    def __init__(self, name: str, on_pose: Callable[[Any], object]) -> None:
        """Listen to a turtle, given by its name; `on_pose` is called with each turtlesim/Pose in a thread of rospy.

        Raises:
            ConfigError: turtlesim is not installed.
        """
        if PoseMessage is None:
            raise ConfigError('the messages of turtlesim are missing: install turtlesim (ROS One and ROS Noetic: '
                              'ros-one-turtlesim, ros-noetic-turtlesim), or build compat/turtlesim of this repository')
        self._name = name
        self._command = STILL
        self._reminder = 0
        self._pen: Optional[Pen] = None  # that the turtle has; None: unknown
        self._calls: 'queue.Queue[Callable[[], Any]]' = queue.Queue()
        threading.Thread(target=self._serve, daemon=True).start()
        self._publisher = rospy.Publisher(f'{name}/cmd_vel', TwistMessage, self, queue_size=1)
        self._poses = rospy.Subscriber(f'{name}{POSE}', PoseMessage, on_pose, tcp_nodelay=True)

    @property
    def pose_topic(self) -> str:
        """The full name of the topic with its poses."""
        name: str = self._poses.resolved_name
        return name

    @property
    def is_heard(self) -> bool:
        """Whether a node publishes its poses."""
        return bool(self._poses.get_num_connections())

    def peer_subscribe(self, *_: Any) -> None:
        """There is a new subscriber of the commands: it may be a new turtle with another pen."""
        self._pen = None
        self._reminder = 0

    def drive(self, twist: Twist) -> None:
        """Have the turtle drive; to be called in each frame. While it rests, other nodes can drive the turtle."""
        self._reminder -= 1
        if twist == self._command and (twist == STILL or self._reminder > 0):
            return
        self._command, self._reminder = twist, REMINDER
        self._publisher.publish(Vector3(twist.v, 0.0, 0.0), Vector3(0.0, 0.0, twist.w))

    def hold_pen(self, pen: Pen) -> None:
        """Set the pen of the turtle, unless it has this pen already; returns at once."""
        if pen != self._pen:
            self._pen = pen
            self._calls.put(lambda: _call(f'{self._name}/set_pen', SetPen, *pen))

    def forget_pen(self) -> None:
        """Set the pen again at the next opportunity: it may have changed."""
        self._pen = None

    def teleport(self, pose: Pose, pen: Pen) -> None:
        """Move the turtle to a pose without drawing a line: the pen is lifted until the next `hold_pen`.

        Raises:
            WorldError: turtlesim does not answer.
        """
        lifted = *pen[:4], True
        try:
            _call(f'{self._name}/set_pen', SetPen, *lifted)
            self._pen = lifted
            _call(f'{self._name}/teleport_absolute', TeleportAbsolute, *pose)
        except (rospy.ServiceException, rospy.ROSException) as error:
            raise WorldError(f'{rospy.resolve_name(self._name)}: {error}') from None

    def clear(self) -> None:
        """Delete all lines of turtlesim; returns at once."""
        self._calls.put(lambda: _call('clear', Empty))

    def _serve(self) -> None:
        """Call services; in a thread, since a call takes longer than a frame."""
        while not rospy.is_shutdown():
            call = self._calls.get()
            try:
                call()
            except (rospy.ServiceException, rospy.ROSException) as error:
                self.forget_pen()
                rospy.logwarn_throttle(COMPLAINT_PERIOD, f'turtlesim does not answer: {error}')


def turtles() -> List[str]:
    """The names of all turtles whose node answers; none if the master does not.

    The master still knows the topics of a turtlesim that was killed.
    """
    try:
        topics = [topic for topic, kind in rospy.get_published_topics()
                  if kind == 'turtlesim/Pose' and topic.endswith(POSE)]
        nodes = {topic: peers.publishers(topic) for topic in topics}
    except (rospy.ROSException, *peers.NO_ANSWER):
        return []
    alive = {node for node in set(itertools.chain(*nodes.values())) if peers.is_alive(node)}
    return sorted(topic[:-len(POSE)] for topic in topics if alive.intersection(nodes[topic]))


def _call(service: str, kind: Any, *arguments: Any) -> None:
    rospy.wait_for_service(service, peers.ANSWER_TIMEOUT)
    rospy.ServiceProxy(service, kind)(*arguments)
