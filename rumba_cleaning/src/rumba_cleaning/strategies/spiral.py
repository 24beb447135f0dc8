"""spiral: around and around, outward from where the robot is, to clean a spot."""

import math
from typing import Optional

from rumba_cleaning.behaviour import Behaviour, Command, Observation
from rumba_cleaning.behaviours import recoil
from rumba_cleaning.belief.context import Context
from rumba_cleaning.strategies import strategy
from rumba_sim.model.common.geometry import Pose, hypot

SIZE = 0.6  # [m] radius of the spot (our choice; a spot of a Roomba is about a metre across)
OVERLAP = 0.85  # of the brush's width from one turn to the next: the rest hides errors of the odometry


@strategy('spiral')
class Spiral(Behaviour):
    """An Archimedean spiral, r = pitch * angle / 2 pi, counter-clockwise; it ends if something is in the way."""

    def __init__(self, context: Context) -> None:
        """Make its turns as tight as the brush of the robot needs."""
        self._ground = context.ground
        self._drive = context.robot.drive
        self._speed = context.config.speed
        self._pitch = OVERLAP * context.robot.brush.width

    def initialise(self) -> None:
        """Begin in the middle of a new spot."""
        self._angle = 0.0  # [rad] around the middle
        self._last: Optional[Pose] = None

    def update(self, observation: Observation) -> Command:
        """Drive on, farther out by the way that the robot has come since: an edge may have slowed it."""
        pose, pitch = observation.pose, self._pitch / (2.0 * math.pi)
        last, self._last = self._last or pose, pose
        self._angle += hypot(pose.x - last.x, pose.y - last.y) / hypot(pitch * self._angle, pitch)
        radius = pitch * self._angle
        if any(observation.contact) or recoil.is_near_edge(self._ground, pose):
            return self.succeed(f'something is in the way {radius:.2f} m from the middle of the spot')
        if radius > SIZE:
            return self.succeed(f'a spot of {2.0 * SIZE:.1f} m is swept')
        curvature = (radius ** 2 + 2.0 * pitch ** 2) / (radius ** 2 + pitch ** 2) ** 1.5
        v = min(self._speed, self._drive.max_turn_rate / curvature)
        return Command(v, v * curvature)

    def take_note(self, observation: Observation) -> None:
        """Begin a new spot, wherever the robot will be."""
        self._angle, self._last = 0.0, None
