"""Drives about with care while the robot does not know where it is, until it does; waits while its laser is silent."""

import math

from rumba_cleaning.behaviour import STOP, Command, Observation
from rumba_cleaning.behaviours.bounce import Bounce
from rumba_cleaning.behaviours.travel import LONGEST
from rumba_cleaning.belief.context import Context

SPEED = 0.15  # [m/s] half the cleaning speed: it stops within 0.03 m of what its bumper or cliff sensors meet
BACK = 0.4  # [m] off the dock, as `Undock`
PATIENCE = 120.0  # [s] after which it gives up: four times what a search takes at most; our choice
MESSAGE = 'lost: drives about until it knows where it is'
GIVEN_UP = f'lost: still does not know where it is after {PATIENCE:g} s'


def while_silent(message: str, observation: Observation) -> str:
    """What a robot does, in one line for a person, and that its laser is silent."""
    return '; '.join(filter(None, [message, _silence(observation)]))


def _silence(observation: Observation) -> str:
    return f'the laser has been silent for {observation.silence:.0f} s'


class Relocation:
    """Goes ahead and turns away from what it meets, by bumper and cliff sensors alone, with the brushes up.

    What the laser sees on the way tells places apart that look alike from one spot. While it sees nothing at all, the
    robot stands still: each movement would make the pose worse.

    Attributes:
        message: one line for a person: what it does.
    """

    message = MESSAGE

    def __init__(self, context: Context) -> None:
        """Draw the turns from the generator of a context."""
        self._bounce = Bounce(context.generator, SPEED)
        self._lost = 0.0  # [s]
        self._back = 0.0  # [s] still to back off from the dock

    @property
    def is_hopeless(self) -> bool:
        """Whether the robot has been lost for too long."""
        return self._lost > PATIENCE

    def rest(self) -> None:
        """The robot knows where it is."""
        if self._lost > 0.0:
            self._bounce.restart()
        self._lost = self._back = 0.0

    def command(self, observation: Observation) -> Command:
        """What to do now: off the dock, which is found again by its beams, then about; stop if there is no pose."""
        self._lost += min(observation.dt, LONGEST)
        self.message = f'{_silence(observation)}: waits for it' if observation.is_silent else MESSAGE
        if observation.is_silent:
            return STOP
        self._back = BACK / SPEED if observation.is_docked else max(self._back - observation.dt, 0.0)
        if math.isinf(observation.covariance[0][0]):
            return STOP
        if self._back > 0.0:
            return Command(-SPEED, 0.0, brushes_up=True)
        return self._bounce.step(observation)._replace(brushes_up=True)
