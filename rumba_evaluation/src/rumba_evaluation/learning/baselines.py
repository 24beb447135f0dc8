"""Programs that learn nothing, for comparison: one acts at random, one bounces as early Roombas did."""

from typing import List

import numpy as np

from rumba_cleaning.behaviour import Observation
from rumba_cleaning.behaviours.bounce import Bounce
from rumba_cleaning.control import CONTROL_DT
from rumba_evaluation.learning.coverage_task import Seen
from rumba_evaluation.learning.task_config import TaskConfig
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.kernel import Array

NOWHERE = Pose(0.0, 0.0, 0.0)  # bounce does not ask where it is


class Random:
    """Acts at random, and holds each action for a second."""

    HOLD = 10  # steps

    def __init__(self, robots: int, seed: int = 0) -> None:
        """Act for a number of robots."""
        self._generator = np.random.default_rng(seed)
        self._actions: Array = np.zeros((robots, 3))
        self._steps = 0

    def act(self, seen: Seen) -> Array:
        """Continuous actions, float64 (robots, 3), whatever the robots see."""
        if self._steps % self.HOLD == 0:
            self._actions = self._generator.uniform(-1.0, 1.0, self._actions.shape)
        self._steps += 1
        return self._actions


class Bouncing:
    """The strategy bounce: straight ahead until something is in the way, then in another direction."""

    def __init__(self, robots: int, seed: int = 0, config: TaskConfig = TaskConfig()) -> None:
        """Act for a number of robots in a task of some settings."""
        self._speed, self._turn_rate = config.speed, config.turn_rate
        self._behaviours: List[Bounce] = [Bounce(np.random.default_rng((seed, number)), config.speed)
                                          for number in range(robots)]

    def act(self, seen: Seen) -> Array:
        """Continuous actions, float64 (robots, 3), by the bumpers and the cliff sensors."""
        actions = np.ones((len(self._behaviours), 3))
        for row, behaviour, (left, right), cliff in zip(actions, self._behaviours, (seen['bumper'] > 0).tolist(),
                                                        (seen['cliff'] > 0).tolist()):
            command = behaviour.step(Observation(CONTROL_DT, NOWHERE, (left, right), cliff))
            row[:2] = command.v / self._speed, command.w / self._turn_rate
        return actions
