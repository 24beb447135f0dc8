"""Ends a behaviour that does not end by itself."""

from typing import Optional

from rumba_cleaning.behaviour import Behaviour, Command, Observation, Status
from rumba_cleaning.behaviours import relocation
from rumba_cleaning.belief.context import Context
from rumba_cleaning.edges.guard import Guard
from rumba_cleaning.outcome import Outcome
from rumba_cleaning.route import Ahead


class Bounded(Behaviour):
    """Another behaviour, given up after a time, or when the battery is empty.

    Attributes:
        behaviour: the other one.
        time: since the run began, with the time in which a person drove [s].
    """

    time = 0.0

    def __init__(self, behaviour: Behaviour, time_limit: float, context: Optional[Context] = None) -> None:
        """Give it `time_limit` [s] of simulated time.

        With a context, it is kept from edges, and it waits while the robot is lost; a mission sees to that itself.
        """
        self.behaviour = behaviour
        self._guard = None if context is None else Guard(context)
        self._relocation = None if context is None else relocation.Relocation(context)
        self._time_limit = time_limit

    def initialise(self) -> None:
        """Begin with all the time left."""
        self.behaviour.restart()
        self.time = 0.0
        if self._guard is not None:
            self._guard.rest()

    def update(self, observation: Observation) -> Command:
        """Step the other one, within the limits."""
        self.time += observation.dt
        if observation.state_of_charge <= 0.0 and not observation.is_docked:
            return self.fail('the battery is empty', Outcome.BATTERY_EMPTY)
        if self.time > self._time_limit:
            return self.fail(f'not done after {self._time_limit:g} s: {self.behaviour.message}', Outcome.TIMED_OUT)
        command = self._decide(observation) if self._guard is None else self._guard.step(self._decide, observation)
        if self._relocation is not None and self._relocation.is_hopeless:
            return self.fail(relocation.GIVEN_UP, Outcome.LOST)
        if self.behaviour.status is Status.SUCCEEDED:
            return self.succeed(self.message, self.behaviour.outcome)
        if self.behaviour.status is Status.FAILED:
            return self.fail(self.message, self.behaviour.outcome)
        return command

    def _decide(self, observation: Observation) -> Command:
        if self._relocation is not None and observation.is_lost:
            self.behaviour.stand_by(observation)
            command = self._relocation.command(observation)
            self.message = self._relocation.message
            return command
        if self._relocation is not None:
            self._relocation.rest()
        command = self.behaviour.step(observation)
        self.message = self.behaviour.message
        if self._relocation is not None and observation.is_silent:
            self.message = relocation.while_silent(self.message, observation)
        return command

    def terminate(self) -> None:
        """Stop the other one."""
        self.behaviour.stop()

    def take_note(self, observation: Observation) -> None:
        """Count the time, and have the other one stand by."""
        self.time += observation.dt
        if self._guard is not None:
            observation = self._guard.stand_by(observation)
        self.behaviour.stand_by(observation)

    def plan_ahead(self) -> Optional[Ahead]:
        """The plan of the other one."""
        return self.behaviour.plan_ahead()
