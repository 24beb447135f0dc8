"""A whole mission: undock, clean, return when the battery runs low, charge, go on, and return at the end."""

import math
from typing import Optional, Tuple

import numpy as np

from rumba_cleaning import strategies
from rumba_cleaning.behaviour import CERTAIN, STOP, Command, Observation, Status
from rumba_cleaning.behaviours import relocation
from rumba_cleaning.behaviours.dock import Dock
from rumba_cleaning.behaviours.right_of_way import RightOfWay
from rumba_cleaning.behaviours.undock import Undock
from rumba_cleaning.belief.context import Context
from rumba_cleaning.belief.mates import Report, Task
from rumba_cleaning.edges.guard import Guard
from rumba_cleaning.mission import confinement
from rumba_cleaning.mission.battery_watch import BatteryWatch
from rumba_cleaning.mission.second_try import SecondTry
from rumba_cleaning.mission.stages import EMPTY, HELD, START, StagedMission, State
from rumba_cleaning.mission.wording import percent, swept
from rumba_cleaning.outcome import Outcome
from rumba_sim.model.common.errors import ConfigError
from rumba_sim.model.common.geometry import Pose, hypot

JUMP = 0.5  # [m] from one observation to the next: the robot did not drive there, somebody moved it; as in `Swept`
EXACT = 0.0002  # of coverage beyond the target: by so much the account of a robot may differ from the truth
INEXACT = 0.0008  # the same by a pose that is not certain: twice what an error of 2 mm brings, as localiser's
GAIN = 0.002  # of coverage: a charge that brings less brings nothing; as boustrophedon judges its rounds
VAIN = 3  # charges, one after the other, that brought nothing: the mission is given up; our choice
HOMES = 2  # attempts to return to the dock, each with the tries of `Dock`; our choice
WAITING = 'waiting for other robots, which clean the rest'


