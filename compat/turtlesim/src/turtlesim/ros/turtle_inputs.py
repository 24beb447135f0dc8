"""The topic that a turtle subscribes to and the services that it serves, below its name."""

from typing import Any, Callable, List, Tuple

import rospy
from geometry_msgs.msg import Twist

from turtlesim.model.canvas import Pen
from turtlesim.model.errors import TurtlesimError
from turtlesim.model.field import Field, topics
from turtlesim.model.turtles import check_numbers
from turtlesim.ros.requests import Requests
from turtlesim.srv import (SetPen, SetPenResponse, TeleportAbsolute, TeleportAbsoluteResponse, TeleportRelative,
                           TeleportRelativeResponse)

COMPLAINT_PERIOD = 1.0  # [s]


class TurtleInputs:
    """The command topic and the services of one turtle."""

    def __init__(self, name: str, field: Field, requests: Requests,
                 command: Callable[[Tuple[str, List[float]]], None]) -> None:
        """Open topic and services.

        Args:
            name: name of the turtle.
            field: the field with the turtle; only functions that `requests` calls touch it.
            requests: passes calls to the loop that owns the field.
            command: called with a pair: the name, and a velocity forward, to the left [m/s], counter-clockwise [rad/s].
        """
        self._name = name
        self._field = field
        self._requests = requests
        self._command = command
        prefix = topics(name)
        self._subscriber = rospy.Subscriber(f'{prefix}cmd_vel', Twist, self._on_command, queue_size=1, tcp_nodelay=True)
        self._services = [
            rospy.Service(f'{prefix}set_pen', SetPen, self._on_pen),
            rospy.Service(f'{prefix}teleport_absolute', TeleportAbsolute, self._on_absolute),
            rospy.Service(f'{prefix}teleport_relative', TeleportRelative, self._on_relative)]

    def close(self) -> None:
        """Close topic and services."""
        for service in self._services:
            service.shutdown('the turtle is gone')
        self._subscriber.unregister()

    def _on_command(self, twist: Twist) -> None:
        velocity = [twist.linear.x, twist.linear.y, twist.angular.z]
        try:
            check_numbers(f'{self._name}/cmd_vel', **dict(zip(('linear.x', 'linear.y', 'angular.z'), velocity)))
        except TurtlesimError as error:
            rospy.logerr_throttle(COMPLAINT_PERIOD, f'{error}; ignored')
        else:
            self._command((self._name, velocity))

    def _on_pen(self, request: Any) -> SetPenResponse:
        pen = Pen((request.r, request.g, request.b), max(1, request.width), not request.off)
        answered(self._requests.call, lambda: self._field.set_pen(self._name, pen))
        return SetPenResponse()

    def _on_absolute(self, request: Any) -> TeleportAbsoluteResponse:
        answered(self._requests.call,
                 lambda: self._field.teleport(self._name, request.x, request.y, request.theta))
        return TeleportAbsoluteResponse()

    def _on_relative(self, request: Any) -> TeleportRelativeResponse:
        answered(self._requests.call,
                 lambda: self._field.teleport_relative(self._name, request.linear, request.angular))
        return TeleportRelativeResponse()


def answered(function: Callable[..., Any], *arguments: Any) -> Any:
    """Call a function for a service and return its result.

    Raises:
        rospy.ServiceException: the function raised a TurtlesimError, which is logged; the call of the client fails.
    """
    try:
        return function(*arguments)
    except TurtlesimError as error:
        rospy.logerr(str(error))
        raise rospy.ServiceException(str(error)) from error
