"""What the cleaner does for a goal of each of its actions, and what its feedback and its result say."""

import abc
import math
from typing import Any, Callable, Dict, NamedTuple, Optional, Union

from rumba_cleaning.behaviour import Behaviour, Status
from rumba_cleaning.behaviours.bounded import Bounded
from rumba_cleaning.behaviours.dock import Dock
from rumba_cleaning.behaviours.go_to import GoTo
from rumba_cleaning.behaviours.undock import Undock
from rumba_cleaning.belief.context import Context
from rumba_cleaning.belief.mates import Report, Task
from rumba_cleaning.mission.duration import longest
from rumba_cleaning.mission.mapless import MaplessMission
from rumba_cleaning.mission.mission import Mission
from rumba_cleaning.mission.returning import ReturningMission
from rumba_cleaning.mission.seek import Seek
from rumba_cleaning.mission.stages import StagedMission, State
from rumba_cleaning.ros.cleaner.goals.go_to_position import check_finite
from rumba_cleaning.ros.cleaner.robots import conversions
from rumba_cleaning.ros.cleaner.robots.senses import Senses
from rumba_msg.msg import (CleanAction, CleanFeedback, CleaningStatus, CleanResult, DockAction, DockFeedback,
                           DockResult, GoToAction, GoToFeedback, GoToResult, MissionStatus, Outcome, UndockAction,
                           UndockFeedback, UndockResult)
from rumba_sim.model.common.errors import ConfigError, MapError
from rumba_sim.model.common.geometry import Pose

UNKNOWN_POSE = Pose(math.nan, math.nan, math.nan)


class Activity(abc.ABC):
    """What the robot does for one goal.

    Attributes:
        behaviour: what decides on the robot's commands; it ends by itself, at the latest at its time limit.
        strategy: name of the cleaning strategy; empty if none is in use.
        needs_figures: whether the result needs a CleaningStatus that is newer than the end.
    """

    strategy = ''
    needs_figures = False

    def __init__(self, behaviour: Behaviour, time_limit: float, default_limit: float,
                 context: Optional[Context] = None) -> None:
        """Give a behaviour the time limit [s] of its goal, or the default if that is 0; the context as to `Bounded`.

        Raises:
            ConfigError: the time limit is negative or not finite.
        """
        if not (math.isfinite(time_limit) and time_limit >= 0.0):
            raise ConfigError(f'time_limit is {time_limit}: must be a finite number, 0 or more [s]')
        self._context = context
        self.behaviour = Bounded(behaviour, time_limit or default_limit, context)

    def begin(self) -> None:
        """Called once, after the activity before was terminated."""

    def begin_again(self) -> None:
        """Forget what was done, and do all of it in another world, with all the time of its limit."""
        self.behaviour.restart()

    def hear(self, name: str, report: Report) -> None:
        """Take note of what a mate of the robot tells."""
        if self._context is not None:
            self._context.hear(name, report)

    def for_mates(self, pose: Pose) -> Optional[Report]:
        """What the mates of the robot, which is at a pose, need to know: it goes where a client wants it, or stands."""
        if self.behaviour.status is not Status.RUNNING:
            return Report(pose, True, Task.OFF)
        return Report(pose, True, Task.DOCKING, self.behaviour.plan_ahead())

    @property
    @abc.abstractmethod
    def state(self) -> State:
        """What the robot does now."""

    @abc.abstractmethod
    def feedback(self, senses: Senses, mission: MissionStatus) -> Any:
        """The feedback message of the action."""

    @staticmethod
    @abc.abstractmethod
    def result(senses: Senses, outcome: Outcome) -> Any:
        """The result message of the action."""

    def report(self, before: Optional[CleaningStatus], after: Optional[CleaningStatus]) -> str:
        """What else the log says at the end, from the state of the floor before and after."""
        return ''


class Cleaning(Activity):
    """A mission, or the rest of one that was interrupted."""

    needs_figures = True

    def __init__(self, mission: StagedMission, time_limit: float, default_limit: float,
                 is_resumed: bool = False) -> None:
        """Carry out a mission; if `is_resumed` is true, go on with what it knows of the swept floor.

        Raises:
            ConfigError: the time limit is negative or not finite.
        """
        self._mission = mission
        self._default_limit = default_limit
        self._is_resumed = is_resumed
        self.strategy = mission.strategy
        super().__init__(mission, time_limit, default_limit)

    @classmethod
    def of_goal(cls, context: Context, goal: Any) -> 'Cleaning':
        """A new mission as a goal asks for it, with the defaults of the context for what the goal leaves open.

        Raises:
            StrategyError: there is no strategy of this name, or it needs a map and there is none.
            ConfigError: the target or the time limit is out of its range, or there is a target and no map.
        """
        config = context.config
        strategy, target = goal.strategy or config.strategy, goal.target_coverage or config.target_coverage
        if context.has_map:
            mission = (Mission if context.has_dock else ReturningMission)(context, strategy, target)
            return cls(mission, goal.time_limit, longest(context))
        if goal.target_coverage:
            raise ConfigError(f'target_coverage is {target:g}: must be 0, since a robot without a map does not know '
                              f'what share is swept; it cleans for {config.cleaning_time:g} s')
        return cls(MaplessMission(context, strategy), goal.time_limit, config.time_limit.clean)

    def resumed(self, time_limit: float) -> 'Cleaning':
        """The rest of this mission, under a time limit of its own.

        Raises:
            ConfigError: the time limit is negative or not finite.
        """
        return Cleaning(self._mission, time_limit, self._default_limit, is_resumed=True)

    def begin(self) -> None:
        """Have an interrupted mission go on."""
        if self._is_resumed:
            self._mission.resume()

    def begin_again(self) -> None:
        """Clean a floor of which nothing is swept."""
        self._mission.forget()
        super().begin_again()

    def hear(self, name: str, report: Report) -> None:
        """Have the mission hear it, also while it is interrupted."""
        self._mission.hear(name, report)

    def for_mates(self, pose: Pose) -> Optional[Report]:
        """What the mission tells."""
        return self._mission.report()

    @property
    def state(self) -> State:
        """The state of the mission."""
        return self._mission.state

    def feedback(self, senses: Senses, mission: MissionStatus) -> CleanFeedback:
        """The mission and the floor."""
        return CleanFeedback(mission, senses.cleaning or conversions.no_cleaning_status())

    @staticmethod
    def result(senses: Senses, outcome: Outcome) -> CleanResult:
        """The floor at the end."""
        return CleanResult(senses.cleaning or conversions.no_cleaning_status(), outcome)

    def report(self, before: Optional[CleaningStatus], after: Optional[CleaningStatus]) -> str:
        """Distance and charges; how much is swept follows in the message of the outcome."""
        charges = f'{self._mission.charges} charge{"" if self._mission.charges == 1 else "s"}'
        if before is None or after is None:
            return f', {charges}'
        driven = max(after.distance - before.distance, 0.0)  # the world may have been reset
        return f', {driven:.1f} m, {charges}'


