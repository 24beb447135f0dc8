"""A robot drives along a path of others as a mission drives along its own: around what blocks it, and back onto it."""

import dataclasses
import math
from typing import Optional

import numpy as np

from rumba_cleaning.behaviour import STOP, Behaviour, Command, Observation
from rumba_cleaning.behaviours.detour import detour
from rumba_cleaning.behaviours.impasse import Impasse
from rumba_cleaning.behaviours.travel import Going, Travel
from rumba_cleaning.belief.context import Context
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.edges.guard import Guard
from rumba_cleaning.mission.stages import HELD
from rumba_cleaning.outcome import Outcome
from rumba_cleaning.route import Route, lengths_along
from rumba_evaluation.scoring.drawn_path import DrawnPath
from rumba_evaluation.scoring.ride import AT_END, Driven
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.kernel import Array
from rumba_sim.model.simulation.robot import Robot
from rumba_sim.model.simulation.world import World

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
        self._left = math.inf  # [m] of the path at most, when it had to leave that
        self._vain = 0  # detours, one after the other, that did not lead further
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
            return self._arrive(AT_END)
        if self._travel.going is Going.BLOCKED:
            self._impasse.stop(self._context, observation.pose)
        rest = self._further(rest)
        if rest is None:
            return self._arrive('a robot can stand nowhere on the rest of the path')
        around = self._around(observation.pose, rest)
        if around is None:
            return self.fail('no way leads around what keeps the robot from the rest of the path', Outcome.BLOCKED)
        self.detours += 1
        self._travel = Travel(self._context, around)
        return STOP

    def _arrive(self, what: str) -> Command:
        """End, and tell how often the robot had to leave the path."""
        many = f', after {self.detours} detour{"s" * (self.detours > 1)}' if self.detours else ''
        return self.succeed(what + many)

    def _further(self, rest: Route) -> Optional[Route]:
        """The rest of the path from where a robot can stand, and the further on, the more detours were in vain.

        None if it can stand nowhere.
        """
        left = rest.length - lengths_along(rest.waypoints)
        self._vain = self._vain + 1 if left[0] > self._left - APART else 0
        self._left = min(self._left, float(left[0]))
        good = self._context.ground.are_free(rest.waypoints) & (left <= self._left - APART * (2 ** self._vain - 1))
        good[-1] = False  # it has no way on
        if not good.any():
            return None
        first = int(np.argmax(good))
        return Route(rest.waypoints[first:], rest.speeds[first:])

    def _around(self, pose: Pose, rest: Route) -> Optional[Route]:
        """A way onto the rest of the path.

        If what it met seems to leave none, that is taken to be as small as it can be, and then to have gone.
        """
        ground = self._context.ground
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
