"""One robot, as the cleaner senses, moves and announces it."""

from typing import Callable, Optional, Sequence, Tuple

import rospy

from rumba_cleaning.ros.cleaner.robots.actuators import Brushes, Wheels
from rumba_cleaning.ros.cleaner.robots.announcer import Announcer
from rumba_cleaning.ros.cleaner.robots.location import TF
from rumba_cleaning.ros.cleaner.robots.own_senses import OwnSenses
from rumba_cleaning.ros.cleaner.robots.plan_topic import PlanTopic
from rumba_cleaning.ros.cleaner.robots.senses import TOPICS, Senses
from rumba_cleaning.ros.cleaner.robots.team import Team
from rumba_cleaning.ros.cleaner.robots.teleop import Teleop
from rumba_sim.model.settings.own_robot import OwnRobot
from rumba_sim.ros.running.shared_reception import share
from rumba_sim.ros.participants.lockstep import TOPIC as TICKS
from rumba_sim.ros.participants.lockstep import Participant


class Robot:
    """The topics and services of one robot.

    Attributes:
        announcer: tells what the robot does.
        plan: shows where it plans to drive.
        teleop: whether a person drives it.
        wheels: drive it.
        brushes: its brushes.
        senses: what it senses.
        team: the robots with which it shares its floor.
        participant: the part that this node takes in that of the simulator, if there is one.
    """

    def __init__(self, name: str, on_reading: Callable[[], None], team: Sequence[str] = (),
                 on_news: Callable[[], None] = lambda: None,
                 lockstep: Callable[[], Optional[Tuple[str, int]]] = lambda: None,
                 is_busy: Callable[[], bool] = lambda: False, has_laser: bool = False,
                 is_mapless: bool = False, own: Optional[OwnRobot] = None, docks: bool = False) -> None:
        """Connect to a robot.

        Args:
            name: its name.
            on_reading: called after each complete reading, in a thread of rospy.
            team, on_news: as for `Team`.
            lockstep, has_laser, is_mapless: as for `Senses`.
            is_busy: as for `Participant`.
            own: what it is like if it is not ours.
            docks: whether it docks by itself.
        """
        share(*map(rospy.resolve_name, (*(f'{name}/{topic}' for topic in TOPICS), TF, TICKS)))
        self.announcer = Announcer(name)
        self.plan = PlanTopic(name)
        self.teleop = Teleop(name)
        self.wheels = Wheels(name, docks)
        self.brushes = Brushes(name, are_optional=own is not None)
        self.team = Team(name, team, on_news)
        self.senses = (Senses(name, on_reading, lockstep, has_laser, is_mapless) if own is None
                       else OwnSenses(name, on_reading, own, has_laser))
        self.participant = Participant(self.senses.on_tick, is_busy)
        self._lockstep = lockstep

    def answer(self, rests: bool) -> None:
        """In lockstep, tell that everything is done for the newest reading, and whether there is nothing more to do."""
        if self._lockstep() is not None and self.senses.stamp is not None:
            self.brushes.settle()
            self.participant.answer(self.senses.stamp, self.wheels.commanded(), rests)

    def look_after(self) -> None:
        """Have no world wait if nothing can be sensed: the robot was removed, or its simulator has ended."""
        if self.senses.is_alone:
            self.participant.leave()

    def rest(self) -> None:
        """Stop, with the brushes up."""
        self.wheels.stop()
        if not self.senses.is_alone:  # else there is nobody to lift them
            self.brushes.want(are_up=True)
