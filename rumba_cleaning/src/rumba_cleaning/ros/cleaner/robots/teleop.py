"""Whether a person drives the robot."""

import math
import time

import rospy
from geometry_msgs.msg import Twist

from rumba_sim.ros.common import teleop


class Teleop:
    """Listens to the commands of a person, which go before those of the cleaner."""

    def __init__(self, robot: str) -> None:
        """Listen to those for a robot, by its name."""
        self._newest = -math.inf  # when a command came last, as a time of `time.monotonic`
        rospy.Subscriber(f'{robot}/{teleop.TOPIC}', Twist, self._on_command, queue_size=1)

    def _on_command(self, _: Twist) -> None:
        self._newest = time.monotonic()

    @property
    def is_driving(self) -> bool:
        """Whether the newest command still counts."""
        return time.monotonic() - self._newest < teleop.TIMEOUT
