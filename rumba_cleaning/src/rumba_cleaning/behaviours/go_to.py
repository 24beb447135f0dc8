"""go_to: to a pose, around what is in the way."""

import enum
import math
from concurrent.futures import Future
from typing import Optional, Tuple

import numpy as np

from rumba_cleaning.behaviour import STOP, Behaviour, Command, Observation
from rumba_cleaning.behaviours.follower import Turn
from rumba_cleaning.behaviours.impasse import Impasse
from rumba_cleaning.behaviours.travel import Going, Travel
from rumba_cleaning.belief import paths
from rumba_cleaning.belief.context import Context
from rumba_cleaning.outcome import Outcome
from rumba_cleaning.route import Ahead, Route
from rumba_sim.model.common.geometry import Pose, hypot
from rumba_sim.model.kernel import Array

PAUSE = 5.0  # [s] before it tries again what was closed: who stands in the way may walk on; our choice
TRIES = 30  # times that it may find something unknown in the way, or rest beside the target; our choice
CLOSE = 0.02  # [m] from the target at which the robot rests, at most, as docs/interfaces.md says


class Needs(enum.Enum):
    """What a path needs beyond the open floor."""

    NOTHING = 'nothing'
    SQUEEZING = 'squeezing past obstacles'
    FORGETTING_DOUBTFUL = 'that the obstacles are gone that may go again'
    FORGETTING_ALL = 'that all obstacles are gone that the robot met'


Found = Tuple[Optional[Array], Needs]  # a path, if there is one


class GoTo(Behaviour):
    """Drives to a pose with the brushes up."""

    _travel: Optional[Travel] = None
    _turn: Optional[Turn] = None  # at the end
    _search: 'Optional[Future[Found]]' = None

    def __init__(self, context: Context, target: Pose) -> None:
        """Go to a target [m, rad], map frame; if theta is NaN, the robot may face anywhere at the end.

        Raises:
            MapError: the robot does not fit there, or it lies outside the map.
        """
        context.plan.check_pose(target, context.robot.drive.radius, 'target')
        self._context = context
        self._target = target

    def initialise(self) -> None:
        """Begin with the search for a path."""
        self._leave()
        self._tries = 0
        self._pause = 0.0  # [s] still to wait
        self._impasse = Impasse()

    @property
    def remaining(self) -> float:
        """Distance left to the target [m]; NaN if no path is known yet."""
        return self._travel.remaining if self._travel is not None else math.nan

    def update(self, observation: Observation) -> Command:
        """Follow the path, then turn."""
        if self._turn is not None:
            return self._turned(self._turn, observation)
        if self._travel is None:
            self._travel = self._found(observation.pose)
            if self._travel is None:
                return STOP
        if self._pause > 0.0:
            self._pause -= observation.dt
            self.message = 'waiting for what is in the way'
            return STOP
        command = self._travel.command(observation, brushes_up=True)
        if self._travel.going is Going.ARRIVED:
            any_heading = math.isnan(self._target.theta)
            self._turn = Turn(observation.pose.theta if any_heading else self._target.theta, self._context.robot.drive)
        elif self._travel.going is not Going.ON:
            if self._travel.going is Going.BLOCKED:
                self._impasse.stop(self._context, observation.pose)
            return self._try_again(command)
        self.message = f'{self.remaining:.1f} m to go'
        return command

    def terminate(self) -> None:
        """Drop the search for a path."""
        self._drop_search()
        self._context.ground.squeeze(False)

    def take_note(self, observation: Observation) -> None:
        """Look for a path again, from wherever the robot will be."""
        self._leave()

    def plan_ahead(self) -> Optional[Ahead]:
        """The route to the target."""
        return None if self._travel is None else self._travel.ahead

    def _leave(self) -> None:
        """Drop the path, or the search for it."""
        self._travel = self._turn = None
        self._drop_search()

    def _drop_search(self) -> None:
        if self._search is not None:
            self._search.cancel()
            self._search = None

    def _found(self, pose: Pose) -> Optional[Travel]:
        """A travel to the target; None while the search for a path goes on, and if there is none."""
        if self._search is None:
            self._search = self._context.submit(_search, pose, self._target)
        if not self._search.done():
            self.message = 'planning'
            return None
        path, needs = self._search.result()
        self._search = None
        if needs is Needs.SQUEEZING:
            self._context.ground.squeeze(True)
        elif needs is Needs.FORGETTING_DOUBTFUL:
            self._context.forget_doubtful()
        elif needs is Needs.FORGETTING_ALL:
            self._context.forget_obstacles()
        if needs in (Needs.FORGETTING_DOUBTFUL, Needs.FORGETTING_ALL):
            self._pause = PAUSE
        if path is None:
            target = self._target
            self.fail(f'no path from ({pose.x:.2f}, {pose.y:.2f}) to ({target.x:.2f}, {target.y:.2f}) m',
                      Outcome.NO_PATH)
            return None
        return Travel(self._context, Route(path, np.full(len(path) - 1, self._context.config.transit_speed)))

    def _turned(self, turn: Turn, observation: Observation) -> Command:
        """Turn to the heading; if the robot is off the target then, go back: commands came late, or it was pushed."""
        pose = observation.pose
        rate = turn.rate(pose, observation.dt)
        if not turn.is_done:
            return Command(0.0, rate, brushes_up=True)
        if hypot(pose.x - self._target.x, pose.y - self._target.y) > CLOSE:
            return self._try_again(STOP)
        return self.succeed(f'at ({pose.x:.2f}, {pose.y:.2f}) m')

    def _try_again(self, meanwhile: Command) -> Command:
        self._leave()
        self._tries += 1
        if self._tries > TRIES:
            return self.fail(f'after {TRIES} attempts something is still in the way', Outcome.BLOCKED)
        return meanwhile


def _search(context: Context, pose: Pose, target: Pose) -> Found:
    """A path to a target; if obstacles close every path, squeezing past them, or else as if there were fewer."""
    ground, ends = context.ground, np.array([pose[:2], target[:2]])
    path = paths.between(ground, *ends)
    if path is not None or not ground.has_marks:
        return path, Needs.NOTHING
    ground.squeeze(True)
    path = paths.between(ground, *ends)
    if path is not None:
        return path, Needs.SQUEEZING
    ground.squeeze(False)
    ground.forget_doubtful()
    path = paths.between(ground, *ends)
    if path is not None:
        return path, Needs.FORGETTING_DOUBTFUL
    ground.forget()
    return paths.between(ground, *ends), Needs.FORGETTING_ALL
