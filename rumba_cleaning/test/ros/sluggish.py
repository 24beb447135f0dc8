"""A strategy that takes long for each of its steps, as one does that compiles, and ends after a few."""

import time

from rumba_cleaning.behaviour import STOP, Behaviour
from rumba_cleaning.outcome import Outcome
from rumba_cleaning.strategies import strategy

SECONDS = 3.0  # [s] of the wall clock for a step
STEPS = 2


@strategy('sluggish')
class Sluggish(Behaviour):
    """Stands still."""

    def __init__(self, _context):
        """Nothing is done yet."""
        self._steps = 0

    def update(self, _observation):
        """Take long."""
        time.sleep(SECONDS)
        self._steps += 1
        if self._steps == STEPS:
            self.fail('sluggish', Outcome.FAILED)
        return STOP
