"""Follows the mission of a robot: how long it takes, what is left of it, and how it ended."""

import math
from typing import Optional, Tuple

from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_viewer.scene import wording
from rumba_viewer.scene.forecast import Forecast
from rumba_viewer.scene.snapshot import Battery, Cleaning, Mission

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
            self.report = tuple(wording.closing(self._robot, self.mission, cleaning, self._began, battery,
                                                self._forecast))

    @property
    def elapsed(self) -> Optional[float]:
        """How long the mission takes already [s]; None without one, or if its beginning was not seen."""
        is_known = self.mission is not None and self.mission.is_active and self._forecast.is_whole
        return self._forecast.elapsed if is_known else None

    @property
    def left(self) -> Optional[float]:
        """How long the cleaning still takes [s]; None: unknown, or there is none."""
        return self._forecast.left if self.mission is not None and self.mission.is_cleaning else None
