"""Settings of the task: what a program sees, does and is rewarded for."""

import dataclasses
from typing import List

from rumba_cleaning.control import CONTROL_DT
from rumba_evaluation.trials.cases import ANYWHERE, DOCK
from rumba_sim.model.common.config import section, setting

CONTINUOUS, DISCRETE = 'continuous', 'discrete'


@dataclasses.dataclass(frozen=True)
class Reward:
    """What a step is worth: the sum of these."""

    swept: float = setting(1.0, 'for the area that the brush sweeps straight ahead at `speed` in 0.1 s, and in '
                                'proportion for more and less', '', 0.0, 1000.0)
    time: float = setting(0.1, 'taken away in each step', '', 0.0, 1000.0)
    bump: float = setting(0.5, 'taken away each time the bumper is pressed', '', 0.0, 1000.0)
    fall: float = setting(50.0, 'taken away if a wheel goes over a cliff', '', 0.0, 1e6)
    finish: float = setting(50.0, 'when the target is reached', '', 0.0, 1e6)


@dataclasses.dataclass(frozen=True)
class Variation:
    """How much robots differ from episode to episode, evenly distributed; 0 makes all of them the same."""

    acceleration: float = setting(0.0, 'of the wheels: by this share up or down', '', 0.0, 0.9)
    traction: float = setting(0.0, 'of the wheels: by up to this share down', '', 0.0, 0.4)
    odometry: float = setting(0.0, 'of scale error and noise of the wheels: by this share up or down', '', 0.0, 1.0)
    laser: float = setting(0.0, 'of the noise of ranges: by this share up or down', '', 0.0, 1.0)
    capacity: float = setting(0.0, 'of the battery: by up to this share down', '', 0.0, 0.9)
    charge: float = setting(0.0, 'at the start: by up to this share below a full battery', '', 0.0, 0.95)


@dataclasses.dataclass(frozen=True)
class TaskConfig:
    """The whole task. A step takes `hold` times 0.1 s of simulated time, which are five ticks of the world."""

    actions: str = setting(CONTINUOUS, 'what an action is', choices=(CONTINUOUS, DISCRETE))
    speed: float = setting(0.3, 'of the robot at action 1 (Create 3: its safe speed)', 'm/s', 0.02, 0.5)
    turn_rate: float = setting(1.9, 'of the robot at action 1 (Create 3)', 'rad/s', 0.1, 10.0)
    hold: int = setting(1, 'for how many times 0.1 s an action is in force: so long is a step', '', 1, 100)
    beams: int = setting(24, 'number of range beams in a full turn', '', 1, 1000)
    maps: int = setting(0, 'number of egocentric maps, each of another scale; 0 for none', '', 0, 8)
    map_size: int = setting(32, 'pixels along a side of such a map', '', 2, 256)
    map_pitch: float = setting(0.05, 'side of a pixel of the first map', 'm', 0.005, 1.0)
    map_factor: float = setting(4.0, 'by which the pixels of each further map are larger', '', 1.0, 10.0)
    start: str = setting(ANYWHERE, 'where a robot starts', choices=(ANYWHERE, DOCK))
    target: float = setting(0.95, 'coverage at which the task is done', '0..1', 0.01, 1.0)
    time_limit: float = setting(600.0, 'after which an episode is cut off', 's', 0.1, 1e6)
    reward: Reward = section(Reward, 'what a step is worth')
    variation: Variation = section(Variation, 'how much robots differ from episode to episode')

    @property
    def pitches(self) -> List[float]:
        """Side of a pixel of each egocentric map [m]."""
        return [self.map_pitch * self.map_factor ** scale for scale in range(self.maps)]

    @property
    def most_steps(self) -> int:
        """Steps until an episode is cut off."""
        return max(round(self.time_limit / CONTROL_DT / self.hold), 1)
