"""The floor that the brushes of a robot and its mates have swept, computed from the poses that the robot knows."""

import copy
import math
from typing import Callable, Dict, Optional, Sequence, Tuple

import numpy as np

from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.floors.sweep import Brush, Part, Sweep
from rumba_sim.model.kernel import Array
from rumba_sim.model.maps.floor_plan import FloorPlan
from rumba_sim.model.settings.robot_config import RobotConfig

# Our choice: ten times what a robot drives at the default transit speed, 0.45 m/s, from one observation to the next.
JUMP = 0.5  # [m] |dx| + |dy| from pose to pose: the robot did not drive there, somebody moved it
MOST = 0.5  # share of a cell's area, from which on the cell is missed: less is the rim of what was swept
FEW = 0.001  # of what can be reached: so little behind straits is left to the rest of the floor; our choice


class Swept:
    """A memory of the floor; nothing is reachable in it until `begin`.

    Attributes:
        start: from where it was counted what can be reached, x and y [m], map frame.
        planned: share of that [0..1] which robots plan to reach: they do not plan their way through straits.
    """

    def __init__(self, plan: FloorPlan, config: RobotConfig, is_exact: bool = True) -> None:
        """Remember a floor by its refined plan, which is exact or, if the robot makes it, not quite."""
        self._config = config
        self._is_exact = is_exact
        self._sweep = Sweep(plan, config, is_exact)
        self._last: Dict[str, Pose] = {}  # by the name of the robot
        self.start = math.nan, math.nan
        self.planned = 1.0

    def begin(self, x: float, y: float) -> None:
        """Forget what was swept, and find out what can be reached from (x, y) [m], map frame.

        Raises:
            MapError: the robot does not fit there.
        """
        self._sweep.begin(x, y)
        self._last = {}
        self.start = x, y
        self.planned = self._sweep.planned(x, y)

    def learn(self, plan: FloorPlan, points: Sequence[Tuple[float, float]],
              way_back: Optional[Callable[[Array], Array]] = None) -> None:
        """Go on with a newer plan of the same floor: what counts is what can be reached on that.

        Args:
            plan: of any cells.
            points: where the robot fits, map frame [m]: that counts from which most can be reached, since others may
                lie in nooks that the plan shows too narrow.
            way_back: if the map was redrawn, where on it was before what is at points now: (any, 2) [m].
        """
        before, self._sweep = self._sweep, Sweep(plan, self._config, self._is_exact)
        self.start = max(points, key=self._count_from)
        self._sweep.begin(*self.start)
        self._sweep.take_over(before, way_back)
        if way_back is not None:
            self._last = {}

    def _count_from(self, point: Tuple[float, float]) -> int:
        """How many samples can be reached from a point."""
        self._sweep.begin(*point)
        return self._sweep.reachable

    def copy(self) -> 'Swept':
        """A memory of the same floor, which stays as it is if this one changes, and has no last pose."""
        other = copy.copy(self)
        other._sweep, other._last = self._sweep.copy(), {}
        return other

    def follow(self, pose: Pose, brushes_up: bool, mate: str = '') -> None:
        """Take note of a new pose of the robot or of a mate, and sweep from the pose before to this one.

        Args:
            pose: where it is now, map frame.
            brushes_up: whether its brushes were up since the pose before: then nothing is swept.
            mate: its name; empty: the robot itself.
        """
        last = self._last.get(mate)
        self._last[mate] = pose
        if last is not None and not brushes_up and abs(pose.x - last.x) + abs(pose.y - last.y) < JUMP:
            self.sweep(last, pose)

    def sweep(self, start: Pose, end: Pose) -> None:
        """Sweep from one pose to another that is near, map frame."""
        self.sweep_all(np.array([start]), np.array([end]))

    def sweep_all(self, starts: Array, ends: Array) -> None:
        """Sweep from poses to others that are near, map frame.

        Args:
            starts, ends: x [m], y [m] and theta [rad] of each, float64 (any, 3).
        """
        self._sweep.pass_over(starts, ends)

    @property
    def has_straits(self) -> bool:
        """Whether more than FEW of what can be reached lies behind straits."""
        return self.planned < 1.0 - FEW

    @property
    def coverage(self) -> float:
        """Share of the reachable floor that was swept [0..1]; 1 if nothing can be reached."""
        return self._sweep.coverage

    @property
    def brush(self) -> Brush:
        """What the kernel sweeps this floor with: what that sweeps counts here."""
        return self._sweep.brush

    @property
    def reachable(self) -> int:
        """Number of samples that the brush can reach."""
        return self._sweep.reachable

    def within(self, clearance: Array, x: float, y: float) -> Part:
        """What a robot plans to reach on the same floor with less clearance.

        Args:
            clearance: as `FloorPlan.safe_clearance` [m].
            x, y: from where, map frame [m].
        """
        return self._sweep.within(clearance, x, y)

    @property
    def reachable_area(self) -> float:
        """Area that the brush can reach [m^2]."""
        return self._sweep.reachable_area

    def missing_share(self) -> Array:
        """Share of each cell's area that can be reached and was not swept [0..1]: float32 (rows, columns)."""
        return self._sweep.missing_share()

    def missed(self) -> Array:
        """Cells of which at least the share MOST can be reached and was not swept: bool (rows, columns)."""
        return np.asarray(self.missing_share() >= MOST)
