"""Where to drive: routes, how long they take, and parts of them."""

import math
from typing import NamedTuple, Optional

import numpy as np

from rumba_cleaning.compiled_bearings import bearings
from rumba_sim.model.kernel import Array

# All figures are our choice.
BENT = 0.5  # [rad] a corner by less costs no time, since the robot goes round it at full speed
SHARP = 1.6  # [rad] a corner by more, which is a little more than a right angle, ...
STOP = 0.5  # [s] ... takes this to slow down and to start again
TURN_RATE = 1.9  # [rad/s] of the robot in a corner, about
SAME = 1e-3  # [m] lengths that differ by less are the same


def lengths_along(path: Array) -> Array:
    """Length of a path (any, 2) [m] from its first waypoint to each: float64 (any) [m]."""
    return np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(path, axis=0).T))])


def corner_times(turns: Array) -> Array:
    """Time lost at corners [s] by their angles, float64 (...) [rad], of any sign: none if these are NaN."""
    sizes = np.abs((np.nan_to_num(turns) + math.pi) % (2.0 * math.pi) - math.pi)
    return np.maximum(sizes - BENT, 0.0) / TURN_RATE + np.where(sizes > SHARP, STOP, 0.0)


class Route(NamedTuple):
    """Where to drive."""

    waypoints: Array  # float64 (any, 2) [m], map frame
    speeds: Array  # float64 (any - 1) [m/s] from waypoint to waypoint

    def times(self) -> Array:
        """How long it takes from its first waypoint to each, about: float64 (any) [s]."""
        along = np.diff(self.waypoints, axis=0)
        legs = np.hypot(*along.T) / self.speeds
        corners = corner_times(np.diff(bearings(along)))
        return np.concatenate([[0.0], np.cumsum(legs + np.append(corners, 0.0))])

    def beginning(self, share: float) -> 'Route':
        """Its first part, which takes about a share of its time, and one leg at least."""
        count = self._leg_after(share)
        return Route(self.waypoints[:count + 1], self.speeds[:count])

    def end(self, share: float) -> 'Route':
        """What `beginning` leaves; it may have no leg."""
        count = self._leg_after(share)
        return Route(self.waypoints[count:], self.speeds[count:])

    def _leg_after(self, share: float) -> int:
        times = self.times()
        return max(int(np.searchsorted(times, share * times[-1])), 1)

    @property
    def length(self) -> float:
        """[m]"""
        return float(lengths_along(self.waypoints)[-1])


class Relief(NamedTuple):
    """The end of the plan of a mate, which another robot drives in its place."""

    mate: str  # its name
    plan: int  # the number of its plan
    length: float  # [m] of it that are taken, up to its end


class Ahead(NamedTuple):
    """A route that a robot follows, and how far it has come."""

    route: Route
    remaining: float  # [m] of the route to its end
    plan: int = 0  # counts the plans of a robot: those with one number end at the same place
    relief: Optional[Relief] = None  # what it takes over from a mate

    def rest(self) -> Route:
        """What is left of it, from where the robot is."""
        waypoints, speeds = self.route
        lengths = lengths_along(waypoints)
        driven = max(lengths[-1] - self.remaining, 0.0)
        leg = min(int(np.count_nonzero(lengths[1:] <= driven)), len(speeds) - 1)
        here = [np.interp(driven, lengths, waypoints[:, axis]) for axis in (0, 1)]
        return Route(np.concatenate([[here], waypoints[leg + 1:]]), speeds[leg:])

    def without_end(self, length: float) -> Optional[Route]:
        """The rest of it without its last part [m], up to the end of the leg in which that begins; None: nothing."""
        waypoints, speeds = self.rest()
        lengths = lengths_along(waypoints)
        count = int(np.count_nonzero(lengths[-1] - lengths[:-1] > length + SAME))
        return Route(waypoints[:count + 1], speeds[:count]) if count > 0 else None
