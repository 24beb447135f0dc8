"""dock: home, by the infrared beams where they are received, by the map from anywhere else."""

import math
from typing import Optional

from rumba_cleaning.behaviour import Behaviour, Command, Observation, Status
from rumba_cleaning.behaviours.go_to import GoTo
from rumba_cleaning.behaviours.homing import BUOYS, Homing
from rumba_cleaning.belief.context import Context
from rumba_sim.model.errors import MapError
from rumba_sim.model.geometry import Pose

STEP = 0.05  # [m]
BEFORE = (16, 14, 12, 10, 8, 6)  # steps before the dock, on its axis: homing begins where all the way is free
TRIES = 3


class Dock(Behaviour):
    """Drives onto the contacts with the brushes up."""

    def __init__(self, context: Context) -> None:
        """Go to the dock of the plan.

        Raises:
            MapError: the plan has no dock, or the robot fits nowhere before it.
        """
        self._context = context
        self._approach = approach(context)
        self.initialise()

    def initialise(self) -> None:
        """Begin with what is received."""
        super().initialise()
        self._part: Optional[Behaviour] = None
        self._tries = 0

    @property
    def is_homing(self) -> bool:
        """Whether it is guided by the beams now."""
        return isinstance(self._part, Homing)

    @property
    def remaining(self) -> float:
        """Way left to the place before the dock [m]; NaN where it is not known."""
        return self._part.remaining if isinstance(self._part, GoTo) else math.nan

    def update(self, observation: Observation) -> Command:
        """To the place before the dock, then home; again, where that fails."""
        if observation.is_docked:
            return self.succeed('docked')
        if self._part is None:
            self._part = Homing(self._context) if observation.infrared.omni & BUOYS else GoTo(
                self._context, self._approach)
        command = self._part.update(observation)
        self.message = self._part.message
        if self._part.status is Status.RUNNING:
            return command
        if isinstance(self._part, GoTo):
            if self._part.status is Status.FAILED:
                return self.fail(f'cannot get to the dock: {self._part.message}')
            self._part = Homing(self._context)
        else:
            self._part = GoTo(self._context, self._approach)
            self._tries += 1
            if self._tries >= TRIES:
                return self.fail(f'{TRIES} attempts to dock failed: {self.message}')
        return Command(0.0, 0.0, brushes_up=True)


def approach(context: Context) -> Pose:
    """Where a robot stands before the dock, and faces it.

    Raises:
        MapError: the plan has no dock, or the robot fits nowhere before it.
    """
    dock = context.plan.dock
    if dock is None:
        raise MapError(f'{context.plan.name}: no dock on the map: its YAML file may name one, dock: [x, y, theta]')
    for steps in BEFORE:
        line = [Pose(dock.x - step * STEP * math.cos(dock.theta), dock.y - step * STEP * math.sin(dock.theta),
                     dock.theta) for step in range(1, steps + 1)]
        if all(context.plan.safe_clearance_at(pose.x, pose.y) > context.ground.reach for pose in line):
            return line[-1]
    raise MapError(f'{context.plan.name}: no room before the dock at ({dock.x:.2f}, {dock.y:.2f}) m: '
                   f'a robot of radius {context.robot.drive.radius:.3f} m cannot drive up to it')
