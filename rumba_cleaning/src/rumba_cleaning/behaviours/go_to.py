"""go_to: to a pose, around what is in the way."""

import math
from typing import Optional

import numpy as np

from rumba_cleaning.behaviour import STOP, Behaviour, Command, Observation
from rumba_cleaning.behaviours.follower import Route, Turn
from rumba_cleaning.behaviours.travel import Going, Travel
from rumba_cleaning.belief.context import Context
from rumba_sim.model.geometry import Pose

TRIES = 30  # times that something unknown may be in the way, or the robot be elsewhere in the end
CLOSE = 0.02  # [m] from the target, at most, where it rests


class GoTo(Behaviour):
    """Drives to a pose with the brushes up."""

    def __init__(self, context: Context, target: Pose) -> None:
        """Go to a target [m, rad], map frame; theta NaN: any heading will do.

        Raises:
            MapError: the robot does not fit there, or it lies outside the map.
        """
        context.plan.check_place(target, context.robot.drive.radius, 'target')
        self._context = context
        self._target = target
        self.initialise()

    def initialise(self) -> None:
        """Begin with looking for a way."""
        super().initialise()
        self._travel: Optional[Travel] = None
        self._turn: Optional[Turn] = None  # at the end
        self._tries = 0

    @property
    def remaining(self) -> float:
        """Way left to the target [m]; NaN where none is known yet."""
        return self._travel.remaining if self._travel is not None else math.nan

    def update(self, observation: Observation) -> Command:
        """Along the way, then turn."""
        if self._turn is not None:
            return self._turned(self._turn, observation)
        if self._travel is None:
            route = self._route(observation.pose)
            if route is None:
                here, target = observation.pose, self._target
                return self.fail(f'no way from ({here.x:.2f}, {here.y:.2f}) to ({target.x:.2f}, {target.y:.2f}) m')
            self._travel = Travel(self._context, route)
        command = self._travel.update(observation, brushes_up=True)
        if self._travel.going is Going.ARRIVED:
            any_heading = math.isnan(self._target.theta)
            self._turn = Turn(observation.pose.theta if any_heading else self._target.theta, self._context.robot.drive)
        elif self._travel.going is not Going.ON:
            return self._try_again(command)
        self.message = f'{self.remaining:.1f} m to go'
        return command

    def _route(self, pose: Pose) -> Optional[Route]:
        """The way as a route; where obstacles that were met close every way, these are forgotten."""
        ground, ends = self._context.ground, np.array([pose[:2], self._target[:2]])
        way = ground.way(*ends)
        if way is None and ground.has_marks:
            ground.forget()
            way = ground.way(*ends)
        return None if way is None else Route(way, np.full(len(way) - 1, self._context.config.transit_speed))

    def _turned(self, turn: Turn, observation: Observation) -> Command:
        """Turn to the heading; where commands come late, or somebody gives a push, go back to the target."""
        pose = observation.pose
        rate = turn.update(pose, observation.dt)
        if not turn.is_done:
            return Command(0.0, rate, brushes_up=True)
        if math.hypot(pose.x - self._target.x, pose.y - self._target.y) > CLOSE:
            return self._try_again(STOP)
        return self.succeed(f'at ({pose.x:.2f}, {pose.y:.2f}) m')

    def _try_again(self, meanwhile: Command) -> Command:
        self._travel = self._turn = None
        self._tries += 1
        if self._tries > TRIES:
            return self.fail(f'after {TRIES} attempts something is still in the way')
        return meanwhile
