"""A whole mission: undock, clean, go home when the battery runs low, charge, go on, come home at the end."""

import dataclasses
import enum
import math
from typing import Optional, Tuple

import numpy as np

from rumba_cleaning import strategies
from rumba_cleaning.behaviour import STOP, Behaviour, Command, Observation, Status
from rumba_cleaning.behaviours.dock import Dock
from rumba_cleaning.behaviours.undock import Undock
from rumba_cleaning.belief.context import Context
from rumba_cleaning.mission.battery_watch import BatteryWatch
from rumba_sim.model.errors import ConfigError
from rumba_sim.model.geometry import Pose

LEAP = 0.5  # [m] from one update to the next: somebody put the robot elsewhere
OFF = 1.0  # [s] off the contacts while charging, until that counts
GAIN = 0.002  # of coverage that a charge must bring, once it is ...
VAIN = 3  # ... so many charges that brought less
HOMES = 2  # attempts to get home
START = 0.1  # charge beyond what the way home needs, without which a mission begins with charging


class State(enum.IntEnum):
    """What the robot is at; the constants of rumba_msg/MissionStatus."""

    IDLE = 0
    UNDOCKING = 1
    CLEANING = 2
    RETURNING = 3
    DOCKING = 4
    CHARGING = 5
    GOING_TO = 6
    STRANDED = 7