class Mission(StagedMission):
    """Cleans a floor until its target is met, with as many charges as it takes."""

    _last: Optional[Pose] = None

    def __init__(self, context: Context, strategy: str, target_coverage: float) -> None:
        """Clean with a strategy until a share of the reachable floor is swept [0..1]; the context stays as it is.

        The mission shares ground and swept floor with the context, and forgets what they hold when it begins.

        Raises:
            StrategyError: there is no strategy of this name.
            ConfigError: the target is not within 0..1.
        """
        if not 0.0 <= target_coverage <= 1.0:
            raise ConfigError(f'target_coverage is {target_coverage}: must be 0 to 1')
        self._context = context.with_target(target_coverage)
        self._cleaning = strategies.make(strategy, self._context)
        self._guard = Guard(self._context)
        self._relocation = relocation.Relocation(self._context)
        self._right_of_way = RightOfWay(self._context)
        self.strategy = strategy

    def initialise(self) -> None:
        """Begin with a floor that is not swept, unless the mission is resumed."""
        self._rest()
        self._last = None
        self._brushes_up = self._had_brushes_up = True  # now, and on the way to the last pose
        self._waits = False  # for mates that may leave something to it
        self._homes = 0  # failed attempts to return to the dock
        self._second_try = SecondTry(self._context)
        self._confinement = confinement.Confinement()
        self._vain = 0  # charges that brought little, one after the other
        self._is_undisturbed = True  # nobody drove or moved the robot since it began or was charged
        if not self._resumes:
            self.charging_time = 0.0
            self.charges = 0
            self._gained = 0.0  # coverage at the last charge
            self._has_memory = False
            self._context.forget_obstacles()
            self._context.cliff_map.forget()
            self._watch = BatteryWatch(self._context)
        self._resumes = False
        self._guard.rest()
        self._relocation.rest()
        self._right_of_way.rest()

    def update(self, observation: Observation) -> Command:
        """Do what the state asks for."""
        is_lost = observation.is_lost and self.state is not State.CHARGING
        if not is_lost:
            self._relocation.rest()
            self._track(observation)
        if observation.state_of_charge <= 0.0 and not observation.is_docked:
            return self._strand(EMPTY, Outcome.BATTERY_EMPTY)
        if is_lost:
            return self._relocate(observation)
        if not self._watch.is_ready:
            self.message = 'planning'
            return STOP
        self._watch.look(observation.pose)
        command = self._guard.step(self._decide, observation)
        if self._guard.held_time > HELD:
            return self._strand(f'{percent(self._context.swept.coverage)} swept: the robot is so near to edges that no '
                                'way on is safe', Outcome.BLOCKED)
        self._brushes_up = command.brushes_up
        if self.status is Status.RUNNING and observation.is_silent:
            self.message = relocation.while_silent(self.message, observation)
        return command

    def _relocate(self, observation: Observation) -> Command:
        """Wait or drive about until the robot knows where it is; what its brushes pass over counts for nothing."""
        self._brushes_up = True
        self._is_undisturbed = False
        if self._part is not None:
            self._part.stand_by(observation)
        if self._relocation.is_hopeless:
            return self._strand(relocation.GIVEN_UP, Outcome.LOST)
        command = self._guard.step(self._relocation.command, observation)
        self.message = self._relocation.message
        return command

    def _decide(self, observation: Observation) -> Command:
        if self._context.mates.reports and self.state in (State.CLEANING, State.RETURNING):
            command = self._right_of_way.command(observation, self.plan_ahead())
            if command is not None:
                self.message = 'giving way to another robot'
                return command
        is_returning = self.state in (State.RETURNING, State.DOCKING)
        if self.state is State.CLEANING or is_returning and self._confinement.is_known:
            self._confinement.watch(observation.pose, observation.dt)
            if self._confinement.is_hopeless:
                return self._give_up()
        else:
            self._confinement.rest()
        return self._act(observation)

    def _give_up(self) -> Command:
        """Try to get home from where the robot does not get away; if it has tried that, too, stay."""
        message = f'{percent(self._context.swept.coverage)} swept: {confinement.REASON}'
        if self._confinement.is_known:
            return self._strand(message, Outcome.BLOCKED)
        self._confinement.rest()
        self._confinement.is_known = True
        assert self._last is not None
        self._second_try.give_up()
        return self._close(Status.FAILED, message, Outcome.BLOCKED)

    def take_note(self, observation: Observation) -> None:
        """Follow the robot; what it passes over does not count as swept, since the person may move the brushes."""
        self._brushes_up = True
        self._is_undisturbed = False
        self._confinement.rest()
        observation = self._guard.stand_by(observation)
        self._track(observation)
        if self._part is not None:
            self._part.stand_by(observation)

    def _track(self, observation: Observation) -> None:
        pose, last = observation.pose, self._last
        if not self._has_memory:
            self._begin_floor(pose)
            if observation.is_docked:
                self._context.moor(pose)
        if last is not None and hypot(pose.x - last.x, pose.y - last.y) > JUMP and self._part is not None:
            self._is_undisturbed = False
            self._part.restart()
        if self._context.follow(pose) and self._part is not None:
            self._part.restart()
        if self.state is State.CHARGING:
            self.charging_time += observation.dt
        self._last, self._had_brushes_up = pose, self._brushes_up
        self._context.swept.follow(pose, self._brushes_up)
        self._watch.measure(observation)

    def hear(self, name: str, report: Report) -> None:
        """Take note of what a mate tells."""
        self._context.hear(name, report)

    def report(self) -> Optional[Report]:
        """What its mates need to know; None before its first step."""
        if self._last is None:
            return None
        return Report(self._last, self._had_brushes_up, self._task(), self.plan_ahead())

    def _task(self) -> Task:
        if self.status is not Status.RUNNING:
            return Task.OFF
        if self.state is State.CLEANING:
            return Task.SEEKING if self.plan_ahead() is None else Task.SWEEPING
        return {State.RETURNING: Task.RETURNING, State.DOCKING: Task.DOCKING, State.CHARGING: Task.DOCKED}.get(
            self.state, Task.SEEKING)

    def _begin_floor(self, pose: Pose) -> None:
        """Forget what was swept; what can be reached is counted from the robot, or from the nearest free node."""
        ground = self._context.cleaned_ground()
        point = np.array([pose[:2]])
        if not ground.are_free(point)[0] or ground.plan.safe_clearance_at(*pose[:2]) < ground.reach:
            point = ground.points(ground.standing(ground.nodes(point)))
        self._context.swept.begin(*point[0].tolist())
        self._has_memory = True

    # --- states ---------------------------------------------------------------------------------------------------

    def _begin(self, observation: Observation) -> Command:
        if not observation.is_docked:
            return self._enter(State.CLEANING, self._cleaning)
        if observation.state_of_charge < self._watch.needed(observation.pose) + START:
            return self._enter(State.CHARGING, None)
        return self._enter(State.UNDOCKING, Undock(self._context, turns=False))

    def _clean(self, observation: Observation) -> Command:
        if self._closing is not None:
            return self._close(*self._closing)
        coverage = self._context.swept.coverage
        if self._is_target_met(observation):
            return self._succeed()
        if not self._watch.is_enough_anywhere(observation.state_of_charge):
            needed = self._watch.needed(observation.pose)
            if math.isfinite(needed) and observation.state_of_charge < needed:
                return self._enter(State.RETURNING, Dock(self._context))
            if not math.isfinite(needed) and observation.state_of_charge < self._context.config.reserve:
                return self._close(Status.FAILED, f'{percent(coverage)} swept: the battery is low, and no path leads '
                                                  'to a dock', Outcome.BATTERY_LOW)
        cleaning = self._cleaning
        command = cleaning.step(observation)
        self.message = '; '.join(filter(None, [f'{percent(coverage)} swept', cleaning.message]))
        if cleaning.status is Status.FAILED:
            return self._close(Status.FAILED, f'{percent(coverage)} swept: {cleaning.message}', cleaning.outcome)
        return self._finish_cleaning(observation) if cleaning.status is Status.SUCCEEDED else command

    def _finish_cleaning(self, observation: Observation) -> Command:
        """The strategy finds nothing left to clean; mates may still leave something."""
        target = self._context.target_coverage
        if self._context.mates.are_busy:
            return self._wait_for_mates(observation)
        if self._waits:
            self._waits = False
            return self._enter(State.CLEANING, self._cleaning)
        if self._context.swept.coverage >= target:
            return self._succeed()
        if self._context.ground.has_doubtful:
            self._context.ground.settle()
        if self._context.is_met_beside_obstacles(observation.pose):
            return self._close(Status.SUCCEEDED, swept(self._context), Outcome.SUCCEEDED)
        self._second_try.give_up()
        return self._close(Status.FAILED, f'{swept(self._context)}, the target is {percent(target)}: '
                                          f'{self._cleaning.message}', Outcome.INCOMPLETE)

    def _wait_for_mates(self, observation: Observation) -> Command:
        """Go home, since mates clean what is left; nobody knows yet whether they leave anything."""
        self._waits = True
        self.message = WAITING
        if math.isfinite(self._watch.needed(observation.pose)):
            return self._enter(State.RETURNING, Dock(self._context))
        return STOP

    def _return(self, observation: Observation) -> Command:
        assert isinstance(self._part, Dock)
        if self._closing is None and self._is_target_met(observation):
            self._closing = self._success()
        command = self._part.step(observation)
        self.state = State.DOCKING if self._part.is_homing else State.RETURNING
        self.message = self._part.message
        if self._part.status is Status.FAILED and self._part.is_taken and self._closing:
            status, message, outcome = self._closing
            self._closing = status, f'{message}; {self._part.message}', outcome
            return self._end()
        if self._part.status is Status.FAILED:
            self._homes += 1
            if self._homes >= HOMES:
                return self._strand(f'{percent(self._context.swept.coverage)} swept: {self._part.message}',
                                    self._part.outcome)
            self._part.restart()
        elif self._part.status is Status.SUCCEEDED:
            self._homes = 0
            if self._closing is None:
                return self._arrive()
            return self._begin_again() if self._second_try.is_worth_it(observation.pose) else self._end()
        return command

    def _begin_again(self) -> Command:
        """Clean from the dock on."""
        self._second_try.begin()
        self._closing = None
        return self._enter(State.UNDOCKING, Undock(self._context, turns=False))

    def _arrive(self) -> Command:
        """Charge or wait, unless several charges brought nothing although nobody interfered."""
        if self._waits:
            return self._enter(State.CHARGING, None)
        coverage = self._context.swept.coverage
        if coverage > self._gained + GAIN:
            self._vain = 0
        elif self._is_undisturbed:
            self._vain += 1
        self._gained = coverage
        if self._vain >= VAIN:
            return self._strand(f'{percent(coverage)} swept: {VAIN} charges brought no more: the battery does not '
                                'last', Outcome.BATTERY_LOW)
        self.charges += 1
        return self._enter(State.CHARGING, None)

    def _charge(self, observation: Observation) -> Command:
        if self._is_target_met(observation):
            return self._succeed()
        if self._waits and self._context.mates.are_busy:
            self.message = WAITING
            return STOP
        self.message = f'charging, {percent(observation.state_of_charge)}'
        if self._was_moved(observation):
            self._is_undisturbed = False
            return self._enter(State.CLEANING, self._cleaning)
        if self._waits and observation.state_of_charge >= self._watch.needed(observation.pose) + START or (
                observation.state_of_charge >= self._context.config.charge_to):
            self._is_undisturbed, self._waits = True, False
            return self._enter(State.UNDOCKING, Undock(self._context, turns=False))
        return STOP._replace(seeks_dock=self._context.docks_itself)

    # --- the end --------------------------------------------------------------------------------------------------

    def _is_target_met(self, observation: Observation) -> bool:
        margin = EXACT if observation.covariance == CERTAIN else INEXACT
        if self._waits and not self._context.mates.are_busy:
            margin = 0.0  # each of them has found that nothing more is worth while
        return self._context.swept.coverage >= min(self._context.target_coverage + margin, 1.0)

    def _success(self) -> Tuple[Status, str, Outcome]:
        return Status.SUCCEEDED, f'{percent(self._context.swept.coverage)} swept', Outcome.SUCCEEDED

    def _succeed(self) -> Command:
        return self._close(*self._success())

    def _close(self, status: Status, message: str, outcome: Outcome) -> Command:
        """Return to the dock, if a path leads there, and end then; wait until it is known whether one does."""
        self._closing = status, message, outcome
        if self._last is not None:
            self._watch.look(self._last)
            if self._watch.is_looking:
                return STOP
        if self._last is None or not math.isfinite(self._watch.needed(self._last)):
            return self._end()
        return self._enter(State.RETURNING, Dock(self._context))
