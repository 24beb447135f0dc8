"""One robot, as the cleaner senses, moves and announces it."""

from typing import Callable

from rumba_cleaning.ros.cleaner.actuators import Brushes, Wheels
from rumba_cleaning.ros.cleaner.announcer import Announcer
from rumba_cleaning.ros.cleaner.senses import Senses
from rumba_cleaning.ros.cleaner.teleop import Teleop


class Robot:
    """The topics and services of one robot.

    Attributes:
        announcer: tells what the robot does.
        teleop: whether a person drives it.
        wheels: drive it.
        brushes: its brushes.
        senses: what it senses.
    """

    def __init__(self, name: str, on_reading: Callable[[], None]) -> None:
        """Connect to a robot, by its name; `on_reading` is called in a thread of rospy."""
        self.announcer = Announcer(name)
        self.teleop = Teleop(name)
        self.wheels = Wheels(name)
        self.brushes = Brushes(name)
        self.senses = Senses(name, on_reading)

    def rest(self) -> None:
        """Stop, with the brushes up."""
        self.wheels.stop()
        if not self.senses.is_alone:  # else there is nobody to lift them
            self.brushes.want(are_up=True)
