"""The state of the floor: which cells are swept, and how much dirt is left in each."""

import math

import numpy as np

from rumba_sim.model import kernel
from rumba_sim.model.floor_plan import FloorPlan
from rumba_sim.model.geometry import Pose
from rumba_sim.model.kernel import Array
from rumba_sim.model.robot_config import RobotConfig

DUST = 0.3  # dirt in a cell outside all spots
AREA_PER_SPOT = 2.0  # [m^2] of free floor for each spot of dirt
SPOT_RADIUS = (0.1, 0.4)  # [m]
SPOT_DIRT = (1.0, 4.0)  # in the centre of a spot, in addition to the dust


class Floor:
    """The floor of a plan that can be cleaned, and how far it is clean.

    Attributes:
        cells: uint8 (rows, columns), the bits BLOCKED, CLIFF, CARPET, REACHABLE, SWEPT of `kernel`.
        dirt: float32 (rows, columns), 0 in a clean cell.
        tally: array of one record (`kernel.TALLY`): number of swept reachable cells, and dirt left on reachable cells.
    """

    def __init__(self, plan: FloorPlan, config: RobotConfig, start: Pose, generator: np.random.Generator) -> None:
        """Create an unswept floor with random dirt.

        Args:
            plan: the floor plan.
            config: of the robots, whose radius and brush decide which cells are reachable.
            start: pose [m, rad], map frame, from which cells are reachable.
            generator: source of the random dirt.

        Raises:
            MapError: a robot does not fit at the start.
        """
        reachable = plan.reachable(start.x, start.y, config.drive.radius, config.brush.width)
        self.cells = np.where(plan.free, 0, kernel.BLOCKED).astype(np.uint8)
        self.cells[reachable] |= kernel.REACHABLE
        for layer, bit in ((plan.cliff, kernel.CLIFF), (plan.carpet, kernel.CARPET)):
            if layer is not None:
                self.cells[layer & plan.free] |= bit
        self.dirt = _random_dirt(plan, generator)
        self._reachable = int(np.count_nonzero(reachable))
        self._dirt = float(np.sum(self.dirt[reachable], dtype=np.float64))
        self._cell_area = plan.resolution ** 2
        self.tally = np.zeros(1, kernel.TALLY)
        self.tally[0]['dirt'] = self._dirt

    @property
    def reachable_area(self) -> float:
        """Area that the brush can reach [m^2]."""
        return self._reachable * self._cell_area

    @property
    def cleaned_area(self) -> float:
        """Part of the reachable area that was swept at least once [m^2]."""
        return int(self.tally[0]['swept']) * self._cell_area

    @property
    def coverage(self) -> float:
        """cleaned_area / reachable_area [0..1]; 1 if nothing is reachable."""
        return int(self.tally[0]['swept']) / self._reachable if self._reachable else 1.0

    @property
    def dirt_left(self) -> float:
        """Share of the dirt on reachable cells that is still there [0..1]."""
        return min(max(float(self.tally[0]['dirt']) / self._dirt, 0.0), 1.0) if self._dirt else 0.0

    def swept(self) -> Array:
        """int8 (rows, columns), as for nav_msgs/OccupancyGrid: 100 swept, 0 not swept, -1 not reachable."""
        swept = np.where(self.cells & kernel.SWEPT, 100, 0).astype(np.int8)
        swept[self.cells & kernel.REACHABLE == 0] = -1
        return swept


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
