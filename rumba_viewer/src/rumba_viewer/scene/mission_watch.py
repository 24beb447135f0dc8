"""Follows the mission of a robot: how long it takes, what is left of it, and how it ended."""

import math
from typing import Optional, Tuple

from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_viewer.scene import wording
from rumba_viewer.scene.forecast import Forecast
from rumba_viewer.scene.snapshot import Battery, Cleaning, Mission
from rumba_viewer.scene.wording import Effort

UNKNOWN = Battery(math.nan, math.nan, math.nan, '')


class MissionWatch:
    """Takes what a robot tells, in one thread at a time.

    Attributes:
        cleaning, battery, mission: told last; None before.
        report: lines about the last cleaning since it ended; empty before, and while there is another mission.
    """

    def __init__(self, robot: str, target: float = CleaningConfig().target_coverage) -> None:
        """Watch a robot by its name, whose missions have a target [0..1]."""
        self._robot = robot
        self._forecast = Forecast(target)
        self._began: Optional[Cleaning] = None  # when the mission began
        self._goal_came: Optional[float] = None  # when the last goal of cleaning came [s]
        self._ended: Optional[float] = None  # time of the last figures before the end [s], until there are newer ones
        self.cleaning: Optional[Cleaning] = None
        self.battery: Optional[Battery] = None
        self.mission: Optional[Mission] = None
        self.report: Tuple[str, ...] = ()

    def take_battery(self, battery: Battery) -> None:
        """Take a reading of the battery."""
        self.battery = battery

    def take_mission(self, mission: Mission) -> None:
        """Take what the cleaner does."""
        last, self.mission = self.mission, mission
        if mission.is_active:
            self.report, self._ended = (), None
        if mission.is_cleaning and not (last is not None and last.is_cleaning):
            self._began = self.cleaning
        if last is not None and last.is_cleaning and not mission.is_active:
            self._ended = self.cleaning.time if self.cleaning is not None else -math.inf

    def take_goal(self, came: Optional[float]) -> None:
        """Take when the last goal of cleaning came [s]; None: there was none for a while."""
        self._goal_came = came

    def take_cleaning(self, cleaning: Cleaning) -> None:
        """Take the figures of the floor."""
        last, self.cleaning = self.cleaning, cleaning
        if last is not None and cleaning.distance < last.distance:  # the world was reset
            self.report = ()
        if self.mission is None:
            return
        battery = self.battery or UNKNOWN
        self._forecast.add(cleaning, battery, self.mission)
        if self._ended is not None and cleaning.time > self._ended:
            self._ended = None
            self.report = tuple(wording.closing(self._robot, self.mission, cleaning, battery, self._effort(cleaning)))

    def _effort(self, cleaning: Cleaning) -> Effort:
        """What the mission took that has just ended with these figures."""
        if not self._forecast.is_whole:
            return Effort(self._since_goal)
        driven = cleaning.distance - (self._began.distance if self._began is not None else 0.0)
        return Effort(self._forecast.elapsed, max(driven, 0.0), self._forecast.charges)

    @property
    def elapsed(self) -> Optional[float]:
        """How long the mission takes already [s]; None without one, or if nobody tells when it began."""
        if self.mission is None or not self.mission.is_active:
            return None
        if self._forecast.is_whole:
            return self._forecast.elapsed
        return self._since_goal if self.mission.is_cleaning else None

    @property
    def _since_goal(self) -> Optional[float]:
        """Time since the last goal of cleaning came [s]: also in a window that was opened later."""
        if self._goal_came is None or self.cleaning is None or not self.cleaning.time >= self._goal_came:
            return None
        return self.cleaning.time - self._goal_came

    @property
    def left(self) -> Optional[float]:
        """How long the cleaning still takes [s]; None: unknown, or there is none."""
        return self._forecast.left if self.mission is not None and self.mission.is_cleaning else None
