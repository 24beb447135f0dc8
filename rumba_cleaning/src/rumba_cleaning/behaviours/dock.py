"""dock: home, by the infrared beams if they are received, by the map from anywhere else."""

import math
from typing import Optional

from rumba_cleaning.behaviour import Behaviour, Command, Observation, Status
from rumba_cleaning.behaviours.go_to import GoTo
from rumba_cleaning.behaviours.homing import BUOYS, Homing
from rumba_cleaning.belief.context import Context
from rumba_cleaning.route import Ahead
from rumba_sim.model.errors import MapError
from rumba_sim.model.geometry import Pose

STEP = 0.05  # [m]
BEFORE = (16, 14, 12, 10, 8, 6)  # steps from the dock to the point on its axis at which homing begins: the most that
#                                  are free; bench/docking.py brings all robots home from there
TRIES = 3  # our choice: a robot that stands in the way has left after that, or stays


class Dock(Behaviour):
    """Drives onto the contacts with the brushes up."""

    _part: Optional[Behaviour] = None

    def __init__(self, context: Context) -> None:
        """Go to the dock that is the robot's home.

        Raises:
            MapError: the plan has no dock, or the robot fits nowhere before it.
        """
        self._context = context
        self._approach = approach(context)

    def initialise(self) -> None:
        """Begin with what is received."""
        self._part = None
        self._tries = 0

    @property
    def is_homing(self) -> bool:
        """Whether the beams guide it now."""
        return isinstance(self._part, Homing)

    @property
    def remaining(self) -> float:
        """Distance left to the point before the dock [m]; NaN if it is not known."""
        return self._part.remaining if isinstance(self._part, GoTo) else math.nan

    def update(self, observation: Observation) -> Command:
        """Go to the point before the dock, then home; if that fails, try again."""
        if observation.is_docked:
            return self.succeed('docked')
        if self._part is None:
            self._part = Homing(self._context) if observation.infrared.omni & BUOYS else GoTo(
                self._context, self._approach)
        command = self._part.step(observation)
        self.message = self._part.message
        if self._part.status is Status.RUNNING:
            return command
        outcome = self._part.outcome
        if isinstance(self._part, GoTo):
            if self._part.status is Status.FAILED:
                return self.fail(f'cannot get to the dock: {self._part.message}', outcome)
            self._part = Homing(self._context)
        else:
            self._part = GoTo(self._context, self._approach)
            self._tries += 1
            if self._tries >= TRIES:
                return self.fail(f'{TRIES} attempts to dock failed: {self.message}', outcome)
        return Command(0.0, 0.0, brushes_up=True)

    def terminate(self) -> None:
        """Stop the part that is under way."""
        if self._part is not None:
            self._part.stop()

    def take_note(self, observation: Observation) -> None:
        """Choose between beams and map again, wherever the robot will be."""
        if self._part is not None:
            self._part.stop()
        self._part = None

    def plan_ahead(self) -> Optional[Ahead]:
        """The plan of the part that is under way."""
        return None if self._part is None else self._part.plan_ahead()


def approach(context: Context) -> Pose:
    """Where a robot stands before the dock, and faces it.

    Raises:
        MapError: the plan has no dock, or the robot fits nowhere before it.
    """
    dock = context.home
    if dock is None:
        raise MapError(f'{context.plan.name}: no dock on the map: its YAML file may name one, dock: [x, y, theta]')
    for steps in BEFORE:
        line = [Pose(dock.x - step * STEP * math.cos(dock.theta), dock.y - step * STEP * math.sin(dock.theta),
                     dock.theta) for step in range(1, steps + 1)]
        if all(context.plan.safe_clearance_at(pose.x, pose.y) > context.ground.reach for pose in line):
            return line[-1]
    raise MapError(f'{context.plan.name}: too little space before the dock at ({dock.x:.2f}, {dock.y:.2f}) m: '
                   f'a robot of radius {context.robot.drive.radius:.3f} m cannot drive up to it')
