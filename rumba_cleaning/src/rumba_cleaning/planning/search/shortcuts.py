"""Shortcuts of a route: parts of it that a straight line replaces, since they sweep little that nothing else sweeps."""

from typing import List

import numpy as np

from rumba_cleaning.belief.context import Context
from rumba_cleaning.planning.common.rows import distinct
from rumba_cleaning.planning.simulate.rehearsal import NO_PATH, Edit, Rehearsal
from rumba_cleaning.route import lengths_along
from rumba_sim.model.kernel import Array

# All figures are our choice.
LENGTHS = (0.3, 0.6, 1.0, 1.5, 2.2, 3.3)  # [m] of the parts that are looked at
STEP = 0.25  # share of its length, from the beginning of one to that of the next
LEAST = 0.3  # [s] that one saves, at least
SWEPT = 0.6  # share of the brush's width that the straight line sweeps of what the part does, about


def shortcuts(context: Context, rehearsal: Rehearsal, price: float) -> List[Edit]:
    """Shortcuts that save about so much time for what they leave [s/m^2]; those that save most first.

    Args:
        context: where the robot can stand.
        rehearsal: of the route.
        price: see above.
    """
    waypoints, lengths = rehearsal.route.waypoints, lengths_along(rehearsal.route.waypoints)
    ends = np.concatenate([np.stack([begins, begins + length], axis=1) for length in LENGTHS
                           for begins in [np.arange(STEP * length, lengths[-1] - length, STEP * length)]])
    spans, _ = distinct(np.searchsorted(lengths, ends))
    spans = spans[(spans[:, 0] > 0) & (spans[:, 1] < len(waypoints) - 1) & (spans[:, 1] > spans[:, 0] + 1)]
    worth = _worth(context, rehearsal, spans, price)
    order = np.argsort(-worth, kind='stable')
    return [Edit(first, last, NO_PATH) for first, last in spans[order[worth[order] > 0.0]].tolist()
            if context.ground.is_straight(waypoints[first], waypoints[last])]


def _worth(context: Context, rehearsal: Rehearsal, spans: Array, price: float) -> Array:
    """What shortcuts between waypoints, int (any, 2), save beyond what they should [s], about: float64 (any)."""
    firsts, lasts = spans.T
    straight = np.hypot(*(rehearsal.route.waypoints[lasts] - rehearsal.route.waypoints[firsts]).T)
    saved = rehearsal.reached[lasts] - rehearsal.reached[firsts] - straight / context.config.speed
    lost = rehearsal.alone[lasts] - rehearsal.alone[firsts] - SWEPT * context.robot.brush.width * straight
    return np.where(saved >= LEAST, saved - price * lost, 0.0)
