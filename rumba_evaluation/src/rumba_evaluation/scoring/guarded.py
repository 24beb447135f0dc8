"""A robot drives along a path of others as a mission drives along its own: around what blocks it, and back onto it."""

import dataclasses
from typing import Optional

import numpy as np

from rumba_cleaning.behaviour import STOP, Behaviour, Command, Observation
from rumba_cleaning.behaviours.detour import detour
from rumba_cleaning.behaviours.guard import Guard
from rumba_cleaning.behaviours.impasse import Impasse
from rumba_cleaning.behaviours.travel import Going, Travel
from rumba_cleaning.belief.context import Context
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.mission.stages import HELD
from rumba_cleaning.outcome import Outcome
from rumba_cleaning.route import Route, lengths_along
from rumba_evaluation.scoring.drawn_path import DrawnPath
from rumba_evaluation.scoring.ride import AT_END, Driven
from rumba_sim.model.geometry import Pose
from rumba_sim.model.kernel import Array
from rumba_sim.model.robot import Robot
from rumba_sim.model.world import World

APART = 0.1  # [m] from one point of the path, to which a detour may lead back, to the next, at most; our choice


class Guarded(Driven):
    """Drives as a mission would: its guards keep it off edges, and it goes around what keeps it from the path."""

    def _follow(self, robot: Robot) -> Behaviour:
        return FollowAround(self.path, self.world, self.speed)


class FollowAround(Behaviour):
    """Follows a path with the brushes down; where something is in the way, it goes around and back onto the path.

    Attributes:
        detours: how often it had to.
    """

    def __init__(self, path: DrawnPath, world: World, speed: float) -> None:
        """Follow a path at a speed [m/s], on the map of a world."""
        self._context = Context(world.plan, world.config, dataclasses.replace(CleaningConfig(), speed=speed))
        points = _dense(path.points)
        self._route = Route(points, np.full(len(points) - 1, speed))

    def initialise(self) -> None:
        """Begin at the beginning."""
        self._guard, self._impasse = Guard(self._context), Impasse()
        self._travel = Travel(self._context, self._route)
        self.detours = 0

    def update(self, observation: Observation) -> Command:
        """Go on along the path, or around what is in the way."""
        command = self._guard.step(self._decide, observation)
        if self._guard.held_time > HELD:
            return self.fail('edges keep the robot from the path', Outcome.BLOCKED)
        return command

    def _decide(self, observation: Observation) -> Command:
        command = self._travel.command(observation, brushes_up=False)
        if self._travel.going is Going.ON:
            return command
        rest = None if self._travel.going is Going.ARRIVED else self._travel.rest()
        if rest is None:
            return self.succeed(AT_END + (f', after {self.detours} detour{"s" * (self.detours > 1)}'
                                          if self.detours else ''))
        if self._travel.going is Going.BLOCKED:
            self._impasse.stop(self._context, observation.pose)
        self.detours += 1
        around = self._around(observation.pose, rest)
        if around is None:
            return self.fail('no way leads around what keeps the robot from the rest of the path', Outcome.BLOCKED)
        self._travel = Travel(self._context, around)
        return STOP

    def _around(self, pose: Pose, rest: Route) -> Optional[Route]:
        """A way onto the rest of the path, from its first point at which the robot can stand on.

        If what it met seems to leave none, that is taken to be as small as it can be, and then to have gone.
        """
        ground = self._context.ground
        fits = ground.are_free(rest.waypoints)
        first = int(np.argmax(fits)) if fits.any() else 0
        rest = Route(rest.waypoints[first:], rest.speeds[first:])
        for relent in (lambda: None, lambda: ground.squeeze(True), ground.forget):
            relent()
            found = detour(self._context, pose, rest)
            if found is not None:
                return found
        return None


def _dense(points: Array) -> Array:
    """The same path with more points (any, 2) [m]."""
    lengths = lengths_along(points)
    along = np.union1d(lengths, np.arange(0.0, lengths[-1], APART))
    return np.stack([np.interp(along, lengths, points[:, axis]) for axis in (0, 1)], axis=1)
