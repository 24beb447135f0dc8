"""What missions have in common, with a map and without: their states, the part that is under way, and their end."""

import abc
import enum
from typing import Optional, Tuple

from rumba_cleaning.behaviour import STOP, Behaviour, Command, Observation, Status
from rumba_cleaning.belief.mates import Report
from rumba_cleaning.outcome import Outcome
from rumba_cleaning.route import Ahead
from rumba_sim.model.common.errors import CommandError

HELD = 60.0  # [s] for which edges may hold the robot at one place: it has tried other ways by then; our choice
OFF = 1.0  # [s] off the contacts while charging: the robot was moved; contacts that bounce are closed again sooner
START = 0.1  # charge beyond what the way to the dock needs, without which a mission begins with charging; our choice
EMPTY = 'the battery is empty'


class State(enum.IntEnum):
    """What the robot does; the constants of rumba_msg/MissionStatus."""

    IDLE = 0
    UNDOCKING = 1
    CLEANING = 2
    RETURNING = 3
    DOCKING = 4
    CHARGING = 5
    GOING_TO = 6
    STRANDED = 7
    YIELDING = 8


class StagedMission(Behaviour):
    """A mission in states, each with a part that does the work.

    Attributes:
        state: what the robot does.
        strategy: name of the cleaning strategy.
        charging_time: time spent at the contacts to charge [s].
        charges: how often it returned to charge.
    """

    state = State.IDLE
    strategy = ''
    charging_time = 0.0
    charges = 0
    _cleaning: Behaviour  # by the strategy
    _part: Optional[Behaviour] = None
    _closing: Optional[Tuple[Status, str, Outcome]] = None  # how the mission ends once the robot is back
    _has_memory = False  # of a floor on which it has begun
    _resumes = False  # the next run goes on with that memory

    def resume(self) -> None:
        """Have the next run go on with the memory of the last one, which was stopped.

        Raises:
            CommandError: the mission has ended.
        """
        if self.status is not Status.RUNNING:
            raise CommandError(f'a mission that has ended cannot be resumed: {self.message}')
        self._resumes = self._has_memory and not self._is_under_way

    def forget(self) -> None:
        """Have the next run begin with a floor that is not swept, even if it was to go on with the last one."""
        self._resumes = False

    def terminate(self) -> None:
        """Stop the part that is under way."""
        if self.outcome is Outcome.FALLEN:
            self.state = State.STRANDED
        if self._part is not None:
            self._part.stop()

    def plan_ahead(self) -> Optional[Ahead]:
        """The plan of the part that is under way."""
        return None if self._part is None else self._part.plan_ahead()

    def hear(self, name: str, report: Report) -> None:
        """Take note of what a mate tells."""

    def report(self) -> Optional[Report]:
        """What its mates need to know; None if there is nothing."""
        return None

    def _rest(self) -> None:
        """Begin a run: nothing is under way."""
        self.state, self._part, self._closing = State.IDLE, None, None
        self._off = 0.0  # [s] off the contacts

    def _enter(self, state: State, part: Optional[Behaviour]) -> Command:
        if self._part is not None:
            self._part.stop()
        self.state, self._part = state, part
        if part is not None:
            part.restart()
        return STOP

    def _act(self, observation: Observation) -> Command:
        """Do what the state asks for."""
        return {
            State.IDLE: self._begin, State.UNDOCKING: self._undock, State.CLEANING: self._clean,
            State.RETURNING: self._return, State.DOCKING: self._return, State.CHARGING: self._charge,
        }[self.state](observation)

    @abc.abstractmethod
    def _begin(self, observation: Observation) -> Command:
        """Leave the dock, charge, or clean, by where the robot is."""

    @abc.abstractmethod
    def _clean(self, observation: Observation) -> Command:
        """Clean, until there is a reason to return."""

    @abc.abstractmethod
    def _return(self, observation: Observation) -> Command:
        """Get onto the contacts of the dock."""

    @abc.abstractmethod
    def _charge(self, observation: Observation) -> Command:
        """Wait on them."""

    def _undock(self, observation: Observation) -> Command:
        assert self._part is not None
        command = self._part.step(observation)
        if self._part.status is Status.FAILED:
            return self._strand(self._part.message, self._part.outcome)
        if self._part.status is Status.SUCCEEDED:
            return self._enter(State.CLEANING, self._cleaning)
        return command

    def _was_moved(self, observation: Observation) -> bool:
        """Whether somebody took the robot off the contacts while it charged."""
        self._off = 0.0 if observation.is_docked else self._off + observation.dt
        return self._off > OFF

    def _end(self) -> Command:
        assert self._closing is not None
        self.state = State.IDLE
        status, message, outcome = self._closing
        return self.succeed(message, outcome) if status is Status.SUCCEEDED else self.fail(message, outcome)

    def _strand(self, message: str, outcome: Outcome) -> Command:
        self.state = State.STRANDED
        return self.fail(message, outcome)
