"""Straight ahead until something is in the way, then in another direction, as early Roombas did."""

import enum
import math
from typing import Optional

import numpy as np

from rumba_cleaning.behaviour import Behaviour, Command, Observation
from rumba_cleaning.behaviours import recoil
from rumba_cleaning.belief.ground import Ground


class _Phase(enum.Enum):
    """What bounce does now."""

    AHEAD = 'ahead'
    BACK = 'back'
    TURN = 'turn'


class Bounce(Behaviour):
    """Goes ahead; at a contact or a cliff it backs off a little and turns away, by an angle drawn at random."""

    TURN_RATE = 1.5  # [rad/s]; a Create 3 turns at 1.9 at most
    TURNS = (0.3 * math.pi, 0.9 * math.pi)  # [rad] least and largest turn; our choice: away, but not straight back

    def __init__(self, generator: np.random.Generator, speed: float = 0.3, ground: Optional[Ground] = None) -> None:
        """Draw the angles from a generator; go ahead at a speed [m/s] (Create 3: 0.306 is its safe speed).

        If a ground is given, keep away from the cliffs that it shows, before the sensors see them.
        """
        self._generator = generator
        self._ground = ground
        self._speed = speed

    def initialise(self) -> None:
        """Begin by going ahead."""
        self._phase = _Phase.AHEAD
        self._remaining = 0.0  # [s] of the phase
        self._side = 1.0  # turn to the left: 1, to the right: -1

    def update(self, observation: Observation) -> Command:
        """Ahead, back, turn, ahead."""
        left, right = observation.contact
        if self._ground is not None and not (left or right):
            left, right = recoil.edge_ahead(self._ground, observation.pose)
        if self._phase is _Phase.AHEAD:
            if left or right:
                self._side = -1.0 if left and not right else 1.0 if right and not left else self._random_side()
                self._enter(_Phase.BACK, recoil.time_back(observation))
        else:
            self._remaining -= observation.dt
            if self._remaining <= 0.0 and self._phase is _Phase.BACK:
                self._enter(_Phase.TURN, self._generator.uniform(*self.TURNS) / self.TURN_RATE)
            elif self._remaining <= 0.0 and not any(observation.cliffs):
                self._enter(_Phase.AHEAD, 0.0)
        return {
            _Phase.AHEAD: Command(self._speed, 0.0),
            _Phase.BACK: Command(-recoil.SPEED, 0.0),
            _Phase.TURN: Command(0.0, self._side * self.TURN_RATE),
        }[self._phase]

    def _enter(self, phase: _Phase, seconds: float) -> None:
        self._phase = phase
        self._remaining = seconds

    def _random_side(self) -> float:
        return 1.0 if self._generator.random() < 0.5 else -1.0
