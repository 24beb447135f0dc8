"""bounce: straight ahead until something is in the way, then in another direction, as early Roombas did."""

from rumba_cleaning.behaviours.bounce import Bounce
from rumba_cleaning.belief.context import Context
from rumba_cleaning.strategies import strategy


@strategy('bounce')
def bounce(context: Context) -> Bounce:
    """The strategy, for a robot's context."""
    return Bounce(context.generator, context.config.speed, context.ground)
