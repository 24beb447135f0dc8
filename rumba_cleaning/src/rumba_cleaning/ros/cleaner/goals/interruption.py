"""The cleaning that a goal of clean with `resume` goes on with."""

from typing import Optional

from rumba_cleaning.outcome import Outcome
from rumba_cleaning.ros.cleaner.goals.activities import Cleaning
from rumba_cleaning.ros.cleaner.goals.run import Run
from rumba_sim.model.common.errors import RumbaError


class NothingToResumeError(RumbaError):
    """A goal asks to go on with a cleaning, and there is none that was interrupted."""


class Interruption:
    """Keeps the last cleaning of which something is left: it was preempted, or cancelled, or its robot was gone."""

    def __init__(self) -> None:
        """There is none yet."""
        self.cleaning: Optional[Cleaning] = None

    def forget(self) -> None:
        """Keep none: what it knows of the floor is no longer true, or another cleaning has begun."""
        self.cleaning = None

    def keep(self, run: Run) -> None:
        """Keep the cleaning of a goal that ends, unless that is over by itself, or the goal is no cleaning."""
        self.cleaning = _unfinished(run) or self.cleaning

    def rest(self, run: Optional[Run], time_limit: float) -> Cleaning:
        """What is left of the cleaning that is going on, if the active goal is one, or of the one that was interrupted.

        Raises:
            NothingToResumeError: there is neither.
            ConfigError: the time limit is negative or not finite.
        """
        cleaning = _unfinished(run) or self.cleaning
        if cleaning is None:
            raise NothingToResumeError('nothing to resume: no cleaning was preempted or cancelled, or lost its robot, '
                                       'since the simulator was started or reset; send a goal without resume')
        return cleaning.resumed(time_limit)


def _unfinished(run: Optional[Run]) -> Optional[Cleaning]:
    """The cleaning of a goal, if it is one, and not over by itself."""
    if run is not None and isinstance(run.activity, Cleaning) and run.outcome is Outcome.UNKNOWN:
        return run.activity
    return None
