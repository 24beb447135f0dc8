"""How a robot that has nothing left to clean helps a mate: it drives the end of the plan of that mate."""

from typing import Optional, Tuple

import numpy as np

from rumba_cleaning.belief import paths
from rumba_cleaning.belief.context import Context
from rumba_cleaning.route import Relief, Route, lengths_along
from rumba_sim.model.common.geometry import Pose

LEAST = 7.0  # [s] of work that are taken over, at least: our choice, less is hardly worth the way there


def help_mate(context: Context, pose: Pose) -> Optional[Tuple[Route, Relief]]:
    """Take over so much of the plan that takes longest that both are done at the same time; None: it is not worth it.

    Args:
        context: with what the mates plan.
        pose: from which the robot would drive there.

    Returns:
        A route to the end of that plan, and along it.
    """
    plans = context.mates.sweeping()
    rests = {name: ahead.rest() for name, ahead in plans.items() if context.mates.relief(name, ahead.plan) == 0.0}
    if not rests:
        return None
    name, rest = max(rests.items(), key=lambda item: float(item[1].times()[-1]))
    duration = float(rest.times()[-1])
    middle = rest.end(0.5).waypoints[0]
    way = paths.between(context.ground, np.array(pose[:2]), middle)  # about as long as that to the end
    if way is None:
        return None
    speed = context.config.transit_speed
    share = 0.5 + 0.5 * float(lengths_along(way)[-1]) / speed / max(duration, LEAST)
    end = rest.end(min(share, 1.0))
    if (1.0 - share) * duration < LEAST or len(end.speeds) == 0:
        return None
    way = paths.between(context.ground, np.array(pose[:2]), end.waypoints[0])
    if way is None:
        return None
    route = Route(np.concatenate([way, end.waypoints[1:]]), np.concatenate([np.full(len(way) - 1, speed), end.speeds]))
    return route, Relief(name, plans[name].plan, end.length)
