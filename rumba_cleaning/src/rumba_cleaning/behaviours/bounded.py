"""Ends a behaviour that does not end by itself."""

from rumba_cleaning.behaviour import STOP, Behaviour, Command, Observation, Status


class Bounded(Behaviour):
    """Another behaviour, given up after a time, or when the battery is empty.

    Attributes:
        behaviour: the other one.
        time: [s] since it began.
    """

    def __init__(self, behaviour: Behaviour, time_limit: float) -> None:
        """Give it `time_limit` [s] of simulated time."""
        self.behaviour = behaviour
        self._time_limit = time_limit
        self.initialise()

    def initialise(self) -> None:
        """Begin anew."""
        super().initialise()
        self.behaviour.initialise()
        self.time = 0.0

    def update(self, observation: Observation) -> Command:
        """What the other one says, while it may."""
        self.time += observation.dt
        if observation.state_of_charge <= 0.0 and not observation.is_docked:
            return self.fail('the battery is empty')
        if self.time > self._time_limit:
            return self.fail(f'not done after {self._time_limit:g} s: {self.behaviour.message}')
        command = self.behaviour.update(observation)
        self.status, self.message = self.behaviour.status, self.behaviour.message
        return command if self.status is Status.RUNNING else STOP

    def terminate(self) -> None:
        """End the other one."""
        self.behaviour.terminate()
