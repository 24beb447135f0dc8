"""dock: home, by the infrared beams if they are received, by the map from anywhere else."""

import contextlib
import math
from typing import Dict, List, Optional, Union

import numpy as np

from rumba_cleaning.behaviour import STOP, Behaviour, Command, Observation, Status
from rumba_cleaning.behaviours.go_to import GoTo
from rumba_cleaning.behaviours.homing import BUOYS, FAR_SPEED, Homing
from rumba_cleaning.behaviours.own_beams import own_beams
from rumba_cleaning.behaviours.self_docking import SelfDocking
from rumba_cleaning.belief.context import Context
from rumba_cleaning.belief.mates import Task
from rumba_cleaning.belief.places import places_apart
from rumba_cleaning.outcome import Outcome
from rumba_cleaning.route import Ahead, Route
from rumba_sim.model.common.errors import MapError
from rumba_sim.model.common.geometry import Pose, hypot
from rumba_sim.model.kernel import Array

STEP = 0.05  # [m]
BEFORE = (16, 14, 12, 10, 8, 6)  # steps from the dock to the point on its axis at which homing begins: the most that
#                                  are free; bench/docking.py brings all robots home from there
CLOSER = (5, 4)  # the same if only a robot that is docked nearby stands in the way; as near as it can turn
BERTH = 0.5  # [m] from the dock, within which a mate occupies it: our choice, more than a robot's width
CLOSE = 1.0  # [m] from the dock, within which a robot with mates follows the beams: mates cannot know where to
STANDING = (Task.DOCKED, Task.OFF, Task.SEEKING)  # at a dock; others pass by
POLITE = 0.6  # [m] from the line on which robots drive up to the dock and leave it: our choice, they pass there
FARTHEST = 4.0  # [m] to a place to wait for the dock; our choice
APART = 0.02  # [m] to a mate that stands at a dock, at least; our choice
TRIES = 3  # our choice: a robot that stands in the way has left after that, or stays


