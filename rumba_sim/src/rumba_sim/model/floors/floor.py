"""The state of the floor: how much of it is swept, and how much dirt is left."""

import math

import numpy as np

from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.floors.sweep import Sweep
from rumba_sim.model.kernel import Array
from rumba_sim.model.kernel.ground import BLOCKED, CARPET, CLIFF
from rumba_sim.model.maps.floor_plan import FloorPlan
from rumba_sim.model.settings.robot_config import RobotConfig

DUST = 0.3  # dirt in a cell outside all spots
AREA_PER_SPOT = 2.0  # [m^2] of free floor for each spot of dirt
SPOT_RADIUS = (0.1, 0.4)  # [m]
SPOT_DIRT = (1.0, 4.0)  # in the centre of a spot, in addition to the dust


class Floor:
    """The floor of a plan that can be cleaned, and how far it is clean.

    Attributes:
        cells: uint8 (rows, columns), the bits BLOCKED, CLIFF and CARPET of `kernel.ground`.
        dirt: float32 (rows, columns), on each cell in the beginning.
        sweep: what was swept since then.
    """

    def __init__(self, plan: FloorPlan, config: RobotConfig, start: Pose, generator: np.random.Generator) -> None:
        """Create an unswept floor with random dirt.

        Args:
            plan: the refined floor plan.
            config: of the robots, whose radius and brush decide what can be reached.
            start: pose [m, rad], map frame, from which that is.
            generator: source of the random dirt.

        Raises:
            MapError: a robot does not fit at the start.
        """
        self.cells = np.where(plan.free, 0, BLOCKED).astype(np.uint8)
        for layer, bit in ((plan.cliff, CLIFF), (plan.carpet, CARPET)):
            if layer is not None:
                self.cells[layer & plan.free] |= bit
        self.dirt = _random_dirt(plan, generator)
        self.sweep = Sweep(plan, config)
        self.sweep.begin(start.x, start.y)
        reachable, _ = self.sweep.counts(plan.sample_squares)
        self._dirt = float(np.sum(self.dirt * reachable, dtype=np.float64))
        self.sweep.tally[0]['dirt'] = self._dirt

    @property
    def reachable_area(self) -> float:
        """Area that the brush can reach [m^2]."""
        return self.sweep.reachable_area

    @property
    def cleaned_area(self) -> float:
        """Part of the reachable area that was swept at least once [m^2]."""
        return self.sweep.cleaned_area

    @property
    def coverage(self) -> float:
        """cleaned_area / reachable_area [0..1]; 1 if nothing is reachable."""
        return self.sweep.coverage

    @property
    def dirt_left(self) -> float:
        """Share of the dirt on the reachable floor that is still there [0..1]."""
        return min(max(float(self.sweep.tally[0]['dirt']) / self._dirt, 0.0), 1.0) if self._dirt else 0.0

    def swept(self, squares: int) -> Array:
        """How much of each part of the floor is swept, as for nav_msgs/OccupancyGrid.

        Args:
            squares: of samples along the side of a part.

        Returns:
            int8 (rows, columns) of the parts: percent of what can be reached there, rounded down; -1 if nothing can.
        """
        reachable, swept = self.sweep.counts(squares)
        percent = 100 * swept.astype(np.int32) // np.maximum(reachable, 1)
        return np.where(reachable > 0, percent, -1).astype(np.int8)


def _random_dirt(plan: FloorPlan, generator: np.random.Generator) -> Array:
    """Dust on all free cells, and spots with more dirt: float32 (rows, columns)."""
    dirt = np.where(plan.free, DUST, 0.0).astype(np.float32)
    spots = math.ceil(np.count_nonzero(plan.free) * plan.resolution ** 2 / AREA_PER_SPOT)
    for share_x, share_y, radius, amount in zip(
            generator.random(spots), generator.random(spots),
            generator.uniform(*SPOT_RADIUS, spots), generator.uniform(*SPOT_DIRT, spots)):
        row, column, size = int(share_y * plan.rows), int(share_x * plan.columns), math.ceil(radius / plan.resolution)
        top, left = max(row - size, 0), max(column - size, 0)
        spot = dirt[top:row + size + 1, left:column + size + 1]
        rows, columns = np.ogrid[top - row:top - row + spot.shape[0], left - column:left - column + spot.shape[1]]
        spot += (amount * np.clip(1.0 - (rows ** 2 + columns ** 2) / max(size, 1) ** 2, 0.0, 1.0)).astype(np.float32)
    dirt[~plan.free] = 0.0
    return dirt
