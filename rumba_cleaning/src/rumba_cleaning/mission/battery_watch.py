"""How long the charge lasts, as the robot measures it, and whether that is enough for the way to the dock."""

import math
from concurrent.futures import Future
from typing import Optional, Tuple

import numpy as np

from rumba_cleaning.behaviour import Observation
from rumba_cleaning.behaviours.dock import approach
from rumba_cleaning.belief import paths
from rumba_cleaning.belief.context import Context
from rumba_sim.model.common.errors import MapError
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.kernel import Array

DOCKING = 40.0  # [s] from before the dock onto its contacts; the median of bench/docking.py is 31 s
SLOWNESS = 1.6  # times longer than its length at full speed the drive to the dock takes at most, with turns and detours
FALL = 0.05  # of the charge: a smaller fall is no measurement, since a battery may report whole percents


class BatteryWatch:
    """Measures the rate of discharge, and knows the length of the path to the dock from everywhere.

    Attributes:
        has_home: whether there is a dock with enough space before it.
    """

    def __init__(self, context: Context) -> None:
        """Assume the loads of the robot's settings until its charge falls faster."""
        self._context = context
        battery = context.robot.battery
        self._usual = battery.discharge_rate(battery.cleaning_current)  # [1/s]
        self._rate = self._usual
        self._since: Optional[float] = None  # state of charge when it began to fall
        self._time = 0.0  # [s] since then
        self._measure_ways()

    def _measure_ways(self) -> None:
        """Have the lengths of the paths to the dock computed, on the plan as it is now."""
        self._lengths: 'Optional[Future[Tuple[Array, float]]]' = None  # see `_lengths_to`
        self._newer: 'Optional[Future[Tuple[Array, float]]]' = None  # that will take their place
        self._plan, self._home = self._context.plan, self._context.home
        self._fits = self._context.ground.fits
        try:
            self._goal = approach(self._context)
        except MapError:
            self.has_home = False
        else:
            self.has_home = True
            self._lengths = self._context.submit(_lengths_to, self._goal)

    @property
    def is_ready(self) -> bool:
        """Whether the lengths of the paths are computed, so that `needed` can answer.

        For a newer plan, or another home, they are computed again.
        """
        if self._plan is not self._context.plan or self._home != self._context.home:
            self._measure_ways()
        return self._lengths is None or self._lengths.done()

    def measure(self, observation: Observation) -> None:
        """Measure the rate from the charge and the time since it began to fall."""
        if observation.is_docked or self._since is None or observation.state_of_charge > self._since:
            self._since, self._time = observation.state_of_charge, 0.0
            return
        self._time += observation.dt
        if self._since - observation.state_of_charge >= FALL:
            self._rate = max(self._usual, (self._since - observation.state_of_charge) / self._time)

    def needed(self, pose: Pose) -> float:
        """State of charge that is enough to reach the dock from a pose, with the reserve; inf if no path leads there.

        It waits for the lengths of the paths if they are not ready.
        """
        return math.inf if self._lengths is None else self._needed_for(self._length(self._lengths, pose))

    def look(self, pose: Pose) -> None:
        """Have the paths measured again, beside the steps, if none led from a pose and the ground has changed since."""
        if self._lengths is None:
            return
        self._take_newer()
        fits = self._context.ground.fits
        if self._newer is None and self._fits is not fits and not math.isfinite(self._length(self._lengths, pose)):
            self._fits = fits
            self._newer = self._context.submit(_lengths_to, self._goal)
            self._take_newer()

    def _take_newer(self) -> None:
        if self._newer is not None and self._newer.done():
            self._lengths, self._newer = self._newer, None

    @property
    def is_looking(self) -> bool:
        """Whether the paths are being measured again."""
        return self._newer is not None

    def _length(self, lengths: 'Future[Tuple[Array, float]]', pose: Pose) -> float:
        return float(lengths.result()[0][self._context.ground.standing_at(pose.x, pose.y)])

    def is_enough_anywhere(self, state_of_charge: float) -> bool:
        """Whether a charge is enough wherever a path leads to the dock, so that `needed` need not be asked.

        It waits, too.
        """
        return self._lengths is not None and state_of_charge >= self._needed_for(self._lengths.result()[1])

    def _needed_for(self, length: float) -> float:
        """State of charge for a path to the dock of a length [m], with the reserve."""
        config = self._context.config
        return self._rate * (SLOWNESS * length / config.transit_speed + DOCKING) + config.reserve


def _lengths_to(context: Context, goal: Pose) -> Tuple[Array, float]:
    """Lengths of the paths from each node to a goal [m], inf where none leads there, and the longest one."""
    lengths = paths.lengths_to(context.ground, goal.x, goal.y)
    return lengths, float(np.max(lengths, where=np.isfinite(lengths), initial=0.0))
