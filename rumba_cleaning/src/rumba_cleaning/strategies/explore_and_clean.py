"""explore_and_clean: goes where known floor ends until it knows all of it, and cleans what it knows."""

from concurrent.futures import Future
from typing import List, Optional

import numpy as np

from rumba_cleaning.behaviour import STOP, Behaviour, Command, Observation, Status
from rumba_cleaning.behaviours.travel import Going, Travel
from rumba_cleaning.belief.context import Context
from rumba_cleaning.route import Ahead, Route
from rumba_cleaning.strategies import strategy
from rumba_cleaning.strategies.boustrophedon import Boustrophedon
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.kernel import Array

LOOK = 2.0  # [s] of driving, after which the robot plans again: in that it drives a metre
NEAR = 0.3  # [m] from a frontier the robot has seen what is behind it


@strategy('explore_and_clean', needs_map=True)
class ExploreAndClean(Behaviour):
    """Explores, then cleans; when a plan was cleaned, what was found meanwhile is explored and cleaned too.

    On a floor plan that is known from the start it does as boustrophedon.
    """

    _planning: 'Optional[Future[Optional[Route]]]' = None
    _travel: Optional[Travel] = None
    _is_exploring = False

    def __init__(self, context: Context) -> None:
        """Explore and clean the floor of a context."""
        self._context = context
        self._cleaning = Boustrophedon(context)

    def initialise(self) -> None:
        """Begin with a look at what is known."""
        self._drop_plan()
        self._travel = None
        self._goal: Optional[Array] = None  # (2) [m]
        self._driven = 0.0  # [s] since the plan
        self._seen: List[Array] = []  # frontiers at which the robot was
        self._is_exploring = self._context.survey is not None

    def update(self, observation: Observation) -> Command:
        """Explore until nothing is left to be explored, then clean; what is found on the way is explored after that."""
        if self._is_exploring:
            return self._explore(observation)
        command = self._cleaning.step(observation)
        self.message = self._cleaning.message
        if self._cleaning.status is Status.RUNNING:
            return command
        if self._cleaning.status is Status.SUCCEEDED and self._context.learn(observation.pose):
            self._cleaning.restart()
            self._is_exploring = True
            return STOP._replace(brushes_up=False)
        end = self.succeed if self._cleaning.status is Status.SUCCEEDED else self.fail
        return end(self._cleaning.message, self._cleaning.outcome)

    def terminate(self) -> None:
        """Stop what is under way."""
        self._drop_plan()
        self._cleaning.stop()

    def take_note(self, observation: Observation) -> None:
        """Plan again, wherever the robot will be."""
        self._drop_plan()
        self._travel = None
        self._cleaning.stand_by(observation)

    def plan_ahead(self) -> Optional[Ahead]:
        """The route to a frontier, or to clean."""
        if not self._is_exploring:
            return self._cleaning.plan_ahead()
        return None if self._travel is None else self._travel.ahead

    # --- exploring ------------------------------------------------------------------------------------------------

    def _explore(self, observation: Observation) -> Command:
        """Drive to the nearest frontier, and plan again on the way, since it moves as the robot sees more."""
        self.message = 'exploring'
        if self._travel is None or self._driven >= LOOK:
            self._plan(observation.pose)
        if self._planning is not None and self._planning.done():
            self._take(self._planning.result())
        if self._travel is None:
            return STOP
        self._driven += observation.dt
        command = self._travel.command(observation, brushes_up=True)
        if self._travel.going is Going.ON:
            return command
        self._note_seen(observation.pose)
        self._travel = None
        return STOP

    def _plan(self, pose: Pose) -> None:
        if self._planning is None:
            self._note_seen(pose)
            self._context.learn(pose)
            self._planning = self._context.submit(_plan, pose, list(self._seen))

    def _take(self, route: Optional[Route]) -> None:
        self._planning, self._driven = None, 0.0
        self._is_exploring = route is not None
        self._travel = None if route is None else Travel(self._context, route)
        self._goal = None if route is None else route.waypoints[-1]

    def _note_seen(self, pose: Pose) -> None:
        """Remember a frontier at which the robot is, so that it does not go there again."""
        if self._goal is not None and np.hypot(*(self._goal - pose[:2])) < NEAR:
            self._seen.append(self._goal)

    def _drop_plan(self) -> None:
        if self._planning is not None:
            self._planning.cancel()
            self._planning = None


def _plan(context: Context, pose: Pose, seen: List[Array]) -> Optional[Route]:
    """As `frontiers.route_to_frontier`, which is imported here, where nobody waits."""
    from rumba_cleaning.strategies import frontiers
    return frontiers.route_to_frontier(context, pose, seen)
