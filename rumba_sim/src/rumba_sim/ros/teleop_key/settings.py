"""The parameters of teleop_key."""

import dataclasses

from rumba_sim.model.common.config import setting
from rumba_sim.ros.common.teleop import ANGULAR_RANGE, LINEAR_RANGE


@dataclasses.dataclass(frozen=True)
class Settings:
    """The node's private parameters."""

    linear: float = setting(0.2, 'driving speed at the start', 'm/s', *LINEAR_RANGE)
    angular: float = setting(1.0, 'turning speed at the start', 'rad/s', *ANGULAR_RANGE)
    rate: float = setting(10.0, 'rate of commands; the robot stops if it is too low', 'Hz', 4.0, 100.0)
    hold: float = setting(0.7, 'how long a key counts: longer than a keyboard waits before it repeats', 's', 0.1, 5.0)
