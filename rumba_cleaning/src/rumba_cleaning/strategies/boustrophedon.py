"""boustrophedon: plans on the map, then drives in lanes, to and fro, as an ox ploughs."""

import enum
from concurrent.futures import Future
from typing import NamedTuple, Optional

from rumba_cleaning.behaviour import STOP, Behaviour, Command, Observation
from rumba_cleaning.behaviours import standstill
from rumba_cleaning.behaviours.detour import detour
from rumba_cleaning.behaviours.impasse import Impasse
from rumba_cleaning.behaviours.lull import Lull
from rumba_cleaning.behaviours.travel import LONGEST, Going, Travel
from rumba_cleaning.belief.context import Context
from rumba_cleaning.outcome import Outcome
from rumba_cleaning.route import Ahead, Relief, Route
from rumba_cleaning.strategies import strategy
from rumba_sim.model.common.geometry import Pose, hypot

WORTH = 0.0005  # of coverage: a round that gains less, and less than half of what was missing, is the last: a round for
#                 the last spots gains little more
DEAR = 150.0  # [m/m^2] that a round drives for what it gains, beyond which it is the last beside obstacles, or on a map
#               that does not grow once the rounds after the longest are longer than that: five times what the planner
#               drives for a crumb, so most of what it planned for cannot be reached, or the robot cannot keep to its
#               lanes in a corridor that is hardly wider
HELPED = 0.01  # of coverage: a retry that gained less was in vain: to touch all obstacles again takes long
# Rounds that gain too little, since something unknown in the way ends them, one after the other, after which no other
# is planned, and so many while less than this share is swept of what lies beside all obstacles that are known. As many
# retries may be in vain while obstacles keep the robot from much of the floor; else one is.
VAIN, PATIENT, MUCH = 1, 5, 0.9
CHECK = 5.0  # [s]: more often takes more computing, less often drives on in vain
TOO_LITTLE = 'another round would gain too little'
PAUSE = 20.0  # [s] after the first of these times, twice that after the second ...: who stands there may walk on
MORE = 1.15  # times an equal share for a robot that several mates plan after: they drive farther for what others leave;
#              our choice, by the apartment with three docks, where 1.1 gains nothing, and 1.2 less
TURN = 20.0  # [s] that a mate may take to plan, before it is the turn of the robot all the same; our choice
ROUNDS = 20  # at most, each with what was missed before: far more than the maps of rumba_sim need


class Retry(enum.Enum):
    """Why a plan may succeed where the last one did not."""

    NONE = 'it is the next round, not another try'
    FORGOT_DOUBTFUL = 'the obstacles that may go again are forgotten'
    FORGOT_BARRING = 'those that were met more than once, but bar the way to much of the floor, are forgotten too'


class Planned(NamedTuple):
    """What was planned."""

    route: Optional[Route]
    squeezes: bool = False  # past obstacles, through gaps as narrow as the robot
    retry: Retry = Retry.NONE
    relief: Optional[Relief] = None  # what it takes over from a mate


