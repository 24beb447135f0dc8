"""Judges whether a robot that gave up begins again once it is home: from there the way may be open."""

from rumba_cleaning.belief.context import Context
from rumba_sim.model.common.geometry import Pose

MUCH = 0.97  # of the floor: who swept so much left crumbs, and was not shut in; our choice


class SecondTry:
    """What a robot knew when it gave up; a mission begins again once, since a third try gains little."""

    def __init__(self, context: Context) -> None:
        """It has not given up yet."""
        self._context = context
        self._was_shut_in = self._has_begun = False

    def give_up(self) -> None:
        """The robot stops cleaning: see whether obstacles may keep it from much of the floor."""
        self._was_shut_in = self._context.ground.has_lasting and self._context.swept.coverage < MUCH

    def is_worth_it(self, pose: Pose) -> bool:
        """Whether it was shut in, and much of the floor is open from the pose where it is now."""
        enough = min(MUCH, self._context.target_coverage)
        return self._was_shut_in and not self._has_begun and self._context.beside_marks(pose).coverage < enough

    def begin(self) -> None:
        """It begins again."""
        self._has_begun = True
