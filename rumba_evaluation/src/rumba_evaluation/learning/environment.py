"""The environment rumba/Coverage-v0 of Gymnasium: a robot that is to sweep a room which it has never seen.

    import gymnasium
    environment = gymnasium.make('rumba_evaluation.learning.environment:rumba/Coverage-v0')
    seen, info = environment.reset(seed=1)

docs/environment.md tells what it sees, does and is rewarded for.
"""

from typing import Any, Dict, Mapping, Optional, Sequence, Tuple, Union

import numpy as np

from rumba_evaluation.learning import spaces
from rumba_evaluation.learning.coverage_task import CoverageTask, Outcome, Seen
from rumba_evaluation.learning.picture import picture
from rumba_evaluation.learning.spaces import gymnasium
from rumba_evaluation.learning.task_config import TaskConfig
from rumba_sim.model.common.config import from_mapping
from rumba_sim.model.common.errors import ConfigError
from rumba_sim.model.kernel import Array
from rumba_sim.model.maps import map_file
from rumba_sim.model.maps.floor_plan import FloorPlan
from rumba_sim.model.settings.robot_config import RobotConfig

ID = 'rumba/Coverage-v0'
RENDER_MODES = ['rgb_array']
FRAMES = 10  # a second of simulated time
Settings = Mapping[str, Any]
Floors = Union[Sequence[int], Sequence[str], Sequence[FloorPlan]]


class CoverageEnv(gymnasium.Env):
    """One robot."""

    metadata = {'render_modes': RENDER_MODES, 'render_fps': FRAMES}

    def __init__(self, floors: Floors = range(100), settings: Optional[Settings] = None,
                 robot: Optional[Settings] = None, render_mode: Optional[str] = None) -> None:
        """Prepare.

        Args:
            floors: each episode takes place on one of them: numbers of `rooms`, paths of maps, or floor plans.
            settings: of the task, as for `TaskConfig`; what is not named keeps its default.
            robot: what the robot is like, as for `RobotConfig`.
            render_mode: None, or 'rgb_array'.

        Raises:
            RumbaError: a setting is unknown or out of range, or there is no such map.
        """
        self._task = task_of(floors, 1, settings, robot)
        self.observation_space = spaces.observations(self._task.config)
        self.action_space = spaces.actions(self._task.config)
        self.render_mode = checked(render_mode)

    def reset(self, *, seed: Optional[int] = None, options: Optional[Dict[str, Any]] = None
              ) -> Tuple[Seen, Dict[str, Any]]:
        """Begin an episode, as the seed says, or as one of those that follow from the last seed."""
        super().reset(seed=seed)
        return _alone(self._task.reset([seed])), {'coverage': 0.0}

    def step(self, action: Any) -> Tuple[Seen, float, bool, bool, Dict[str, Any]]:
        """Let the robot act for a step.

        Raises:
            RumbaError: the action is none, no episode has begun, or it has ended.
        """
        outcome = self._task.step(np.asarray(action)[np.newaxis])
        return (_alone(self._task.look()), float(outcome.reward[0]), bool(outcome.terminated[0]),
                bool(outcome.truncated[0]), info_of(outcome, 0))

    def render(self) -> Optional[Array]:
        """The world as it is now: uint8 (rows, columns, 3)."""
        return picture(self._task.worlds[0]) if self.render_mode else None


def task_of(floors: Floors, robots: int, settings: Optional[Settings], robot: Optional[Settings],
            threads: int = 1) -> CoverageTask:
    """The task that the arguments of an environment describe."""
    config = from_mapping(RobotConfig, robot or {}, 'robot')
    plans = [map_file.load(floor, config.drive.radius) if isinstance(floor, str) else floor for floor in floors]
    return CoverageTask(plans, robots, from_mapping(TaskConfig, settings or {}, 'settings'), config, threads)


def checked(render_mode: Optional[str]) -> Optional[str]:
    """A render mode that there is.

    Raises:
        ConfigError: there is no such mode.
    """
    if render_mode not in (None, *RENDER_MODES):
        raise ConfigError(f'render_mode is {render_mode!r}: must be None or {" or ".join(RENDER_MODES)}')
    return render_mode


def info_of(outcome: Outcome, index: int) -> Dict[str, Any]:
    """What people want to know of a step of one robot beside its reward."""
    return {'coverage': float(outcome.coverage[index]), 'is_success': bool(outcome.succeeded[index]),
            'reward': {name: float(part[index]) for name, part in outcome.parts.items()}}


def _alone(seen: Seen) -> Seen:
    """What the only robot sees."""
    return {name: rows[0] for name, rows in seen.items()}


if ID not in gymnasium.registry:
    gymnasium.register(ID, entry_point=f'{__name__}:CoverageEnv',
                       vector_entry_point='rumba_evaluation.learning.vector_environment:CoverageVectorEnv')
