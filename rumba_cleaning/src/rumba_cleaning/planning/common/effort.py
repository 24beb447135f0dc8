"""How much effort a plan is worth: large floors get less of it, so that nobody waits long."""

from typing import NamedTuple

from rumba_cleaning.belief.context import Context

# All figures are our choice; each comment says what speaks for a larger and for a smaller value.
WORK = 240.0  # [m^2] of floor, times rounds: large makes shorter routes, small plans faster
THOROUGH = 10  # times as much as usual to search for tours where routes are rehearsed: small plans faster


class Effort(NamedTuple):
    """What a plan for a floor is worth."""

    rounds: int  # in which a route is edited, each after another rehearsal; 0: routes are not rehearsed

    @property
    def tours(self) -> int:
        """How many times as much as usual tours are searched."""
        return THOROUGH if self.rounds else 1


def effort(context: Context) -> Effort:
    """The effort for the floor of a context."""
    return Effort(min(int(WORK / context.swept.reachable_area), context.config.planning_rounds))
