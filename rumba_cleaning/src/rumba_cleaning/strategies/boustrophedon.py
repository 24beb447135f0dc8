"""boustrophedon: plans on the map, then drives in lanes, to and fro, as an ox ploughs."""

from typing import Optional

from rumba_cleaning.behaviour import STOP, Behaviour, Command, Observation
from rumba_cleaning.behaviours.detour import detour
from rumba_cleaning.behaviours.follower import Route
from rumba_cleaning.behaviours.travel import Going, Travel
from rumba_cleaning.belief.context import Context
from rumba_cleaning.planning.planner import plan
from rumba_cleaning.strategies import strategy
from rumba_sim.model.geometry import Pose

WORTH = 0.002  # of coverage: a round that gains less is the last
ROUNDS = 20  # with what was missed in the round before


@strategy('boustrophedon')
class Boustrophedon(Behaviour):
    """Cleans what was missed, round by round, until a round gains nothing more.

    Obstacles that were met are forgotten then, since they may be gone, as long as that helps.
    """

    def __init__(self, context: Context) -> None:
        """Clean the floor plan of a context."""
        self._context = context
        self.initialise()

    def initialise(self) -> None:
        """Begin with a plan for what was missed so far."""
        super().initialise()
        self._travel: Optional[Travel] = None
        self._rounds = 0
        self._forgot_at = -1.0  # coverage when obstacles that were met were forgotten
        self._before = -1.0  # coverage when the round began

    def update(self, observation: Observation) -> Command:
        """Along the plan."""
        if self._travel is None:
            route = self._next_round(observation.pose)
            if route is None:
                return self.succeed('what can be reached is swept')
            self._travel = Travel(self._context, route)
        command = self._travel.update(observation, brushes_up=False)
        self.message = f'{self._travel.remaining:.0f} m of the plan to go'
        if self._travel.going is Going.BLOCKED:
            rest = self._travel.rest()
            around = None if rest is None else detour(self._context, observation.pose, rest)
            self._travel = None if around is None else Travel(self._context, around)
        elif self._travel.going is not Going.ON:
            self._travel = None
        return command if self._travel is not None else STOP._replace(brushes_up=False)

    def _next_round(self, pose: Pose) -> Optional[Route]:
        """A plan for what was missed; None where another round is not worth it."""
        coverage = self._context.swept.coverage
        is_worth = coverage > self._before + WORTH and self._rounds < ROUNDS
        self._before = coverage
        self._rounds += 1
        route = plan(self._context, pose) if is_worth else None
        if route is None and self._context.ground.has_marks and coverage > self._forgot_at + WORTH:
            self._forgot_at = coverage
            self._context.ground.forget()
            route = plan(self._context, pose)
        return route
