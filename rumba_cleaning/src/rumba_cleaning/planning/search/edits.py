"""Edits of a route: parts of it that are replaced, what each of them costs and brings, and which of them to make."""

import bisect
from typing import List, Sequence, Tuple

import numpy as np

from rumba_cleaning.planning.common.polyline import stride_counts, strides
from rumba_cleaning.planning.simulate.rehearsal import Edit
from rumba_cleaning.route import Route
from rumba_sim.model.kernel import Array

# Our choice.
APART = 0.1  # [m] between the waypoints at which an edit may begin, at most: small makes detours shorter
BETWEEN = 6  # waypoints between two edits, at least: each was judged as if it were the only one
BETTER = 0.02  # [s] that an edit is worth, at least: many of less bring less than they promise
HALVINGS = 14  # of the range in which the price is looked for


def dense(route: Route) -> Route:
    """A route with waypoints that are not far apart."""
    return Route(strides(route.waypoints, APART), np.repeat(route.speeds, stride_counts(route.waypoints, APART)))


def chosen(edits: Sequence[Edit], need: float, dearest: float) -> Tuple[List[Edit], float]:
    """Edits that together sweep so much more [m^2], and take least time for it: all that are worth one price.

    Args:
        edits: of one route.
        need: area to sweep more; negative if so much may be lost [m^2].
        dearest: the highest price [s/m^2]; if it is not enough, less is swept.

    Returns:
        the edits, and their price [s/m^2].
    """
    low, high = 0.0, dearest
    for _ in range(HALVINGS):
        price = 0.5 * (low + high)
        if sum(edit.area for edit in _worth(edits, price)) >= need:
            high = price
        else:
            low = price
    return _worth(edits, high), high


def _worth(edits: Sequence[Edit], price: float) -> List[Edit]:
    """Edits that are worth it at a price [s/m^2], the best first, each apart from those before it."""
    values = [(price * edit.area - edit.seconds, index) for index, edit in enumerate(edits)]
    found: List[Edit] = []
    taken: List[Tuple[int, int]] = [(-BETWEEN, -BETWEEN)]  # by their places, none of which overlap
    for _, index in sorted((each for each in values if each[0] >= BETTER), reverse=True):
        edit = edits[index]
        place = bisect.bisect(taken, (edit.first, edit.last))
        if taken[place - 1][1] + BETWEEN <= edit.first and (
                place == len(taken) or edit.last + BETWEEN <= taken[place][0]):
            found.append(edit)
            taken.insert(place, (edit.first, edit.last))
    return found


def applied(route: Route, edits: Sequence[Edit], speed: float) -> Route:
    """A route with edits that do not overlap; what replaces its parts is driven at a speed [m/s]."""
    waypoints: List[Array] = []
    speeds: List[Array] = []
    last = 0
    for edit in sorted(edits, key=lambda edit: edit.first):
        waypoints += [route.waypoints[last:edit.first + 1], edit.path]
        speeds += [route.speeds[last:edit.first], np.full(len(edit.path) + 1, speed)]
        last = edit.last
    return Route(np.concatenate([*waypoints, route.waypoints[last:]]), np.concatenate([*speeds, route.speeds[last:]]))
