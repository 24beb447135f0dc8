"""One robot, as the cleaner senses, moves and announces it."""

from typing import Callable, Optional

from rumba_cleaning.ros.cleaner.actuators import Brushes, Wheels
from rumba_cleaning.ros.cleaner.announcer import Announcer
from rumba_cleaning.ros.cleaner.senses import Senses
from rumba_cleaning.ros.cleaner.teleop import Teleop
from rumba_sim.ros.common.lockstep import Participant


class Robot:
    """The topics and services of one robot.

    Attributes:
        announcer: tells what the robot does.
        teleop: whether a person drives it.
        wheels: drive it.
        brushes: its brushes.
        senses: what it senses.
        lockstep: the part that this node takes in that of the simulator, if there is one.
    """

    def __init__(self, name: str, on_reading: Callable[[], None],
                 resets: Callable[[], Optional[int]] = lambda: None) -> None:
        """Connect to a robot.

        Args:
            name: its name.
            on_reading: called after each complete reading, in a thread of rospy.
            resets: as for `Senses`.
        """
        self.announcer = Announcer(name)
        self.teleop = Teleop(name)
        self.wheels = Wheels(name)
        self.brushes = Brushes(name)
        self.senses = Senses(name, on_reading, resets)
        self.lockstep = Participant(self.senses.on_tick)
        self._resets = resets

    def answer(self) -> None:
        """In lockstep, tell that everything is done for the newest reading."""
        if self._resets() is not None and self.senses.stamp is not None:
            self.brushes.settle()
            self.lockstep.answer(self.senses.stamp, self.wheels.commanded())

    def rest(self) -> None:
        """Stop, with the brushes up."""
        self.wheels.stop()
        if not self.senses.is_alone:  # else there is nobody to lift them
            self.brushes.want(are_up=True)
