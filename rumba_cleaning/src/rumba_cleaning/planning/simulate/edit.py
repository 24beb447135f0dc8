"""A part of a route that is replaced."""

from typing import NamedTuple

from rumba_cleaning.route import Route
from rumba_sim.model.kernel import Array

NEAR = 1.2  # times a price: large judges more edits again, small may miss some that become worth it; our choice


class Edit(NamedTuple):
    """Part of a route that is replaced."""

    first: int  # the waypoint before that part
    last: int  # the one after it
    path: Array  # float64 (any, 2) [m] that replaces it
    seconds: float = 0.0  # that the route takes longer
    area: float = 0.0  # [m^2] that is swept more

    def place(self, route: Route) -> bytes:
        """A key of the replaced part and its replacement: equal for edits of routes that are alike there."""
        return bytes(route.waypoints[[self.first, self.last]].tobytes() + self.path.tobytes())

    def is_near(self, price: float) -> bool:
        """Whether it would be worth it at a price near to a given one [s/m^2]."""
        return max(price * NEAR * self.area, price / NEAR * self.area) > self.seconds
