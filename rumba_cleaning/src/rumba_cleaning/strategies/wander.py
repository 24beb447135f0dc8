"""wander: spirals, straight lines and walls in turn, as the early Roombas did: it needs neither map nor position."""

from typing import Optional

from rumba_cleaning.behaviour import Behaviour, Command, Observation, Status
from rumba_cleaning.belief.context import Context
from rumba_cleaning.strategies import strategy
from rumba_cleaning.strategies.bounce import bounce
from rumba_cleaning.strategies.spiral import Spiral
from rumba_cleaning.strategies.wall_follow import WallFollow
from rumba_sim.model.common.geometry import Pose, hypot

# The figures are our choice; bench/mapless.py shows what they bring.
LINES, WALLS = 40.0, 25.0  # [s] of straight lines, and along walls, before the other one has its turn
ROOMY = 3.0  # [m] straight ahead without a touch: there is space for a spiral ...
SPARSE = 120.0  # [s] ... if the last one was so long ago


@strategy('wander')
class Wander(Behaviour):
    """Begins with a spiral; it never ends by itself."""

    def __init__(self, context: Context, spirals: bool = True) -> None:
        """Wander about the floor of a context; without spirals, it covers ground faster, to look for something."""
        self._lines, self._walls = bounce(context), WallFollow(context)
        self._spiral = Spiral(context) if spirals else None

    def initialise(self) -> None:
        """Begin with a spiral, if there are to be any."""
        self._last: Optional[Pose] = None
        self._ahead = 0.0  # [m] since the last touch
        self._since_spiral = 0.0  # [s]
        self._time = 0.0  # [s] of what it does
        self._begin(self._spiral or self._lines)

    def update(self, observation: Observation) -> Command:
        """Go on with what is under way, or begin with what comes next."""
        self._measure(observation)
        following = self._next()
        if following is not None:
            self._part.stop()
            self._begin(following)
        return self._part.step(observation)

    def terminate(self) -> None:
        """Stop what is under way."""
        self._part.stop()

    def take_note(self, observation: Observation) -> None:
        """Go on wherever the robot will be."""
        self._last = None
        self._part.stand_by(observation)

    def _begin(self, part: Behaviour) -> None:
        self._part, self._time, self._ahead = part, 0.0, 0.0
        part.restart()

    def _measure(self, observation: Observation) -> None:
        pose, last = observation.pose, self._last or observation.pose
        self._last = pose
        self._time += observation.dt
        self._since_spiral = 0.0 if self._part is self._spiral else self._since_spiral + observation.dt
        self._ahead += hypot(pose.x - last.x, pose.y - last.y)
        if any(observation.contact):
            self._ahead = 0.0

    def _next(self) -> Optional[Behaviour]:
        """What follows now on what is under way; None: nothing yet."""
        if self._part is self._lines:
            if self._spiral is not None and self._ahead > ROOMY and self._since_spiral > SPARSE:
                return self._spiral
            return self._walls if self._time > LINES else None
        if self._part is self._walls:
            return self._lines if self._time > WALLS or self._walls.status is not Status.RUNNING else None
        return self._lines if self._part.status is not Status.RUNNING else None
