"""What a robot leaves to its mates: the floor that these will sweep by their plans."""

import math

import numpy as np

from rumba_cleaning.belief.context import Context
from rumba_cleaning.planning.common.effort import effort
from rumba_cleaning.planning.simulate import paper
from rumba_cleaning.planning.simulate.rehearsal import Rehearsal
from rumba_cleaning.route import Route
from rumba_sim.model.common.geometry import Pose


def leave_to_mates(context: Context) -> None:
    """Count as swept, in the memory of a context, what its mates will sweep by their plans.

    Where routes are rehearsed, those of mates are too: an edited route that a robot followed exactly would sweep other
    corners than it does, and what is left of them in truth takes another plan in the end.
    """
    for ahead in context.mates.sweeping().values():
        route = ahead.rest()
        if effort(context).rounds == 0:
            _drive_on_paper(context, route)
        else:
            (x, y), (to_x, to_y) = route.waypoints[:2]
            context.swept = Rehearsal(context, Pose(x, y, math.atan2(to_y - y, to_x - x)), route).swept


def _drive_on_paper(context: Context, route: Route) -> None:
    waypoints, speeds = route
    sweeps = speeds <= context.config.speed
    ends = np.flatnonzero(np.diff(sweeps)) + 1
    for first, last in zip([0, *ends], [*ends, len(speeds)]):
        if sweeps[first]:
            paper.drive(context.swept, waypoints[first:last + 1])