@strategy('boustrophedon', needs_map=True)
class Boustrophedon(Behaviour):
    """Cleans what was missed, round by round, until a round gains nothing more.

    Then it forgets the obstacles that it met once, since they may be gone, as long as that helps. With mates, each
    plans in its turn for what nobody has planned, and takes its share of that.
    """

    _planning: 'Optional[Future[Planned]]' = None
    _travel: Optional[Travel] = None
    _plan = 0  # number of the plan
    _rest: Optional[Route] = None  # of the route that a detour leads back to; None while a round is planned

    def __init__(self, context: Context) -> None:
        """Clean the floor plan of a context."""
        self._context = context

    def initialise(self) -> None:
        """Begin with a plan for what was missed so far."""
        self._drop_plan()
        self._travel = None
        self._rest = None
        self._relief: Optional[Relief] = None  # what the plan takes over from a mate
        self._waited = 0.0  # [s] for the turn to plan
        self._rounds = 0
        self._tried_at = -1.0  # coverage at the last retry
        self._idle = 0  # rounds, one after the other, that gained too little
        self._vain = 0  # retries, one after the other, that did not help
        self._most = 0.0  # coverage of what lies beside obstacles, at most: those that are forgotten still stand there
        self._pause = 0.0  # [s] still to wait
        self._before = -1.0  # coverage when the round began
        self._missing = 1.0  # of coverage to the target then
        self._reason = ''  # why this round is the last, if there is nothing to drive
        self._driven = 0.0  # [m] since then
        # [m] driven in the longest round, and after it; a dear one for the last spots does not count as the longest.
        self._longest = self._after = 0.0
        self._last: Optional[Pose] = None  # where the robot was
        self._unchecked = 0.0  # [s] since it was last checked whether all beside obstacles is swept
        self._impasse, self._standstill, self._lull = Impasse(), standstill.Standstill(), Lull()
        self._brushes_up = True

    def update(self, observation: Observation) -> Command:
        """Follow the plan, once there is one."""
        pose, last = observation.pose, self._last
        self._driven += 0.0 if last is None else hypot(pose.x - last.x, pose.y - last.y)
        self._last = pose
        self._lull.watch(self._context.swept.coverage, min(observation.dt, LONGEST))
        self._leave_to_mate()
        if self._travel is None:
            if self._planning is None:
                if self._is_turn_of_mate(observation.dt):
                    return self._wait()
                self._plan_round(observation.pose)
            self._take_plan(observation.pose)
            if self._travel is None:
                if self._planning is not None or self._rest is not None:
                    return self._wait()
                return self.succeed(self._reason)
        if self._pause > 0.0:
            self._pause -= observation.dt
            self.message = 'waiting for what is in the way'
            return self._wait()
        self._standstill.watch(pose, min(observation.dt, LONGEST))
        if self._standstill.is_hopeless:
            return self.fail(f'stuck: has not got away from one place for {standstill.LONGEST:g} s', Outcome.BLOCKED)
        self._unchecked += observation.dt
        if self._unchecked > CHECK and (self._context.ground.has_lasting or self._context.swept.has_straits):
            self._unchecked = 0.0
            if self._context.is_all_swept(pose):
                return self.succeed('nothing more can be reached')
            if self._is_in_vain(pose):
                return self.succeed(TOO_LITTLE)
        self._brushes_up = False
        command = self._travel.command(observation, self._brushes_up)
        self.message = f'{self._travel.remaining:.0f} m of the plan to go'
        if self._travel.going is not Going.ON:
            self._leave_route(self._travel, observation.pose)
        return command if self._travel is not None else self._wait()

    def terminate(self) -> None:
        """Ignore what is being planned."""
        self._drop_plan()

    def plan_ahead(self) -> Optional[Ahead]:
        """Its route; while a detour is planned, what that leads back to."""
        if self._travel is not None:
            route, remaining = self._travel.route, self._travel.remaining
        elif self._rest is not None:
            route, remaining = self._rest, self._rest.length
        else:
            return None
        return Ahead(route, remaining, self._plan, self._relief)

    # --- planning -------------------------------------------------------------------------------------------------

    def _is_turn_of_mate(self, dt: float) -> bool:
        """Whether a mate that comes before plans, and it is worth waiting for its plan."""
        self._waited = self._waited + dt if self._context.mates.plan_before else 0.0
        self.message = 'waiting for the plan of another robot'
        return 0.0 < self._waited < TURN

    def _plan_round(self, pose: Pose) -> None:
        """Plan for what was missed, unless another round is not worth it; then forget what may have gone."""
        context = self._context
        context.learn(pose)
        coverage = context.swept.coverage
        gain = coverage - self._before
        is_dear = self._driven > DEAR * gain * context.swept.reachable_area
        if self._driven > self._longest and not (is_dear and coverage > MUCH):
            self._longest, self._after = self._driven, 0.0
        else:
            self._after += self._driven
        has_marks, is_long = context.ground.has_marks, self._after > self._longest and context.survey is None
        is_gain = gain > min(WORTH, 0.5 * self._missing) and not (is_dear and (has_marks or is_long))
        self._idle = 0 if is_gain else self._idle + 1
        self._missing = context.target_coverage - coverage
        self._most = max(self._most, context.beside_obstacles(pose).coverage)
        may_open = has_marks or not is_long
        patience = PATIENT if may_open and context.beside_marks(pose).coverage <= MUCH else VAIN
        is_worth = self._rounds < ROUNDS and self._idle < patience
        is_swept = self._most >= context.target_coverage  # but for what lies behind obstacles
        self._reason = 'nothing more can be reached' if is_worth or is_swept else TOO_LITTLE
        waits = self._vain < PATIENT and (self._most <= MUCH or context.is_shut_in(pose))
        may_retry = context.ground.has_marks and (waits or not is_swept and self._has_helped(coverage))
        self._before, self._driven = coverage, 0.0
        self._rounds += 1
        self._rest = None
        self._planning = context.submit(_round, pose, is_worth, may_retry)

    def _is_in_vain(self, pose: Pose) -> bool:
        """Whether a round after one in vain, or another try, gains hardly anything beside obstacles either."""
        context, is_extra = self._context, self._idle > 0 or self._tried_at >= 0.0
        return (is_extra and self._lull.is_long and context.ground.has_marks
                and context.beside_obstacles(pose).coverage > MUCH and not context.is_shut_in(pose))

    def _has_helped(self, coverage: float) -> bool:
        """Whether the last retry helped, if there was one."""
        return coverage > self._tried_at + HELPED

    def _leave_route(self, travel: Travel, pose: Pose) -> None:
        """Plan the way back onto the route if the robot had to leave it."""
        self._travel = None
        self._rest = None if travel.going is Going.ARRIVED else travel.rest()
        if travel.going is Going.BLOCKED:
            self._impasse.stop(self._context, pose)
        if self._rest is not None:
            self._planning = self._context.submit(_detour, pose, self._rest)
            self._take_plan(pose)

    def _take_plan(self, pose: Pose) -> None:
        """Follow what was planned for a pose, if that is done."""
        if self._planning is None or not self._planning.done():
            return
        planned, self._planning = self._planning.result(), None
        if self._rest is None:
            self._plan, self._relief = self._plan + 1, planned.relief
        if planned.squeezes:
            self._context.ground.squeeze(True)
        if planned.retry is not Retry.NONE:
            self._vain = 0 if self._has_helped(self._before) else self._vain + 1
            self._pause = PAUSE * self._vain
            self._tried_at = self._before
            if planned.retry is Retry.FORGOT_BARRING:
                self._context.forget_barring(pose)
            elif planned.retry is Retry.FORGOT_DOUBTFUL:
                self._context.forget_doubtful()
        self._travel = None if planned.route is None else Travel(self._context, planned.route)

    def _leave_to_mate(self) -> None:
        """Leave the end of the plan to a mate that drives it."""
        mates = self._context.mates
        length = mates.relief(mates.name, self._plan)
        ahead = self.plan_ahead()
        if length > 0.0 and ahead is not None:
            self._plan += 1
            route = ahead.without_end(length)
            self._drop_plan()
            self._rest = None
            self._travel = None if route is None else Travel(self._context, route)

    def _drop_plan(self) -> None:
        if self._planning is not None:
            self._planning.cancel()
            self._planning = None

    def _wait(self) -> Command:
        if self._planning is not None:
            self.message = 'planning'
        return STOP._replace(brushes_up=self._brushes_up)


