"""How a robot that edges hold gets away from them, if the behaviour that is in charge finds no way."""

import math
from typing import Callable, Iterable, Optional, Tuple

import numpy as np

from rumba_cleaning.behaviour import Command
from rumba_cleaning.behaviours.compiled_guard import Wheels
from rumba_cleaning.behaviours.preview import Preview
from rumba_cleaning.behaviours.slip import NO_SLIP, Slip
from rumba_cleaning.belief.footing import Footing
from rumba_sim.model.geometry import Pose

# All figures below are our choice.
PATIENCE = 2.0  # [s] held by edges, after which it looks for a way out
SLOW = 0.1  # [m/s]
WAYS_OUT = [(v, w) for v in (0.0, -SLOW, SLOW) for w in (0.25, -0.25, 0.5, -0.5, 1.0, -1.0)]  # [m/s], [rad/s]
AHEAD = 50  # [steps of a path] that it is looked at: 1 s
RESERVE = 0.01  # [m] from a wheel to an edge on it
CREEP = 1e-4  # [m] by which an edge may come nearer all the same: rounding
GAIN = 3e-3  # [m] that it brings at least
ELSEWHERE = 0.3  # [m] from where edges held the robot


class Release:
    """Watches one robot.

    Attributes:
        held_time: for how long edges have kept the robot, about where it is, from what it was to do [s].
    """

    def __init__(self, footing: Footing, preview: Preview, guess: int) -> None:
        """Watch a robot that knows this floor, and takes so many cells beside it for floor too."""
        self._footing, self._preview, self._guess = footing, preview, guess
        self.rest()

    def rest(self) -> None:
        """Edges do not hold the robot."""
        self._held_at: Optional[Pose] = None
        self._leaves_at = PATIENCE  # after what `held_time` it looks for a way out
        self._is_leaving = False  # whether it is on one
        self.held_time = 0.0

    def is_due(self, pose: Pose, is_held: bool, seconds: float) -> bool:
        """Whether to look for a way out, at a pose to which it came so long after the one before [s]."""
        at = self._held_at
        if at is not None and math.hypot(pose.x - at.x, pose.y - at.y) > ELSEWHERE:
            self.rest()
        if is_held:
            self._held_at = self._held_at or pose
            self.held_time += seconds
        if self.held_time > self._leaves_at:
            self._is_leaving = True
            self._leaves_at = self.held_time + PATIENCE
        return self._is_leaving

    def way_out(self, pose: Pose, speeds: Wheels, slips: Callable[[Wheels], Iterable[Slip]],
                may_back: bool) -> Optional[Command]:
        """The slow command that brings the wheels farther from edges than others; None: there is none.

        Args:
            pose: of the robot.
            speeds: of its wheels [m/s].
            slips: tells how it may slide with wheels that are to be so fast [m/s].
            may_back: whether there is nothing behind it.
        """
        best, most = None, self._ways(pose, speeds, (0.0, 0.0), NO_SLIP)[0]
        reserve = min(most - CREEP, RESERVE)
        most += GAIN
        for command in (Command(v, w) for v, w in WAYS_OUT if v >= 0.0 or may_back):
            wanted = self._preview.wanted(command)
            ends, leasts = zip(*(self._ways(pose, speeds, wanted, slip) for slip in slips(wanted)))
            if min(ends) > most and min(leasts) >= reserve:
                best, most = command, min(ends)
        self._is_leaving = best is not None
        return best

    def _ways(self, pose: Pose, speeds: Wheels, wanted: Wheels, slip: Slip) -> Tuple[float, float]:
        """How near to an edge a wheel is in the end, after a command, and at the least [m]; 0 over unknown floor."""
        _, left, right = self._preview.path(pose, speeds, wanted, slip, AHEAD)
        if not self._footing.are_known(np.concatenate([left, right]), self._guess):
            return 0.0, 0.0
        near = np.minimum(self._footing.clearances(left), self._footing.clearances(right))
        return float(near[-1]), float(near.min())
