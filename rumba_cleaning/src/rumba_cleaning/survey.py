"""What tells of a floor that is being mapped while the robot works on it."""

import abc

from rumba_sim.model.kernel import Array
from rumba_sim.model.maps.floor_plan import FloorPlan


class Survey(abc.ABC):
    """Tells the newest map."""

    @abc.abstractmethod
    def plan(self) -> FloorPlan:
        """The map so far; the same object as long as it is the same."""

    @abc.abstractmethod
    def frames(self) -> Array:
        """Poses of the scans that the map shows: float64 (any, 3) [m, m, rad], map frame; each keeps its number.

        The same object as long as they are the same. If the map is redrawn, they move.
        """
