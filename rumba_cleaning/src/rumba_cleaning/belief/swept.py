"""The floor that the brush of one robot has swept, computed from the poses that the robot knows."""

from typing import Optional

import numpy as np

from rumba_sim.model import kernel
from rumba_sim.model.compiled import fast
from rumba_sim.model.constants import constants
from rumba_sim.model.floor_plan import FloorPlan
from rumba_sim.model.geometry import Pose
from rumba_sim.model.kernel import Array
from rumba_sim.model.robot_config import RobotConfig

ANY_RATE = 50  # [Hz] `constants` asks for a rate, but the constants of a brush do not depend on it
# Our choice: ten times what a robot drives at the default transit speed, 0.45 m/s, from one observation to the next.
JUMP = 0.5  # [m] |dx| + |dy| from pose to pose: the robot did not drive there, somebody moved it


class Swept:
    """A memory of the floor.

    Attributes:
        cells: uint8 (rows, columns) with the bits BLOCKED, CLIFF, REACHABLE and SWEPT of `kernel`.
    """

    def __init__(self, plan: FloorPlan, config: RobotConfig) -> None:
        """Know the walls, but no cell that is reachable or swept: call `begin` next."""
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
        """Forget what was swept, and find out which cells can be reached from (x, y) [m], map frame.

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
        """A memory with the same cells, which stays as it is if this one changes."""
        other = Swept(self._plan, self._config)
        other.cells[:] = self.cells
        other._reachable = self._reachable
        other._tally['swept'] = self._tally['swept']
        return other

    def follow(self, pose: Pose, brushes_up: bool) -> None:
        """Take note of a new pose of the robot, and sweep from the pose before to this one.

        Args:
            pose: where the robot is now, map frame.
            brushes_up: whether the brushes were up since the pose before: then nothing is swept.
        """
        last, self._last = self._last, pose
        if last is not None and not brushes_up and abs(pose.x - last.x) + abs(pose.y - last.y) < JUMP:
            self.sweep(last, pose)

    def sweep(self, start: Pose, end: Pose) -> None:
        """Sweep from one pose to another that is near, map frame."""
        self._brush['x'], self._brush['y'], self._brush['theta'] = end
        fast.sweep(self._brush, self._constants, self.cells, self._dirt, self._tally, *start)

    @property
    def coverage(self) -> float:
        """Share of the reachable cells that was swept [0..1]; 1 if no cell can be reached."""
        return int(self._tally['swept']) / self._reachable if self._reachable else 1.0

    @property
    def reachable_area(self) -> float:
        """Area that the brush can reach [m^2]."""
        return self._reachable * self._plan.resolution ** 2

    def missed(self) -> Array:
        """Which cells can be reached and were not swept: bool (rows, columns)."""
        return np.asarray(self.cells & (kernel.REACHABLE | kernel.SWEPT) == kernel.REACHABLE)
