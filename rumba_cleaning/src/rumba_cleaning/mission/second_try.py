"""Judges whether a robot that gave up begins again once it is home: from there the way may be open."""

from rumba_cleaning.belief.context import Context
from rumba_sim.model.geometry import Pose

# As boustrophedon judges what it gained by forgetting obstacles.
HELPED = 0.01  # of coverage: less since the try before was not worth the time
MUCH = 0.9  # of what lies beside obstacles: who swept so much was not shut in


class SecondTry:
    """What a robot knew when it gave up."""

    def __init__(self, context: Context) -> None:
        """It has not given up yet."""
        self._context = context
        self._was_shut_in = False
        self._before = -1.0  # coverage when it gave up, the time before

    def give_up(self, pose: Pose) -> None:
        """The robot gives up at a pose: see whether obstacles shut it in."""
        context = self._context
        self._was_shut_in = context.ground.has_lasting and (
            context.beside_obstacles().coverage < MUCH or context.is_cut_off(pose))

    @property
    def is_worth_it(self) -> bool:
        """Whether it was shut in, much of the floor is open from where it is now, and its last try brought anything."""
        context = self._context
        return (self._was_shut_in and context.swept.coverage > self._before + HELPED
                and context.beside_obstacles().coverage < MUCH)

    def begin(self) -> None:
        """It begins again."""
        self._was_shut_in = False
        self._before = self._context.swept.coverage
