"""Finds the dock without a map: about the floor until its beams are received, and along them onto the contacts."""

import math

from rumba_cleaning.behaviour import Behaviour, Command, Observation, Status
from rumba_cleaning.behaviours.homing import BUOYS, Homing
from rumba_cleaning.belief.context import Context
from rumba_cleaning.strategies.wander import Wander

AWAY = 5.0  # [s] about the floor after a failed attempt, before beams count again: from there it would fail again


class Seek(Behaviour):
    """Wanders with the brushes up until it is docked; only its caller's patience, or the battery, ends it before."""

    def __init__(self, context: Context) -> None:
        """Seek any dock."""
        self._wander, self._homing = Wander(context, spirals=False), Homing(context)
        self._part: Behaviour = self._wander

    def initialise(self) -> None:
        """Begin with what is received."""
        self._part = self._wander
        self._since = AWAY  # [s] since the last attempt

    @property
    def remaining(self) -> float:
        """Distance left [m]: NaN, since it does not know where the dock is."""
        return math.nan

    @property
    def is_homing(self) -> bool:
        """Whether the beams guide it now."""
        return self._part is self._homing

    def update(self, observation: Observation) -> Command:
        """Wander, or follow the beams."""
        if observation.is_docked:
            return self.succeed('docked')
        self._since += observation.dt
        if self.is_homing and self._homing.status is Status.FAILED:
            self._change(self._wander)
            self._since = 0.0
        elif not self.is_homing and observation.infrared.omni & BUOYS and self._since >= AWAY:
            self._change(self._homing)
        command = self._part.step(observation)
        self.message = 'following the beams of the dock' if self.is_homing else 'looking for the dock'
        return command._replace(brushes_up=True)

    def terminate(self) -> None:
        """Stop what is under way."""
        self._part.stop()

    def take_note(self, observation: Observation) -> None:
        """Go on wherever the robot will be."""
        self._part.stand_by(observation)

    def _change(self, part: Behaviour) -> None:
        self._part.stop()
        self._part = part
        part.restart()