class Dock(Behaviour):
    """Drives onto the contacts with the brushes up."""

    _part: Optional[Behaviour] = None
    is_taken = False  # by a mate that has ended its work there

    def __init__(self, context: Context) -> None:
        """Go to the dock that is the robot's home.

        Raises:
            MapError: the plan has no dock, or the robot fits nowhere before it.
        """
        self._context = context
        self._head_for_home()
        self._away = 0.0  # [m] from the dock

    def _head_for_home(self) -> None:
        """Find the way to the dock that is the robot's home now."""
        self._home, self._approach = home(self._context), approach(self._context)
        self._last_line = Route(np.array([self._approach[:2], self._home[:2]]), np.array([FAR_SPEED]))

    def initialise(self) -> None:
        """Begin with what is received."""
        self._part = None
        self._is_waiting = self.is_taken = False
        self._tries = 0
        self._failed: List[Pose] = []  # docks at which all tries failed

    @property
    def is_homing(self) -> bool:
        """Whether the beams guide it now."""
        return isinstance(self._part, (Homing, SelfDocking))

    @property
    def _passes_by(self) -> bool:
        """Whether a dock that it touches may be that of a mate, since it is on its way to another one."""
        return isinstance(self._part, GoTo) and not self._is_waiting and bool(self._context.mates.reports)

    @property
    def remaining(self) -> float:
        """Distance left to the point before the dock [m]; NaN if it is not known."""
        return self._part.remaining if isinstance(self._part, GoTo) else math.nan

    def update(self, observation: Observation) -> Command:
        """Go to the point before the dock, then home; if that fails, try again."""
        pose = observation.pose
        self._away = hypot(pose.x - self._home.x, pose.y - self._home.y)
        is_at_home = self._context.nearest_dock(pose) == self._home
        if observation.is_docked and not (self._passes_by and not is_at_home):
            self._context.moor(pose)  # beams of another dock may have led it there: that charges as well
            return self.succeed('docked')
        occupants = self._standing(self._home) if self.is_homing else self._occupants(self._home)
        if occupants and self._finds_another(pose):
            occupants = {}
        if occupants:
            return self._wait(observation, occupants)
        if self._is_waiting:
            self._part, self._is_waiting = None, False
        if self._part is None:
            homes = is_at_home and observation.infrared.omni & BUOYS and not self._context.docks_itself and (
                not self._context.mates.reports or self._away < CLOSE)
            self._part = Homing(self._context) if homes else self._way_home()
        elif isinstance(self._part, GoTo) and self._is_covered():
            self._part = self._way_home()
        command = self._part.step(self._with_own_beams(observation) if self.is_homing else observation)
        self.message = self._part.message
        if self.is_homing and not any(observation.contact):
            self._context.ground.leave_out(*pose[:2], self._context.robot.drive.radius)
        if self._part.status is Status.RUNNING:
            return command
        outcome = self._part.outcome
        if isinstance(self._part, GoTo):
            if self._part.status is Status.FAILED:
                return self.fail(f'cannot get to the dock: {self._part.message}', outcome)
            self._part = self._homing()
        else:
            self._part = self._way_home()
            self._tries += 1
            if self._tries >= TRIES:
                self._failed.append(self._home)
                if self._finds_another(pose):
                    self._tries = 0
                    return STOP
                return self.fail(f'{TRIES} attempts to dock failed: {self.message}', outcome)
        return Command(0.0, 0.0, brushes_up=True)

    def _with_own_beams(self, observation: Observation) -> Observation:
        """Without beams that only other docks can send."""
        others = [dock for dock in self._context.plan.docks if dock != self._home]
        return own_beams(observation, self._home, others, self._context.robot)

    def _homing(self) -> Union[Homing, SelfDocking]:
        """From the point before the dock onto its contacts."""
        return SelfDocking(self._context, self._home) if self._context.docks_itself else Homing(self._context)

    def _way_home(self) -> GoTo:
        """To the point before the dock, by the obstacles that are known now."""
        with contextlib.suppress(MapError):  # a map that grows may show less space there: the point stays
            self._approach = approach(self._context)
        return GoTo(self._context, self._approach)

    def _is_covered(self) -> bool:
        """Whether an obstacle or a mate covers the point before the dock, and another one will do."""
        here = np.array([self._approach[:2]])
        return not _is_free(self._context, here) and approach(self._context) != self._approach

    # --- the queue ------------------------------------------------------------------------------------------------

    def _finds_another(self, pose: Pose) -> bool:
        """Whether another dock is free: the nearest of them is the home of the robot from now on."""
        free = [dock for dock in self._context.plan.docks if dock not in self._failed and not self._occupants(dock)]
        for dock in sorted(free, key=lambda dock: hypot(dock.x - pose.x, dock.y - pose.y)):
            before = self._home
            self._context.moor(dock)
            try:
                self._head_for_home()
            except MapError:  # no robot fits before it
                self._context.moor(before)
                continue
            self._part = None
            return True
        return False

    def _standing(self, home: Pose) -> Dict[str, Task]:
        """What the mates that stand at a dock do, by their names."""
        return {name: report.task for name, report in self._context.mates.reports.items()
                if report.task in STANDING and hypot(report.pose.x - home.x, report.pose.y - home.y) < BERTH}

    def _occupants(self, home: Pose) -> Dict[str, Task]:
        """The same with those that are about to dock there."""
        docking = {name: report.task for name, report in self._context.mates.reports.items()
                   if report.task is Task.DOCKING and self._context.nearest_dock(report.pose) == home}
        return {**self._standing(home), **docking}

    def _wait(self, observation: Observation, occupants: Dict[str, Task]) -> Command:
        """Stand where the robot is not in the way of those that drive up to the dock or leave it."""
        if not self._is_waiting:
            self._part, self._is_waiting = self._way_aside(observation.pose), True
        if self._part is not None:
            command = self._part.step(observation)
            if self._part.status is Status.RUNNING:
                return command
            self._part = None
        self.message = f'waiting for the dock, where {" and ".join(occupants)} is'
        if all(task is Task.OFF for task in occupants.values()):
            self.is_taken = True
            return self.fail(f'the dock is taken by {" and ".join(occupants)}', Outcome.BLOCKED)
        return STOP

    def _way_aside(self, pose: Pose) -> Optional[GoTo]:
        """To a place to wait; None where the robot stands already, or if there is none."""
        before, dock = self._last_line.waypoints
        line = dock + np.linspace(0.0, 1.5, 16)[:, np.newaxis] * (before - dock)  # and beyond it by half
        if np.hypot(*(line - pose[:2]).T).min() > POLITE:
            return None
        mates = [report.pose[:2] for report in self._context.mates.reports.values()]
        docks = [other[:2] for other in self._context.plan.docks]
        places = places_apart(self._context.ground, pose, FARTHEST, np.concatenate([line, mates, docks]), POLITE)
        return GoTo(self._context, Pose(float(places[0][0]), float(places[0][1]), math.nan)) if len(places) else None

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
        """The way to the point before the dock, and from there straight to its contacts."""
        if self.is_homing:
            return Ahead(self._last_line, self._away)
        return None if self._part is None else self._part.plan_ahead()


def home(context: Context) -> Pose:
    """The dock to which a robot returns.

    Raises:
        MapError: the plan has no dock.
    """
    if context.home is None:
        raise MapError(f'{context.plan.name}: no dock on the map: its YAML file may name one, dock: [x, y, theta]')
    return context.home


def approach(context: Context) -> Pose:
    """Where a robot stands before the dock, and faces it: as far away as obstacles and mates leave the line free.

    Raises:
        MapError: the plan has no dock, or the robot fits nowhere before it.
    """
    dock = home(context)
    away = STEP * np.arange(1, max(BEFORE) + 1)[:, np.newaxis]
    line = np.array(dock[:2]) - away * (math.cos(dock.theta), math.sin(dock.theta))
    fitting = [steps for steps in BEFORE if all(
        context.plan.safe_clearance_at(x, y) > context.ground.reach for x, y in line[:steps].tolist())]
    if not fitting:
        raise MapError(f'{context.plan.name}: too little space before the dock at ({dock.x:.2f}, {dock.y:.2f}) m: '
                       f'a robot of radius {context.robot.drive.radius:.3f} m cannot drive up to it')
    free = [steps for steps in (*fitting, *CLOSER) if _is_free(context, line[:steps])]
    x, y = line[(free or fitting)[0] - 1].tolist()
    return Pose(x, y, dock.theta)


def _is_free(context: Context, line: Array) -> bool:
    """Whether no obstacle that the robot met and no docked mate stands on a straight line, float64 (any, 2) [m]."""
    apart = 2.0 * context.robot.drive.radius + APART
    return not context.ground.is_marked(line[0], line[-1]) and all(
        (np.hypot(*(line - report.pose[:2]).T) > apart).all() for report in context.mates.reports.values()
        if report.task in (Task.DOCKED, Task.OFF))
