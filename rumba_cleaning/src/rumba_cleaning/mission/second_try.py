"""Judges whether a robot that gave up begins again once it is home: from there the way may be open."""

from rumba_cleaning.belief.context import Context
from rumba_sim.model.common.geometry import Pose

MUCH = 0.97  # of what lies beside obstacles: who swept so much left crumbs, and was not shut in; our choice


class SecondTry:
    """What a robot knew when it gave up; a mission begins again once, since a third try gains little."""

    def __init__(self, context: Context) -> None:
        """It has not given up yet."""
        self._context = context
        self._was_shut_in = self._has_begun = False

    def give_up(self, pose: Pose) -> None:
        """The robot gives up at a pose: see whether obstacles shut it in."""
        context = self._context
        self._was_shut_in = context.ground.has_lasting and (
            context.beside_obstacles().coverage < MUCH or context.is_cut_off(pose))

    @property
    def is_worth_it(self) -> bool:
        """Whether it was shut in, and much of the floor is open from where it is now."""
        return self._was_shut_in and not self._has_begun and self._context.beside_obstacles().coverage < MUCH

    def begin(self) -> None:
        """It begins again."""
        self._has_begun = True