def plan(context: Context, pose: Pose, end: Optional[Pose] = None) -> Optional[Route]:
    """As `planner.plan`, which is imported here, where nobody waits: otherwise a cleaner would take longer to start."""
    from rumba_cleaning.planning import planner
    return planner.plan(context, pose, end)


def _round(context: Context, pose: Pose, is_worth: bool, may_retry: bool) -> Planned:
    """A route that cleans what was missed; if there is none, one without the obstacles that may have gone."""
    from rumba_cleaning.planning.team import helping, sharing  # here for the same reason
    context.ground.keep_off(context.config.margin)
    missing = context.target_coverage - context.beside_marks(pose).coverage
    is_met = missing <= (HELPED if context.ground.has_doubtful and may_retry else 0.0)  # a retry sweeps the rest too
    sharing.leave_to_mates(context)
    route = _own_part(context, pose) if is_worth and not is_met else None
    if route is not None:
        return Planned(route)
    help_for_mate = helping.help_mate(context, pose)
    if help_for_mate is not None:
        return Planned(help_for_mate[0], relief=help_for_mate[1])
    if context.is_all_swept(pose):
        return Planned(None)
    if context.may_squeeze(pose):
        context.ground.squeeze(True)
        route = _own_part(context, pose)
        if route is not None:
            return Planned(route, squeezes=True)
    retry = _retry(context, context.is_cut_off(pose)) if may_retry else Retry.NONE
    if retry is Retry.NONE:
        return Planned(None)
    if retry is Retry.FORGOT_BARRING:
        context.ground.forget_barring(pose.x, pose.y)
    elif retry is Retry.FORGOT_DOUBTFUL:
        context.ground.forget_doubtful()
    return Planned(_own_part(context, pose), retry=retry)


def _retry(context: Context, is_cut_off: bool) -> Retry:
    """What another try may rest on."""
    if is_cut_off:
        return Retry.FORGOT_BARRING
    return Retry.FORGOT_DOUBTFUL if context.ground.has_doubtful else Retry.NONE


def _own_part(context: Context, pose: Pose) -> Optional[Route]:
    """A route that cleans the robot's share of what was missed; what is near mates that need work is left to them."""
    others = context.mates.seeking
    farthest = max(others, key=lambda other: hypot(other.x - pose.x, other.y - pose.y), default=None)
    if context.swept.has_straits and not context.ground.has_marks:
        part = context.beside_marks(pose)
        context = context.with_target(
            context.swept.coverage + (context.target_coverage - part.coverage) * part.share)
    route = plan(context, pose, farthest)
    if route is None or not others:
        return route
    return route.beginning((MORE if len(others) > 1 else 1.0) / (1 + len(others)))


def _detour(context: Context, pose: Pose, rest: Route) -> Planned:
    """A route around the obstacles that were met, onto the rest of another one."""
    return Planned(detour(context, pose, rest))
