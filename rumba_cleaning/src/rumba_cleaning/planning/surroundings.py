"""What a plan is made for."""

from typing import List, NamedTuple, Optional

from rumba_cleaning.belief.context import Context
from rumba_cleaning.belief.swept import Swept
from rumba_cleaning.planning.crumbs import crumbs
from rumba_cleaning.planning.detours import detours
from rumba_cleaning.planning.edits import Edit
from rumba_cleaning.planning.stretches import Stretch
from rumba_cleaning.planning.walls import Walls
from rumba_cleaning.route import Route
from rumba_sim.model.geometry import Pose
from rumba_sim.model.kernel import Array


class Surroundings(NamedTuple):
    """Where a robot that plans is, and what it knows."""

    context: Context  # where the robot can stand, the target, and the floor that was swept before
    pose: Pose  # of the robot
    end: Optional[Pose]  # near which a route should end; None: anywhere
    around: Array  # the cells that it can sweep, bool (rows, columns)
    labels: Array  # the region of each node, int (rows + 1, columns + 1)
    walls: Walls  # of the ground of the context

    def detours(self, route: Route, swept: Swept, least: float = 0.0) -> List[Edit]:
        """Detours from a route past the crumbs of an area [m^2] or more that are left when it is driven."""
        return detours(self.context, route, self.crumbs(swept, least))

    def crumbs(self, swept: Swept, least: float = 0.0, apart: float = 0.0) -> List[Stretch]:
        """Crumbs of an area [m^2] or more: see `crumbs`."""
        return crumbs(self.context.ground, self.walls, swept.missing_share() * self.around, self.labels, least, apart)

    def need(self, swept: Swept, surplus: float) -> float:
        """Area that is missing to the target and a surplus [m^2]."""
        return (self.context.target_coverage + surplus - swept.coverage) * swept.reachable_area
