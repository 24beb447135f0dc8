"""How careful a robot is beside edges: one with a map knows where it is what it saw, another soon does not any more."""

from typing import NamedTuple

# The sensors see an edge in time for wheels that are no faster (a corner of 90 degrees is seen 0.08 m before a wheel is
# there, and such a robot brakes within 0.07 m), and all of the floor before wheels in wide bends.
SAFE_SPEED = 0.35  # [m/s]
# In tighter bends the inner sensor of one side looks 0.17 m ahead along the circle of the outer wheel, or up to 0.03 m
# inside that, and the outer one beside it 0.09 m ahead: a wheel that is no faster stops within 0.12 m.
SWIFT_SPEED = 0.38  # [m/s]


class Caution(NamedTuple):
    """Limits that a guard keeps."""

    safe_speed: float = SAFE_SPEED  # [m/s] of the wheels, at which it need not remember the floor ahead
    swift_speed: float = SWIFT_SPEED  # [m/s] the same in tight bends
    wary_guess: int = 0  # cells beside known floor that it takes for floor too, as it creeps near a cliff that the map
    #                      does not show, and on its way out
    trusts: bool = True  # on its way out it takes all for floor, as long as it knows of no such cliff


WITH_MAP = Caution()
# A robot that forgets comes to every edge as if it had never seen it: faster ones fell down the stairs of the
# apartment, one of them in a tight bend. The figures are our choice.
WITHOUT_MAP = Caution(safe_speed=0.25, swift_speed=0.25, wary_guess=1, trusts=False)
