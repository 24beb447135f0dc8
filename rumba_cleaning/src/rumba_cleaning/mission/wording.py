"""What a mission tells people of the floor that it swept."""

import math

from rumba_cleaning.belief.context import Context

ROUNDING = 1e-6  # tenths of percent


def percent(share: float) -> str:
    """A share [0..1], rounded down, so that one below a target does not read like it."""
    return f'{math.floor(1000.0 * share + ROUNDING) / 10.0:.1f} %'


def swept(context: Context) -> str:
    """How much was swept, and how much of what lies beside obstacles that stay, or before straits, if there are any."""
    told = f'{percent(context.swept.coverage)} swept'
    if not context.ground.has_lasting and not context.swept.has_straits:
        return told
    part = 'lies beside obstacles' if context.ground.has_lasting else 'is planned'
    return f'{told}, {percent(context.beside_obstacles().coverage)} of what {part}'