class Mission(Behaviour):
    """Cleans a floor until its target is met, with as many charges as it takes.

    Attributes:
        state: what the robot is at.
        strategy: name of the cleaning strategy.
        charging_time: [s] spent at the contacts.
        charges: how often it went home to charge.
    """

    def __init__(self, context: Context, strategy: str, target_coverage: float) -> None:
        """Plan to clean.

        Raises:
            StrategyError: there is no strategy of this name.
            ConfigError: the target is not within 0..1.
        """
        if not 0.0 <= target_coverage <= 1.0:
            raise ConfigError(f'target_coverage is {target_coverage}: must be 0 to 1')
        context.config = dataclasses.replace(context.config, strategy=strategy, target_coverage=target_coverage)
        self._context = context
        self._cleaning = strategies.make(strategy, context)
        self.strategy = strategy
        self.initialise()

    def initialise(self) -> None:
        """Begin with a floor of which nothing is swept."""
        super().initialise()
        self.state = State.IDLE
        self.charging_time = 0.0
        self.charges = 0
        self._part: Optional[Behaviour] = None
        self._watch = BatteryWatch(self._context)
        self._last: Optional[Pose] = None
        self._brushes_up = True
        self._closing: Optional[Tuple[Status, str]] = None  # how it will have ended, once the robot is home
        self._off = 0.0  # [s] off the contacts
        self._homes = 0  # attempts to get home in vain
        self._gained = 0.0  # coverage at the last charge
        self._vain = 0  # charges that brought little, one after the other

    def update(self, observation: Observation) -> Command:
        """What the state asks for."""
        if self.status is not Status.RUNNING:
            return STOP
        self._take_note(observation)
        if observation.state_of_charge <= 0.0 and not observation.is_docked:
            return self._strand('the battery is empty')
        command = {
            State.IDLE: self._begin, State.UNDOCKING: self._undock, State.CLEANING: self._clean,
            State.RETURNING: self._go_home, State.DOCKING: self._go_home, State.CHARGING: self._charge,
        }[self.state](observation)
        self._brushes_up = command.brushes_up
        return command

    def terminate(self) -> None:
        """End the part that is under way."""
        if self._part is not None:
            self._part.terminate()

    def _take_note(self, observation: Observation) -> None:
        pose, last = observation.pose, self._last
        if last is None:
            self._forget_floor(pose)
        elif math.hypot(pose.x - last.x, pose.y - last.y) > LEAP and self._part is not None:
            self._part.initialise()
        self._last = pose
        self._context.swept.follow(pose, self._brushes_up)
        self._watch.update(observation)

    def _forget_floor(self, pose: Pose) -> None:
        """Nothing is swept yet; what can be reached is counted from where the robot stands, or right beside."""
        ground = self._context.ground
        ground.forget()
        place = np.array([pose[:2]])
        if not ground.are_free(place)[0]:
            place = ground.places(ground.standing(ground.nodes(place)))
        self._context.swept.begin(*place[0].tolist())

    # --- states ---------------------------------------------------------------------------------------------------

    def _enter(self, state: State, part: Optional[Behaviour]) -> Command:
        if self._part is not None:
            self._part.terminate()
        self.state, self._part = state, part
        if part is not None:
            part.initialise()
        return STOP

    def _begin(self, observation: Observation) -> Command:
        if not observation.is_docked:
            return self._enter(State.CLEANING, self._cleaning)
        if observation.state_of_charge < self._watch.needed(observation.pose) + START:
            return self._enter(State.CHARGING, None)
        return self._enter(State.UNDOCKING, Undock(self._context, turns=False))

    def _undock(self, observation: Observation) -> Command:
        assert self._part is not None
        command = self._part.update(observation)
        if self._part.status is Status.FAILED:
            return self._strand(self._part.message)
        if self._part.status is Status.SUCCEEDED:
            return self._enter(State.CLEANING, self._cleaning)
        return command

    def _clean(self, observation: Observation) -> Command:
        coverage = self._context.swept.coverage
        if coverage >= self._context.config.target_coverage:
            return self._close(Status.SUCCEEDED, f'{_percent(coverage)} swept')
        needed = self._watch.needed(observation.pose)
        if observation.state_of_charge < needed:
            if math.isfinite(needed):
                return self._enter(State.RETURNING, Dock(self._context))
            if observation.state_of_charge < self._context.config.reserve:
                return self._close(Status.FAILED, f'{_percent(coverage)} swept: the battery is low, and no way leads '
                                                  'to a dock')
        command = self._cleaning.update(observation)
        self.message = '; '.join(filter(None, [f'{_percent(coverage)} swept', self._cleaning.message]))
        if self._cleaning.status is not Status.RUNNING:
            return self._close(self._cleaning.status, f'{_percent(coverage)} swept: {self._cleaning.message}')
        return command

    def _go_home(self, observation: Observation) -> Command:
        assert isinstance(self._part, Dock)
        command = self._part.update(observation)
        self.state = State.DOCKING if self._part.is_homing else State.RETURNING
        self.message = self._part.message
        if self._part.status is Status.FAILED:
            self._homes += 1
            if self._homes >= HOMES:
                return self._strand(f'{_percent(self._context.swept.coverage)} swept: {self._part.message}')
            self._part.initialise()
        elif self._part.status is Status.SUCCEEDED:
            self._homes = 0
            return self._end() if self._closing else self._arrive()
        return command

    def _arrive(self) -> Command:
        """At the dock, to charge; not for ever, where that brings nothing."""
        coverage = self._context.swept.coverage
        self._vain = 0 if coverage > self._gained + GAIN else self._vain + 1
        self._gained = coverage
        if self._vain >= VAIN:
            return self._strand(f'{_percent(coverage)} swept: {VAIN} charges brought no more: the battery does not '
                                'last')
        self.charges += 1
        return self._enter(State.CHARGING, None)

    def _charge(self, observation: Observation) -> Command:
        self.charging_time += observation.dt
        self.message = f'charging, {_percent(observation.state_of_charge)}'
        self._off = 0.0 if observation.is_docked else self._off + observation.dt
        if self._off > OFF:
            return self._enter(State.CLEANING, self._cleaning)
        if observation.state_of_charge >= self._context.config.charge_to:
            return self._enter(State.UNDOCKING, Undock(self._context, turns=False))
        return STOP

    # --- the end --------------------------------------------------------------------------------------------------

    def _close(self, status: Status, message: str) -> Command:
        """Go home, where there is one, and end then."""
        self._closing = status, message
        if not self._watch.has_home or not math.isfinite(self._watch.needed(self._last or Pose(0.0, 0.0, 0.0))):
            return self._end()
        return self._enter(State.RETURNING, Dock(self._context))

    def _end(self) -> Command:
        assert self._closing is not None
        self.state = State.IDLE
        status, message = self._closing
        return self.succeed(message) if status is Status.SUCCEEDED else self.fail(message)

    def _strand(self, message: str) -> Command:
        self.state = State.STRANDED
        return self.fail(message)


def _percent(share: float) -> str:
    return f'{100.0 * share:.1f} %'
