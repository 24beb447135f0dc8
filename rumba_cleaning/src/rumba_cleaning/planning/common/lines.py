"""What a robot needs beside a straight line to drive along it, for `compiled_ways.sight`."""

import math

from rumba_cleaning.belief.ground import Ground
from rumba_cleaning.planning.common.compiled_ways import Needed
from rumba_sim.model.floors.reachability import SLACK

# Our choice.
NEAR = 0.15  # [m] to the ends of a line, which lie beside walls if that of a path does: nearer than this, it may be ...
TOUCHING = 0.004  # [m] ... too near by so much, and the robot slides along the wall, ...
ASIDE = 0.012  # [m] ... so far from which it can stand, at most: TOUCHING and SLACK, and the steps of the grid


def needed(ground: Ground, beside: float = SLACK) -> Needed:
    """What a robot needs that keeps a distance [m] between its body and obstacles, but for the ends of a line."""
    res = ground.plan.resolution
    return Needed(ground.reach + beside, ground.reach - TOUCHING, NEAR / res, ground.reach + SLACK,
                  math.ceil(ASIDE / res), res)
