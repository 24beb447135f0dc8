"""What a behaviour sees, what it answers, and how it lives."""

import abc
import enum
from typing import NamedTuple, Sequence, Tuple

from rumba_sim.model.geometry import Pose
from rumba_sim.model.kernel import NO_BEAM
from rumba_sim.model.robot import Infrared

NO_CLIFFS = (False, False, False, False)


class Observation(NamedTuple):
    """What a robot knows at one moment."""

    dt: float  # [s] since the observation before; 0 at the first
    pose: Pose  # [m, rad] in the map frame
    bumper: Tuple[bool, bool] = (False, False)  # left, right
    cliffs: Sequence[bool] = NO_CLIFFS  # left, front left, front right, right
    state_of_charge: float = 1.0  # [0..1]
    is_docked: bool = False
    infrared: Infrared = Infrared(NO_BEAM, NO_BEAM, NO_BEAM)  # beams of the dock by receiver

    @property
    def contact(self) -> Tuple[bool, bool]:
        """Whether a switch is pressed, or the floor ends, on the left and on the right."""
        left, right = self.bumper
        far_left, near_left, near_right, far_right = self.cliffs
        return left or far_left or near_left, right or near_right or far_right


class Command(NamedTuple):
    """What a robot shall do until the next command."""

    v: float  # [m/s] forward
    w: float  # [rad/s] counter-clockwise
    brushes_up: bool = False


STOP = Command(0.0, 0.0, brushes_up=True)


class Status(enum.Enum):
    """How far a behaviour is."""

    RUNNING = 'running'
    SUCCEEDED = 'succeeded'
    FAILED = 'failed'


class Behaviour(abc.ABC):
    """One thing that a robot can do. `update` never blocks; the caller owns time.

    Attributes:
        status: RUNNING, until it has succeeded or failed; what `update` answers then is to stop.
        message: one line for a person: what it does, or how it ended.
    """

    status = Status.RUNNING
    message = ''

    def initialise(self) -> None:
        """Begin anew; called before the first update, and whenever the behaviour is taken up again."""
        self.status = Status.RUNNING
        self.message = ''

    @abc.abstractmethod
    def update(self, observation: Observation) -> Command:
        """What to do now."""

    def terminate(self) -> None:
        """End, at any moment."""

    def succeed(self, message: str) -> Command:
        """End well; returns the command to stop."""
        self.status, self.message = Status.SUCCEEDED, message
        return STOP

    def fail(self, message: str) -> Command:
        """Give up, and say why; returns the command to stop."""
        self.status, self.message = Status.FAILED, message
        return STOP
