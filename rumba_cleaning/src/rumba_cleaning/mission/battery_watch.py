"""How long the charge lasts, as the robot sees it fall, and whether that is enough for the way home."""

from typing import Optional

from rumba_cleaning.behaviour import Observation
from rumba_cleaning.behaviours.dock import approach
from rumba_cleaning.belief.context import Context
from rumba_sim.model.errors import MapError
from rumba_sim.model.geometry import Pose

DOCKING = 40.0  # [s] from before the dock onto its contacts
SLOWNESS = 1.6  # so many times longer than its length at full speed a way home takes at most
SHORTEST = 2.0  # [s] over which a fall of the charge says something
SECONDS = 3600.0  # in an hour


class BatteryWatch:
    """Measures the rate of discharge, and knows the way home from everywhere.

    Attributes:
        has_home: whether there is a dock with room before it.
    """

    def __init__(self, context: Context) -> None:
        """Count with the loads that a robot is known for until its charge falls faster."""
        self._context = context
        battery = context.robot.battery
        load = battery.idle_current + battery.wheel_current + battery.brush_current
        self._rate = load * battery.drain / (battery.capacity * SECONDS)  # [1/s] of the state of charge
        self._since: Optional[float] = None  # state of charge when it began to fall
        self._time = 0.0  # [s] since then
        try:
            place = approach(context)
        except MapError:
            self.has_home = False
        else:
            self.has_home = True
            self._lengths = context.ground.lengths_to(place.x, place.y)

    def update(self, observation: Observation) -> None:
        """Take note of the charge."""
        if observation.is_docked or self._since is None or observation.state_of_charge > self._since:
            self._since, self._time = observation.state_of_charge, 0.0
            return
        self._time += observation.dt
        if self._time > SHORTEST:
            self._rate = max(self._rate, (self._since - observation.state_of_charge) / self._time)

    def needed(self, pose: Pose) -> float:
        """State of charge that takes the robot home from here, with the reserve; inf where no way leads home."""
        if not self.has_home:
            return float('inf')
        config = self._context.config
        length = float(self._lengths[self._context.ground.standing_at(pose.x, pose.y)])
        seconds = SLOWNESS * length / config.transit_speed + DOCKING
        return self._rate * seconds + config.reserve
