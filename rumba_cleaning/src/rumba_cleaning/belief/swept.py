"""What the brush of one robot passed over, as the robot knows it from its poses."""

from typing import Optional

import numpy as np

from rumba_sim.model import kernel
from rumba_sim.model.compiled import fast
from rumba_sim.model.constants import constants
from rumba_sim.model.floor_plan import FloorPlan
from rumba_sim.model.geometry import Pose
from rumba_sim.model.kernel import Array
from rumba_sim.model.robot_config import RobotConfig

ANY_RATE = 50  # [Hz] the constants of a brush do not depend on it
LEAP = 0.5  # [m] between two poses is no drive: somebody put the robot elsewhere


class Swept:
    """A memory of the floor.

    Attributes:
        cells: uint8 (rows, columns) with the bits BLOCKED, CLIFF, REACHABLE and SWEPT of `kernel`.
    """

    def __init__(self, plan: FloorPlan, config: RobotConfig) -> None:
        """Know the walls, and nothing swept or reachable yet: `begin` follows."""
        self._plan = plan
        self._config = config
        self._constants = constants(config, plan, ANY_RATE)[0]
        self._dirt = np.zeros((plan.rows, plan.columns), np.float32)
        self._tally = np.zeros(1, kernel.TALLY)[0]
        self._brush = np.zeros(1, kernel.ROBOT)[0]
        self._last: Optional[Pose] = None
        self.cells = np.where(plan.free, 0, kernel.BLOCKED).astype(np.uint8)
        if plan.cliff is not None:
            self.cells[plan.cliff & plan.free] |= kernel.CLIFF
        self._reachable = 0

    def begin(self, x: float, y: float) -> None:
        """Forget what was swept; what can be reached is counted from (x, y) [m].

        Raises:
            MapError: the robot does not fit there.
        """
        reachable = self._plan.reachable(x, y, self._config.drive.radius, self._config.brush.width)
        self.cells &= kernel.BLOCKED | kernel.CLIFF
        self.cells[reachable] |= kernel.REACHABLE
        self._reachable = int(np.count_nonzero(reachable))
        self._tally['swept'] = 0
        self._last = None

    def copy(self) -> 'Swept':
        """Another memory that holds the same."""
        other = Swept(self._plan, self._config)
        other.cells[:] = self.cells
        other._reachable = self._reachable
        other._tally['swept'] = self._tally['swept']
        return other

    def follow(self, pose: Pose, brushes_up: bool) -> None:
        """The robot is at a pose now [m, rad], map frame; on the way there its brushes were up, or down."""
        last, self._last = self._last, pose
        if last is not None and not brushes_up and abs(pose.x - last.x) + abs(pose.y - last.y) < LEAP:
            self.sweep(last, pose)

    def sweep(self, start: Pose, end: Pose) -> None:
        """The brush went from one pose to another, not far away."""
        self._brush['x'], self._brush['y'], self._brush['theta'] = end
        fast.sweep(self._brush, self._constants, self.cells, self._dirt, self._tally, *start)

    @property
    def coverage(self) -> float:
        """Share of the reachable cells that was swept [0..1]; 1 where nothing can be reached."""
        return int(self._tally['swept']) / self._reachable if self._reachable else 1.0

    @property
    def reachable_area(self) -> float:
        """What the brush can reach [m^2]."""
        return self._reachable * self._plan.resolution ** 2

    def missed(self) -> Array:
        """Which cells are reachable and not swept yet: bool (rows, columns)."""
        return np.asarray(self.cells & (kernel.REACHABLE | kernel.SWEPT) == kernel.REACHABLE)
