"""undock: off the contacts backward, then turn away from the dock."""

import math
from typing import Optional

from rumba_cleaning.behaviour import Behaviour, Command, Observation
from rumba_cleaning.behaviours.follower import Turn
from rumba_cleaning.behaviours.travel import LONGEST
from rumba_cleaning.belief.context import Context
from rumba_cleaning.outcome import Outcome
from rumba_sim.model.common.geometry import Pose, hypot, wrap_angle

DISTANCE = 0.4  # [m] backward (create3_sim)
SPEED = 0.2  # [m/s]
PATIENCE = 4.0  # [s] without progress, twice what the whole distance takes: something is behind the robot
PROGRESS = 0.005  # [m] from one update to the next: a quarter of what SPEED gives


class Undock(Behaviour):
    """Leaves the dock; a robot that is not docked has done so already."""

    _driven = 0.0  # [m]

    def __init__(self, context: Context, turns: bool = True) -> None:
        """Back off, and then, if `turns` is true, turn by half a turn."""
        self._context = context
        self._turns = turns

    def initialise(self) -> None:
        """Begin by backing off."""
        self._start: Optional[Pose] = None
        self._turn: Optional[Turn] = None
        self._driven = 0.0
        self._waited = 0.0

    @property
    def remaining(self) -> float:
        """Distance left backward [m]."""
        return max(DISTANCE - self._driven, 0.0)

    def update(self, observation: Observation) -> Command:
        """Back, turn."""
        pose = observation.pose
        if self._turn is not None:
            rate = self._turn.rate(pose, observation.dt)
            return self.succeed('free') if self._turn.is_done else Command(0.0, rate, brushes_up=True)
        if self._start is None:
            if not observation.is_docked:
                return self.succeed('was not docked')
            self._start = pose
        driven = hypot(pose.x - self._start.x, pose.y - self._start.y)
        self._waited = 0.0 if driven > self._driven + PROGRESS else self._waited + min(observation.dt, LONGEST)
        self._driven = max(driven, self._driven)
        is_blocked = self._waited > PATIENCE
        if is_blocked and observation.is_docked:
            return self.fail(self._why(), Outcome.BLOCKED)
        if is_blocked or self._driven >= DISTANCE:
            if not self._turns:
                return self.succeed('free')
            self._turn = Turn(wrap_angle(pose.theta + math.pi), self._context.robot.drive)
        return Command(-SPEED, 0.0, brushes_up=True)

    def _why(self) -> str:
        """What keeps the robot on the dock."""
        drive = self._context.robot.drive
        if min(SPEED, drive.max_speed) < drive.dead_band:
            return (f'the wheels do not turn: drive/max_speed is {drive.max_speed:g} m/s, and below drive/dead_band, '
                    f'{drive.dead_band:g} m/s, they stand still')
        return 'something behind the robot keeps it on the dock'

    def take_note(self, observation: Observation) -> None:
        """Measure the distance again: the person may have brought the robot back."""
        self._driven = self._waited = 0.0
