"""Pieces of routes and of paths, of which other routes can be made."""

import math
from typing import Iterator, List, Sequence, Tuple

import numpy as np

from rumba_cleaning.compiled_bearings import bearings
from rumba_cleaning.planning.common.polyline import strides
from rumba_cleaning.planning.simulate.rehearsal import Rehearsal
from rumba_cleaning.route import lengths_along
from rumba_sim.model.kernel import Array

# All figures are our choice.
STEP = 0.1  # [m] between the waypoints of a piece, at most
LONG = 3.0  # [m] of a piece, at most: small pieces can be put together in more ways, large ones are fewer
BENT = 0.6  # [rad] of a corner, at which a path is cut
SHORT = 0.02  # [m] of a piece; a shorter one is left out
IDLE = 0.02  # share of the brush's width that a piece of a route sweeps and the rest does not, for it to be used
SAME = 2  # decimals of [m] in which the ends and the length of pieces agree that are the same


def of_route(rehearsal: Rehearsal, speed: float, brush: float) -> List[Array]:
    """Pieces of a route: float64 (any, 2) [m] each, in its order; without its ways, and what sweeps nothing new.

    Args:
        rehearsal: of the route, with waypoints that are not far apart.
        speed: at which the robot cleans [m/s].
        brush: width of the brush [m].
    """
    waypoints, speeds = rehearsal.route
    ways = speeds > speed
    swept = np.diff(rehearsal.alone)
    lengths = lengths_along(waypoints)
    return [waypoints[first:last + 1] for first, last in _cuts(waypoints, np.flatnonzero(ways[1:] != ways[:-1]) + 1)
            if swept[first:last].sum() >= IDLE * brush * (lengths[last] - lengths[first])]


def of_paths(paths: Sequence[Array], known: Sequence[Array]) -> List[Array]:
    """Pieces of paths (any, 2) [m], without known ones, and each once."""
    seen = {_key(piece) for piece in known}
    found: List[Array] = []
    for path in paths:
        waypoints = strides(path, STEP)
        for first, last in _cuts(waypoints, np.zeros(0, np.intp)):
            piece = waypoints[first:last + 1]
            key = _key(piece)
            if key not in seen:
                seen.add(key)
                found.append(piece)
    return found


def _cuts(waypoints: Array, others: Array) -> Iterator[Tuple[int, int]]:
    """The first waypoint and the last of each piece of a path (any, 2) [m], which is cut at corners, and at others."""
    headings, lengths = bearings(np.diff(waypoints, axis=0)), lengths_along(waypoints)
    turns = np.abs((np.diff(headings) + math.pi) % (2.0 * math.pi) - math.pi)
    ends = np.unique(np.concatenate([[0, len(waypoints) - 1], np.flatnonzero(turns > BENT) + 1, others]))
    for first, last in zip(ends.tolist(), ends[1:].tolist()):
        length = lengths[last] - lengths[first]
        if length >= SHORT:
            along = np.linspace(lengths[first], lengths[last], math.ceil(length / LONG) + 1)
            within = [first, *np.searchsorted(lengths, along[1:-1]).tolist(), last]
            yield from zip(within, within[1:])


def _key(piece: Array) -> Tuple[float, ...]:
    """The same for pieces between the same ends that are as long as each other, in either direction."""
    (x, y), (to_x, to_y) = np.round(piece[[0, -1]], SAME).tolist()
    return (*min((x, y, to_x, to_y), (to_x, to_y, x, y)), round(float(lengths_along(piece)[-1]), SAME))
