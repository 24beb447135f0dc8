"""What a plan is made for."""

from typing import List, NamedTuple, Optional

from rumba_cleaning.belief.context import Context
from rumba_cleaning.belief.swept import Swept
from rumba_cleaning.planning.common.effort import Effort
from rumba_cleaning.planning.common.stretches import Stretch
from rumba_cleaning.planning.decompose.regions import Shapes
from rumba_cleaning.planning.swaths.crumbs import crumbs
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.kernel import Array


class Problem(NamedTuple):
    """Where a robot that plans is, and what it knows."""

    context: Context  # where the robot can stand, the target, and the floor that was swept before
    pose: Pose  # of the robot
    end: Optional[Pose]  # near which a route should end; None: anywhere
    around: Array  # the cells that it can sweep, bool (rows, columns)
    labels: Array  # the region of each node, int (rows + 1, columns + 1)
    shapes: Shapes  # of the regions
    angle: float  # by which most walls are turned against the map's axes [rad]
    effort: Effort  # that the plan is worth

    def crumbs(self, swept: Swept, least: float = 0.0, apart: float = 0.0) -> List[Stretch]:
        """Crumbs of an area [m^2] or more: see `crumbs`."""
        return crumbs(self.context.ground, swept.missing_share() * self.around, self.labels, least, apart)


def need(context: Context, swept: Swept, surplus: float = 0.0) -> float:
    """Area that is missing to the target and a surplus of coverage [m^2]."""
    return (context.target_coverage + surplus - swept.coverage) * swept.reachable_area