class Docking(Activity):
    """To the dock, and onto its contacts."""

    def __init__(self, context: Context, goal: Any) -> None:
        """Prepare to dock.

        Raises:
            MapError: the plan has no dock, or the robot does not fit in front of it.
            ConfigError: the time limit is negative or not finite.
        """
        self._dock: Union[Dock, Seek] = Dock(context) if context.has_map else Seek(context)
        super().__init__(self._dock, goal.time_limit, context.config.time_limit.dock, context)

    @property
    def state(self) -> State:
        """DOCKING while the beams guide it, RETURNING before."""
        return State.DOCKING if self._dock.is_homing else State.RETURNING

    def feedback(self, senses: Senses, mission: MissionStatus) -> DockFeedback:
        """Whether beams are seen, and the distance left."""
        seen = senses.look()
        return DockFeedback(seen is not None and any(seen.infrared), self._dock.remaining)

    @staticmethod
    def result(senses: Senses, outcome: Outcome) -> DockResult:
        """Whether the robot is docked."""
        return DockResult(_is_docked(senses), outcome)


class Undocking(Activity):
    """Off the dock."""

    def __init__(self, context: Context, goal: Any) -> None:
        """Prepare to undock.

        Raises:
            ConfigError: the time limit is negative or not finite.
        """
        self._undock = Undock(context)
        super().__init__(self._undock, goal.time_limit, context.config.time_limit.undock, context)

    @property
    def state(self) -> State:
        """Always UNDOCKING."""
        return State.UNDOCKING

    def feedback(self, senses: Senses, mission: MissionStatus) -> UndockFeedback:
        """The distance left to drive backward."""
        return UndockFeedback(self._undock.remaining)

    @staticmethod
    def result(senses: Senses, outcome: Outcome) -> UndockResult:
        """Whether the robot is docked."""
        return UndockResult(_is_docked(senses), outcome)


class GoingTo(Activity):
    """To a pose."""

    def __init__(self, context: Context, goal: Any) -> None:
        """Prepare to go there.

        Raises:
            MapError: the robot cannot stand at the target, or has no map.
            ConfigError: the time limit is negative or not finite.
        """
        if not context.has_map:
            raise MapError('go_to needs a map, and this cleaner works without one (parameter mapless)')
        target = Pose(goal.target.x, goal.target.y, goal.target.theta)
        check_finite(target, may_face_anywhere=True)
        self._go_to = GoTo(context, target)
        super().__init__(self._go_to, goal.time_limit, context.config.time_limit.go_to, context)

    @property
    def state(self) -> State:
        """Always GOING_TO."""
        return State.GOING_TO

    def feedback(self, senses: Senses, mission: MissionStatus) -> GoToFeedback:
        """The pose, and the distance left."""
        return GoToFeedback(conversions.pose_message(senses.pose() or UNKNOWN_POSE), self._go_to.remaining)

    @staticmethod
    def result(senses: Senses, outcome: Outcome) -> GoToResult:
        """The pose at the end."""
        return GoToResult(conversions.pose_message(senses.pose() or UNKNOWN_POSE), outcome)


def _is_docked(senses: Senses) -> bool:
    seen = senses.look()
    return seen is not None and seen.is_docked


class Action(NamedTuple):
    """What belongs to an action."""

    type: Any  # of rumba_msg
    activity: Callable[[Context, Any], Activity]  # made of a goal; raises RumbaError if it cannot be carried out
    result: Callable[[Senses, Outcome], Any]  # the message, also of a goal for which there never was an activity


ACTIONS: Dict[str, Action] = {
    'clean': Action(CleanAction, Cleaning.of_goal, Cleaning.result),
    'dock': Action(DockAction, Docking, Docking.result),
    'undock': Action(UndockAction, Undocking, Undocking.result),
    'go_to': Action(GoToAction, GoingTo, GoingTo.result)}
