"""A mission of a robot without a dock: it ends where it began, or at a pose."""

from typing import Optional

from rumba_cleaning.behaviour import Command, Observation, Status
from rumba_cleaning.behaviours.go_to import GoTo
from rumba_cleaning.mission.mission import Mission
from rumba_cleaning.mission.stages import State
from rumba_sim.model.common.errors import MapError
from rumba_sim.model.common.geometry import Pose


class ReturningMission(Mission):
    """Goes there once it has cleaned, or given up; how the cleaning ended counts, whether it gets there or not."""

    _home: Optional[Pose] = None

    def _rest(self) -> None:
        super()._rest()
        self._has_gone = False  # back

    def _begin_floor(self, pose: Pose) -> None:
        super()._begin_floor(pose)
        self._home = self._context.end or pose

    def _end(self) -> Command:
        if self._has_gone or self._home is None:
            return super()._end()
        self._has_gone = True
        try:
            return self._enter(State.RETURNING, GoTo(self._context, self._home))
        except MapError as error:
            return self._end_elsewhere(str(error))

    def _return(self, observation: Observation) -> Command:
        if not isinstance(self._part, GoTo):
            return super()._return(observation)
        command = self._part.step(observation)
        self.message = f'going back: {self._part.message}'
        if self._part.status is Status.RUNNING:
            return command
        return self._end() if self._part.status is Status.SUCCEEDED else self._end_elsewhere(self._part.message)

    def _end_elsewhere(self, why: str) -> Command:
        assert self._closing is not None
        status, message, outcome = self._closing
        self._closing = status, f'{message}; not back: {why}', outcome
        return self._end()
