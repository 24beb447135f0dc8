"""Ends a behaviour that does not end by itself."""

from typing import Optional

from rumba_cleaning.behaviour import Behaviour, Command, Observation, Status
from rumba_cleaning.behaviours.guard import Guard
from rumba_cleaning.outcome import Outcome


class Bounded(Behaviour):
    """Another behaviour, given up after a time, or when the battery is empty.

    Attributes:
        behaviour: the other one.
        time: since the run began, with the time in which a person drove [s].
    """

    time = 0.0

    def __init__(self, behaviour: Behaviour, time_limit: float, guard: Optional[Guard] = None) -> None:
        """Give it `time_limit` [s] of simulated time, and a guard, unless it has one of its own as a mission has."""
        self.behaviour = behaviour
        self._guard = guard
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
        decide = self.behaviour.step
        command = decide(observation) if self._guard is None else self._guard.step(decide, observation)
        self.message = self.behaviour.message
        if self.behaviour.status is Status.SUCCEEDED:
            return self.succeed(self.message, self.behaviour.outcome)
        if self.behaviour.status is Status.FAILED:
            return self.fail(self.message, self.behaviour.outcome)
        return command

    def terminate(self) -> None:
        """Stop the other one."""
        self.behaviour.stop()

    def take_note(self, observation: Observation) -> None:
        """Count the time, and have the other one stand by."""
        self.time += observation.dt
        if self._guard is not None:
            self._guard.stand_by(observation)
        self.behaviour.stand_by(observation)
