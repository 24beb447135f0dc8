"""What a behaviour gets, what it answers, and the life cycle that all behaviours share."""

import abc
import enum
import math
from typing import Any, NamedTuple, Optional, Sequence, Tuple, final

from rumba_cleaning.outcome import Outcome
from rumba_cleaning.route import Ahead
from rumba_localisation.scan import SILENT, Scan
from rumba_sim.model.common.errors import CommandError, quoted
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.kernel import Array
from rumba_sim.model.kernel.sensors.dock import NO_BEAM
from rumba_sim.model.simulation.robot import Infrared

Row = Tuple[float, float, float]
Covariance = Tuple[Row, Row, Row]  # of x, y and heading
CERTAIN: Covariance = ((0.0, 0.0, 0.0),) * 3
UNKNOWN: Covariance = ((math.inf, 0.0, 0.0), (0.0, math.inf, 0.0), (0.0, 0.0, math.inf))
LOST_AT, LOST_TURNED = 0.3, 0.5  # [m], [rad] standard deviations of a pose from which on the robot is lost; our choice
UNSURE_AT, UNSURE_TURNED = 0.1, 0.3  # [m], [rad] the same while the laser is silent; our choice
NO_CLIFFS = (False, False, False, False)
SIDE = 0.74  # [rad] the middle of the part of the bumper that presses one switch alone: (field + overlap) / 4
FALLEN = 'a wheel hangs over a cliff: the robot must be put elsewhere'
# Methods of Behaviour that no subclass overrides.
FINAL = ('step', 'stand_by', 'stop', 'restart', 'succeed', 'fail', 'planned_path')


class Observation(NamedTuple):
    """What a robot knows at one moment."""

    dt: float  # [s] since the observation before; 0 at the first
    pose: Pose  # [m, rad] in the map frame
    bumper: Tuple[bool, bool] = (False, False)  # left, right
    cliffs: Sequence[bool] = NO_CLIFFS  # left, front left, front right, right
    state_of_charge: float = 1.0  # [0..1]
    is_docked: bool = False
    infrared: Infrared = Infrared(NO_BEAM, NO_BEAM, NO_BEAM)  # beams of the dock by receiver
    has_fallen: bool = False  # a wheel hangs over a cliff: the robot cannot drive
    covariance: Covariance = CERTAIN  # of the pose [m^2, m rad, rad^2]
    scan: Optional[Scan] = None  # of the laser, if there is a new one
    silence: float = 0.0  # [s] for which no scan has come to find the pose by; 0 if it is found by something else
    is_held: bool = False  # an edge keeps the robot from what it was to do

    @property
    def is_silent(self) -> bool:
        """Whether the laser is silent, so that the pose is that of the wheels, and becomes worse with each metre."""
        return self.silence > SILENT

    @property
    def is_lost(self) -> bool:
        """Whether the pose is too uncertain to drive by; it must be better if no scan can tell of a mistake."""
        (x, _, _), (_, y, _), (_, _, theta) = self.covariance
        most, turned = (UNSURE_AT, UNSURE_TURNED) if self.is_silent else (LOST_AT, LOST_TURNED)
        return not (max(x, y) < most ** 2 and theta < turned ** 2)  # true of NaN too

    @property
    def contact(self) -> Tuple[bool, bool]:
        """Whether a switch is pressed, or the floor ends, on the left and on the right."""
        left, right = self.bumper
        far_left, near_left, near_right, far_right = self.cliffs
        return left or far_left or near_left, right or near_right or far_right


def direction(left: bool, right: bool) -> float:
    """Where something is, from ahead to the left, that presses these switches alone, both, or none [rad]."""
    return 0.0 if left == right else SIDE if left else -SIDE


class Command(NamedTuple):
    """What a robot does until the next command."""

    v: float  # [m/s] forward
    w: float  # [rad/s] counter-clockwise
    brushes_up: bool = False
    seeks_dock: bool = False  # instead, it finds its dock by itself, or stays on it; only for robots that can


STOP = Command(0.0, 0.0, brushes_up=True)


class Status(enum.Enum):
    """Whether a behaviour goes on, or how it ended."""

    RUNNING = 'running'
    SUCCEEDED = 'succeeded'
    FAILED = 'failed'


