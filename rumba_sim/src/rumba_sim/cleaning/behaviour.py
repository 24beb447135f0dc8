"""What a behaviour sees, what it answers, and how it lives."""

import abc
from typing import NamedTuple, Sequence, Tuple

from rumba_sim.model.geometry import Pose


class Observation(NamedTuple):
    """What a robot knows at one moment."""

    dt: float  # [s] since the observation before; 0 at the first
    pose: Pose  # [m, rad] in the map frame
    bumper: Tuple[bool, bool] = (False, False)  # left, right
    cliffs: Sequence[bool] = (False, False, False, False)  # left, front left, front right, right
    state_of_charge: float = 1.0  # [0..1]
    is_docked: bool = False


class Command(NamedTuple):
    """What a robot shall do until the next command."""

    v: float  # [m/s] forward
    w: float  # [rad/s] counter-clockwise
    brushes_up: bool = False


class Behaviour(abc.ABC):
    """One thing that a robot can do. `update` never blocks; the caller owns time."""

    def initialise(self) -> None:
        """Begin anew; called before the first update, and whenever the behaviour is taken up again."""

    @abc.abstractmethod
    def update(self, observation: Observation) -> Command:
        """What to do now."""

    def terminate(self) -> None:
        """End, at any moment."""
