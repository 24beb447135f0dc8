"""undock: off the contacts backward, then turn away from the dock."""

import math
from typing import Optional

from rumba_cleaning.behaviour import Behaviour, Command, Observation
from rumba_cleaning.behaviours.follower import Turn
from rumba_cleaning.belief.context import Context
from rumba_sim.model.geometry import Pose, wrap_angle

WAY = 0.4  # [m] backward (create3_sim)
SPEED = 0.2  # [m/s]
PATIENCE = 4.0  # [s] without moving: something is behind the robot
PROGRESS = 0.005  # [m] in an update


class Undock(Behaviour):
    """Leaves the dock; a robot that stands free has done so already."""

    def __init__(self, context: Context, turns: bool = True) -> None:
        """Back off, and turn by half a turn where `turns` is true."""
        self._context = context
        self._turns = turns
        self.initialise()

    def initialise(self) -> None:
        """Begin by backing off."""
        super().initialise()
        self._start: Optional[Pose] = None
        self._turn: Optional[Turn] = None
        self._way = 0.0
        self._waited = 0.0

    @property
    def remaining(self) -> float:
        """Way left backward [m]."""
        return max(WAY - self._way, 0.0)

    def update(self, observation: Observation) -> Command:
        """Back, turn."""
        pose = observation.pose
        if self._turn is not None:
            rate = self._turn.update(pose, observation.dt)
            return self.succeed('free') if self._turn.is_done else Command(0.0, rate, brushes_up=True)
        if self._start is None:
            if not observation.is_docked:
                return self.succeed('was not docked')
            self._start = pose
        way = math.hypot(pose.x - self._start.x, pose.y - self._start.y)
        self._waited = 0.0 if way > self._way + PROGRESS else self._waited + observation.dt
        self._way = max(way, self._way)
        is_blocked = self._waited > PATIENCE
        if is_blocked and observation.is_docked:
            return self.fail('something behind the robot keeps it on the dock')
        if is_blocked or self._way >= WAY:
            if not self._turns:
                return self.succeed('free')
            self._turn = Turn(wrap_angle(pose.theta + math.pi), self._context.robot.drive)
        return Command(-SPEED, 0.0, brushes_up=True)
