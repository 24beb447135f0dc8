"""One turtle of a running turtlesim: its topics and services."""

import queue
import threading
from typing import Any, Callable, Optional, Tuple

import rospy
from geometry_msgs.msg import Twist as TwistMessage
from geometry_msgs.msg import Vector3
from std_srvs.srv import Empty

from rumba_sim.model.errors import ConfigError, WorldError
from rumba_sim.model.geometry import Pose
from rumba_sim.model.robot import Twist

try:
    from turtlesim.msg import Pose as PoseMessage
    from turtlesim.srv import SetPen, TeleportAbsolute
except ImportError:  # told when somebody wants a turtle, not when somebody asks for help
    PoseMessage = None

REMINDER = 15  # frames after which a command that stays is told again: turtlesim forgets it after 1 s
PATIENCE = 2.0  # [s] with a turtlesim that does not answer
COMPLAINT_PERIOD = 10.0  # [s]
STILL = Twist(0.0, 0.0)
Pen = Tuple[int, int, int, int, bool]  # red, green, blue [0..255], width [pixels], whether it is up


class Turtle(rospy.SubscribeListener):
    """Drives a turtle and holds its pen; turtle and turtlesim may come and go."""

    def __init__(self, name: str, on_pose: Callable[[Any], None]) -> None:
        """Listen to a turtle, by its name; `on_pose` is called with each turtlesim/Pose in a thread of rospy.

        Raises:
            ConfigError: turtlesim is not installed.
        """
        if PoseMessage is None:
            raise ConfigError("turtlesim's messages are not here: install turtlesim (ROS Noetic: "
                              'ros-noetic-turtlesim), or build compat/turtlesim of this repository')
        self._name = name
        self._command = STILL
        self._reminder = 0
        self._pen: Optional[Pen] = None  # as the turtle has it; None: unknown
        self._wishes: 'queue.Queue[Callable[[], Any]]' = queue.Queue()
        threading.Thread(target=self._serve, daemon=True).start()
        self._publisher = rospy.Publisher(f'{name}/cmd_vel', TwistMessage, self, queue_size=1)
        rospy.Subscriber(f'{name}/pose', PoseMessage, on_pose, tcp_nodelay=True)

    def peer_subscribe(self, *_: Any) -> None:
        """Somebody obeys: a new turtle, it may be, with a pen of its own."""
        self._pen = None
        self._reminder = 0

    def drive(self, twist: Twist) -> None:
        """Have the turtle drive; to be called each frame. A turtle at rest is left to whoever else drives it."""
        self._reminder -= 1
        if twist == self._command and (twist == STILL or self._reminder > 0):
            return
        self._command, self._reminder = twist, REMINDER
        self._publisher.publish(Vector3(twist.v, 0.0, 0.0), Vector3(0.0, 0.0, twist.w))

    def hold_pen(self, pen: Pen) -> None:
        """Have the turtle hold a pen, if it does not yet; returns at once."""
        if pen != self._pen:
            self._pen = pen
            self._wishes.put(lambda: _call(f'{self._name}/set_pen', SetPen, *pen))

    def forget_pen(self) -> None:
        """Somebody may have changed the pen."""
        self._pen = None

    def teleport(self, pose: Pose, pen: Pen) -> None:
        """Put the turtle elsewhere, without drawing the way: the pen is lifted, until `hold_pen` is asked anew.

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
        """Have turtlesim forget all lines; returns at once."""
        self._wishes.put(lambda: _call('clear', Empty))

    def _serve(self) -> None:
        """A call takes longer than a frame: a thread makes them."""
        while not rospy.is_shutdown():
            wish = self._wishes.get()
            try:
                wish()
            except (rospy.ServiceException, rospy.ROSException) as error:
                self.forget_pen()
                rospy.logwarn_throttle(COMPLAINT_PERIOD, f'turtlesim does not answer: {error}')


def _call(service: str, kind: Any, *arguments: Any) -> None:
    rospy.wait_for_service(service, PATIENCE)
    rospy.ServiceProxy(service, kind)(*arguments)