class Behaviour(abc.ABC):
    """Something that a robot can do. No method blocks; the caller owns time.

    Callers use `step`, `stand_by`, `stop` and `restart`; subclasses write the hooks `initialise`, `update`, `terminate`
    and `take_note`, which only the methods above call, and `plan_ahead` for those who watch. A run of a behaviour
    begins with the first step and ends when the behaviour succeeds or fails, or when somebody stops or restarts it:

        initialise, update, update, ..., update, terminate

    Each run gets exactly one `initialise` and one `terminate`.

    Attributes:
        status: RUNNING, until it has succeeded or failed.
        message: one line for a person: what it does, or how it ended.
        outcome: UNKNOWN, until it has succeeded or failed.
    """

    status = Status.RUNNING
    message = ''
    outcome = Outcome.UNKNOWN
    _is_under_way = False  # initialised, and not terminated since

    def __init_subclass__(cls, **kwargs: Any) -> None:
        """Refuse a subclass that replaces what callers rely on.

        Raises:
            TypeError: it overrides a method that is final.
        """
        super().__init_subclass__(**kwargs)
        for name in FINAL:
            if name in vars(cls):
                raise TypeError(f'{cls.__name__} overrides {name}, which is final: '
                                'a behaviour overrides initialise, update, terminate and take_note')

    # --- for callers; final ---------------------------------------------------------------------------------------

    @final
    def step(self, observation: Observation) -> Command:
        """What to do now; STOP from the step on in which the behaviour ends.

        Raises:
            CommandError: `update` returned something else than a Command of finite numbers.
        """
        if self.status is Status.RUNNING and observation.has_fallen:
            self.fail(FALLEN, Outcome.FALLEN)
        if self.status is Status.RUNNING and not self._is_under_way:
            self.message = ''
            self.initialise()
            self._is_under_way = True
        command = self.update(observation) if self.status is Status.RUNNING else STOP
        if self.status is Status.RUNNING:
            if not _is_command(command):
                raise CommandError(f'{type(self).__name__}.update returned {quoted(command)}: must be a Command of '
                                   'finite numbers')
            return command
        self.stop()
        return STOP

    @final
    def stand_by(self, observation: Observation) -> None:
        """Watch while a person drives; the next step goes on from wherever the robot is then."""
        if self._is_under_way:
            self.take_note(observation)

    @final
    def stop(self) -> None:
        """End the run that is under way, if there is one; status, message and outcome stay as they are.

        A step after it begins a new run, unless the behaviour has succeeded or failed.
        """
        if self._is_under_way:
            self._is_under_way = False
            self.terminate()

    @final
    def restart(self) -> None:
        """End the run that is under way, if there is one; the next step begins a new one, even after an end."""
        self.stop()
        self.status, self.message, self.outcome = Status.RUNNING, '', Outcome.UNKNOWN

    @final
    def succeed(self, message: str, outcome: Outcome = Outcome.SUCCEEDED) -> Command:
        """End as planned; returns the command to stop."""
        self.status, self.message, self.outcome = Status.SUCCEEDED, message, outcome
        return STOP

    @final
    def fail(self, message: str, outcome: Outcome = Outcome.FAILED) -> Command:
        """Give up, and say why; returns the command to stop."""
        self.status, self.message, self.outcome = Status.FAILED, message, outcome
        return STOP

    @final
    def planned_path(self) -> Optional[Array]:
        """The corners (n, 2) [m] of the path that it follows now, map frame; None if it has no plan."""
        ahead = self.plan_ahead()
        return None if ahead is None else ahead.route.waypoints

    # --- hooks for subclasses -------------------------------------------------------------------------------------

    def initialise(self) -> None:
        """Begin a run; called right before its first update, and never in an `__init__`."""

    @abc.abstractmethod
    def update(self, observation: Observation) -> Command:
        """What to do now."""

    def terminate(self) -> None:
        """End a run: let go of what it holds, and stop its parts. Called once for each run."""

    def take_note(self, observation: Observation) -> None:
        """Remember what is needed to go on after a person drove the robot; called in place of `update` meanwhile."""

    def plan_ahead(self) -> Optional[Ahead]:
        """The route that it follows now, and how far it has come; None if it has no plan.

        For those who watch, and for mates. A new plan is a new route with a new array of waypoints.
        """
        return None


def _is_command(value: Any) -> bool:
    """Whether a robot can follow what a behaviour returned: anybody may write one."""
    try:
        return (isinstance(value, Command) and math.isfinite(value.v) and math.isfinite(value.w)
                and value.brushes_up in (True, False) and value.seeks_dock in (True, False))
    except (TypeError, OverflowError, ValueError):
        return False
