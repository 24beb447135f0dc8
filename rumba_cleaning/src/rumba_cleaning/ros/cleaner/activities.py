"""What the cleaner does with a goal of each of its actions, and what it tells of it."""

import abc
import math
from typing import Any, Optional

from rumba_cleaning.behaviour import Behaviour
from rumba_cleaning.behaviours.bounded import Bounded
from rumba_cleaning.behaviours.dock import Dock
from rumba_cleaning.behaviours.go_to import GoTo
from rumba_cleaning.behaviours.undock import Undock
from rumba_cleaning.belief.context import Context
from rumba_cleaning.mission.mission import Mission, State
from rumba_cleaning.ros.cleaner import conversions
from rumba_cleaning.ros.cleaner.go_to_position import check_finite
from rumba_cleaning.ros.cleaner.senses import Senses
from rumba_msg.msg import (CleanAction, CleanFeedback, CleaningStatus, CleanResult, DockAction, DockFeedback,
                           DockResult, GoToAction, GoToFeedback, GoToResult, MissionStatus, UndockAction,
                           UndockFeedback, UndockResult)
from rumba_sim.model.errors import ConfigError
from rumba_sim.model.geometry import Pose

NOWHERE = Pose(math.nan, math.nan, math.nan)


class Activity(abc.ABC):
    """A goal on its way.

    Attributes:
        action: type of the action.
        behaviour: what the robot does; it ends in time.
        strategy: name of the cleaning strategy; empty where none is in use.
        needs_figures: whether the result wants a CleaningStatus that is newer than the end.
    """

    action: Any = None
    strategy = ''
    needs_figures = False

    def __init__(self, behaviour: Behaviour, time_limit: float, usual_limit: float) -> None:
        """Give a behaviour the time [s] that its goal allows, where it names any.

        Raises:
            ConfigError: the time limit is none.
        """
        if not (math.isfinite(time_limit) and time_limit >= 0.0):
            raise ConfigError(f'time_limit is {time_limit}: must be a finite number, 0 or more [s]')
        self.behaviour = Bounded(behaviour, time_limit or usual_limit)

    @property
    @abc.abstractmethod
    def state(self) -> State:
        """What the robot is at."""

    @abc.abstractmethod
    def feedback(self, senses: Senses, mission: MissionStatus) -> Any:
        """How far it is."""

    @staticmethod
    @abc.abstractmethod
    def result(senses: Senses, message: str) -> Any:
        """How it ended, or why it never began."""

    def report(self, before: Optional[CleaningStatus], after: Optional[CleaningStatus]) -> str:
        """What a person may want to know at the end, by the state of the floor before and after."""
        return ''


class Cleaning(Activity):
    """A whole mission."""

    action = CleanAction
    needs_figures = True

    def __init__(self, context: Context, goal: Any) -> None:
        """Begin with a floor of which nothing is swept.

        Raises:
            StrategyError: there is no strategy of this name.
            ConfigError: the target or the time limit is out of its range.
        """
        config = context.config
        target = config.target_coverage if goal.target_coverage == 0.0 else goal.target_coverage
        self._mission = Mission(context, goal.strategy or config.strategy, target)
        self.strategy = self._mission.strategy
        super().__init__(self._mission, goal.time_limit, config.time_limit.clean)

    @property
    def state(self) -> State:
        """What the mission is at."""
        return self._mission.state

    def feedback(self, senses: Senses, mission: MissionStatus) -> CleanFeedback:
        """The mission, and the floor."""
        return CleanFeedback(mission, senses.cleaning or conversions.no_cleaning_status())

    @staticmethod
    def result(senses: Senses, message: str) -> CleanResult:
        """The floor at the end."""
        return CleanResult(senses.cleaning or conversions.no_cleaning_status(), message)

    def report(self, before: Optional[CleaningStatus], after: Optional[CleaningStatus]) -> str:
        """What it cost."""
        charges = f'{self._mission.charges} charge{"" if self._mission.charges == 1 else "s"}'
        if before is None or after is None:
            return f', {charges}'
        driven = max(after.distance - before.distance, 0.0)  # the world may have been reset
        return f', {driven:.1f} m, {charges}; the floor is {100.0 * after.coverage:.1f} % clean'


class Docking(Activity):
    """Home, and onto the contacts."""

    action = DockAction

    def __init__(self, context: Context, goal: Any) -> None:
        """Begin with looking for the beams.

        Raises:
            MapError: the plan has no dock, or the robot fits nowhere before it.
            ConfigError: the time limit is none.
        """
        self._dock = Dock(context)
        super().__init__(self._dock, goal.time_limit, context.config.time_limit.dock)

    @property
    def state(self) -> State:
        """By the beams, or on the way there."""
        return State.DOCKING if self._dock.is_homing else State.RETURNING

    def feedback(self, senses: Senses, mission: MissionStatus) -> DockFeedback:
        """What is seen of the dock."""
        seen = senses.look()
        return DockFeedback(seen is not None and any(seen.infrared), self._dock.remaining)

    @staticmethod
    def result(senses: Senses, message: str) -> DockResult:
        """Whether it is there."""
        return DockResult(_is_docked(senses), message)


class Undocking(Activity):
    """Off the dock."""

    action = UndockAction

    def __init__(self, context: Context, goal: Any) -> None:
        """Begin with the way backward.

        Raises:
            ConfigError: the time limit is none.
        """
        self._undock = Undock(context)
        super().__init__(self._undock, goal.time_limit, context.config.time_limit.undock)

    @property
    def state(self) -> State:
        """One thing only."""
        return State.UNDOCKING

    def feedback(self, senses: Senses, mission: MissionStatus) -> UndockFeedback:
        """The way left."""
        return UndockFeedback(self._undock.remaining)

    @staticmethod
    def result(senses: Senses, message: str) -> UndockResult:
        """Whether it is off."""
        return UndockResult(_is_docked(senses), message)


class GoingTo(Activity):
    """To a pose."""

    action = GoToAction

    def __init__(self, context: Context, goal: Any) -> None:
        """Begin with looking for a way.

        Raises:
            MapError: the target is no place for the robot.
            ConfigError: the time limit is none.
        """
        target = Pose(goal.target.x, goal.target.y, goal.target.theta)
        check_finite(target, may_face_anywhere=True)
        self._go_to = GoTo(context, target)
        super().__init__(self._go_to, goal.time_limit, context.config.time_limit.go_to)

    @property
    def state(self) -> State:
        """One thing only."""
        return State.GOING_TO

    def feedback(self, senses: Senses, mission: MissionStatus) -> GoToFeedback:
        """Where it is, and the way left."""
        return GoToFeedback(conversions.pose_message(senses.pose() or NOWHERE), self._go_to.remaining)

    @staticmethod
    def result(senses: Senses, message: str) -> GoToResult:
        """Where it stands."""
        return GoToResult(conversions.pose_message(senses.pose() or NOWHERE), message)


def _is_docked(senses: Senses) -> bool:
    seen = senses.look()
    return seen is not None and seen.is_docked


ACTIVITIES = {'clean': Cleaning, 'dock': Docking, 'undock': Undocking, 'go_to': GoingTo}  # by the name of the action
