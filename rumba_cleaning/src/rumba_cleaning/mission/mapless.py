"""A mission without a map and without a laser, by bumper, cliff sensors, odometry and the beams of the dock alone.

The robot cannot know what share of the floor is swept, nor where it is: it cleans for a time, and looks for its dock by
driving about until it receives the beams. The wheels tell it only how it moved lately.
"""

from rumba_cleaning import strategies
from rumba_cleaning.behaviour import STOP, Command, Observation, Status
from rumba_cleaning.behaviours.homing import BUOYS
from rumba_cleaning.behaviours.undock import Undock
from rumba_cleaning.belief.context import Context
from rumba_cleaning.edges.guard import Guard
from rumba_cleaning.mission.seek import Seek
from rumba_cleaning.mission.stages import EMPTY, HELD, START, StagedMission, State
from rumba_cleaning.mission.wording import percent
from rumba_cleaning.outcome import Outcome

SEEKING = 1200.0  # [s] that the way home may take, for which charge is kept: few of bench/mapless.py take longer
MOST = 0.5  # of the charge, at most, is kept for that
LAST = 0.1  # of the cleaning time: a robot that receives the beams then returns at once, instead of a search later; as
#             much charge beyond what it needs: it charges then; our choice
MINUTE = 60.0  # [s]


class MaplessMission(StagedMission):
    """Cleans for the cleaning time of its settings, with as many charges as that takes, and returns to the dock."""

    def __init__(self, context: Context, strategy: str) -> None:
        """Clean with a strategy that needs no map; what the context knows of the floor is forgotten.

        Raises:
            StrategyError: there is no strategy of this name, or it needs a map.
        """
        strategies.check_mapless(strategy)
        self._context = context
        self._cleaning = strategies.make(strategy, context)
        self._guard = Guard(context)
        battery = context.robot.battery
        rate = battery.discharge_rate(battery.cleaning_current - battery.brush_current)  # [1/s] with brushes up
        self._needed = min(rate * SEEKING, MOST) + context.config.reserve  # state of charge for the way home
        self.strategy = strategy

    def initialise(self) -> None:
        """Begin with the time that is left, all of it unless the mission is resumed."""
        self._rest()
        if not self._resumes:
            self.charging_time, self.charges = 0.0, 0
            self._cleaned = 0.0  # [s]
            self._knows_dock = False  # there is one: it has stood there, or received its beams
        self._resumes, self._has_memory = False, True
        self._guard.rest()

    def update(self, observation: Observation) -> Command:
        """Do what the state asks for."""
        self._track(observation)
        if observation.state_of_charge <= 0.0 and not observation.is_docked:
            return self._strand(f'{self._done()}: {EMPTY}', Outcome.BATTERY_EMPTY)
        command = self._guard.step(self._act, observation)
        if self._guard.held_time > HELD:
            return self._strand(f'{self._done()}: the robot is so near to edges that no way on is safe',
                                Outcome.BLOCKED)
        return command

    def take_note(self, observation: Observation) -> None:
        """Follow the robot."""
        observation = self._guard.stand_by(observation)
        self._track(observation)
        if self._part is not None:
            self._part.stand_by(observation)

    def _track(self, observation: Observation) -> None:
        self._knows_dock |= observation.is_docked or bool(observation.infrared.omni & BUOYS)
        if self.state is State.CHARGING:
            self.charging_time += observation.dt

    # --- states ---------------------------------------------------------------------------------------------------

    def _begin(self, observation: Observation) -> Command:
        if not observation.is_docked:
            return self._enter(State.CLEANING, self._cleaning)
        if observation.state_of_charge < self._needed + START:
            return self._enter(State.CHARGING, None)
        return self._enter(State.UNDOCKING, Undock(self._context))

    def _clean(self, observation: Observation) -> Command:
        self._cleaned += observation.dt
        is_near = bool(observation.infrared.omni & BUOYS)
        if self._cleaned >= (1.0 - LAST * is_near) * self._context.config.cleaning_time:
            return self._close(Status.SUCCEEDED, self._done(), Outcome.SUCCEEDED)
        if observation.state_of_charge < self._needed + LAST * is_near and self._knows_dock:
            return self._enter(State.RETURNING, Seek(self._context))
        command = self._cleaning.step(observation)
        self.message = '; '.join(filter(None, [self._done(), self._cleaning.message]))
        if self._cleaning.status is Status.FAILED:
            return self._close(Status.FAILED, f'{self._done()}: {self._cleaning.message}', self._cleaning.outcome)
        if self._cleaning.status is Status.SUCCEEDED:
            return self._close(Status.SUCCEEDED, f'{self._done()}: {self._cleaning.message}', Outcome.SUCCEEDED)
        return command

    def _return(self, observation: Observation) -> Command:
        """Look for the dock until it is found, or the battery is empty."""
        assert isinstance(self._part, Seek)
        command = self._part.step(observation)
        self.state = State.DOCKING if self._part.is_homing else State.RETURNING
        self.message = f'{self._done()}; {self._part.message}'
        if self._part.status is not Status.SUCCEEDED:
            return command
        if self._closing is not None:
            return self._end()
        self.charges += 1
        return self._enter(State.CHARGING, None)

    def _charge(self, observation: Observation) -> Command:
        self.message = f'{self._done()}; charging, {percent(observation.state_of_charge)}'
        if self._was_moved(observation):
            return self._enter(State.CLEANING, self._cleaning)
        if observation.state_of_charge >= self._context.config.charge_to:
            return self._enter(State.UNDOCKING, Undock(self._context))
        return STOP

    def _close(self, status: Status, message: str, outcome: Outcome) -> Command:
        """Return to the dock, if there is one, and end then."""
        self._closing = status, message, outcome
        return self._enter(State.RETURNING, Seek(self._context)) if self._knows_dock else self._end()

    def _done(self) -> str:
        cleaned, wanted = self._cleaned / MINUTE, self._context.config.cleaning_time / MINUTE
        of_all = f' of {wanted:.0f}' if cleaned < wanted else ''
        return f'cleaned for {cleaned:.0f}{of_all} min'
