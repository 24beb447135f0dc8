"""How long a mission has taken, and an estimate of how long it still takes."""

import math
from typing import Optional

from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.mission.duration import TAPER
from rumba_sim.model.settings.battery import BatteryConfig
from rumba_viewer.scene.snapshot import Battery, Cleaning, Mission

CLEANING, CHARGING, TO_DOCK = 'cleaning', 'charging', ('returning', 'docking')  # states of a mission
BEGINNING = 50.0  # [s] of cleaning until its rate is known: after 20 s it said 68 min for a mission of 27
ENOUGH = 20.0  # [s] of charging until its rate is known
GAP = 60.0  # [s] without news, after which what happened meanwhile is not counted
REST, SLOW = 0.05, 3.0  # the last share of the floor takes so many times as long: leftovers far apart (the apartment)
AIMLESS = ('wander', 'bounce', 'spiral', 'wall_follow')  # strategies by which less and less of what is swept is new
FRESH = 0.005  # share of the floor up to which a mission that is seen for the first time has just begun
LEAST = 0.12  # charge at which a robot is back on its dock, with the default reserve; measured in the apartment


class Forecast:
    """Estimates from the rates so far: floor swept, charge used and charge gained per second.

    The rates are those of this mission alone. Until the robot has charged once, the rate of charging follows from the
    currents of the default battery.

    Attributes:
        is_whole: whether the mission was seen from its beginning.
        elapsed: how long it was seen [s].
        charges: how often it charged meanwhile.
    """

    def __init__(self, target: float = CleaningConfig().target_coverage) -> None:
        """Expect missions with a target [0..1]."""
        self._target = target
        self._last: Optional[Cleaning] = None
        self._is_active = self.is_whole = False
        self._begin()

    def _begin(self) -> None:
        self.elapsed = 0.0
        self.charges = 0
        self._cleaned = self._used = self._cleaning_time = 0.0
        self._charged = self._charging_time = 0.0
        self._share = math.nan
        self._state = self._strategy = ''

    def add(self, cleaning: Cleaning, battery: Battery, mission: Mission) -> None:
        """Take what is known at one moment; moments without a new `cleaning` are ignored."""
        last, self._last = self._last, cleaning
        if last is None or cleaning.time < last.time or cleaning.distance < last.distance:  # another world
            self._begin()
            self.is_whole = last is not None
        if mission.is_active and not self._is_active:
            self._begin()
            self.is_whole = last is not None or cleaning.coverage < FRESH
        elif last is not None and self._is_active and 0.0 < cleaning.time - last.time <= GAP:
            self._count(cleaning.time - last.time, cleaning.cleaned_area - last.cleaned_area,
                        battery.share - self._share)
        if mission.state == CHARGING != self._state and self._is_active:
            self.charges += 1
        self._is_active, self._state, self._share = mission.is_active, mission.state, battery.share
        self._strategy = mission.strategy

    def _count(self, time: float, area: float, charge: float) -> None:
        self.elapsed += time
        if self._state == CLEANING and area >= 0.0 and charge <= 0.0:
            self._cleaning_time += time
            self._cleaned += area
            self._used -= charge
        elif self._state == CHARGING and charge >= 0.0:
            self._charging_time += time
            self._charged += charge

    @property
    def left(self) -> Optional[float]:
        """How long the mission still takes [s], with all charging; None: unknown, or there is no cleaning."""
        if self._strategy in AIMLESS:
            return None
        if not self._is_active or self._last is None or self._cleaning_time < BEGINNING or self._cleaned <= 0.0:
            return None
        still = max(self._target * self._last.reachable_area - self._last.cleaned_area, 0.0)
        weighted = still + (SLOW - 1.0) * min(still, REST * self._last.reachable_area)
        work = weighted / self._cleaned * self._cleaning_time
        need = work * self._used / self._cleaning_time
        full, time = CleaningConfig().charge_to, work
        if self._state == CHARGING:
            time += max(full - self._share, 0.0) * self._time_to_charge
            need -= full - LEAST
        elif self._state in TO_DOCK and still > 0.0:
            time += (full - self._share) * self._time_to_charge
            need -= full - LEAST
        else:
            need -= self._share - LEAST
        if need > 0.0:
            time += math.ceil(need / (full - LEAST)) * (full - LEAST) * self._time_to_charge
        return time if math.isfinite(time) else None

    @property
    def _time_to_charge(self) -> float:
        """Time for the whole charge [s]."""
        if self._charging_time >= ENOUGH and self._charged > 0.0:
            return self._charging_time / self._charged
        battery = BatteryConfig()
        if self._used <= 0.0:
            return 0.0
        return self._cleaning_time / self._used * TAPER * battery.cleaning_current / battery.charge_current
