"""The environment rumba/Coverage-v0 for many robots at once, as a vector environment of Gymnasium.

    import gymnasium
    environments = gymnasium.make_vec('rumba_evaluation.learning.environment:rumba/Coverage-v0', num_envs=1024)
"""

from typing import Any, Dict, List, Optional, Sequence, Tuple, Union

import numpy as np

from rumba_evaluation.learning import spaces
from rumba_evaluation.learning.coverage_task import Seen
from rumba_evaluation.learning.environment import FRAMES, RENDER_MODES, Floors, Settings, checked, task_of
from rumba_evaluation.learning.picture import picture
from rumba_evaluation.learning.spaces import AutoresetMode, gymnasium
from rumba_sim.model.common.errors import ConfigError
from rumba_sim.model.kernel import Array


class CoverageVectorEnv(gymnasium.vector.VectorEnv):
    """Many robots, each in a world of its own; robot i plays what one robot alone plays with its seed."""

    def __init__(self, num_envs: int = 1, floors: Floors = range(100), settings: Optional[Settings] = None,
                 robot: Optional[Settings] = None, render_mode: Optional[str] = None, threads: int = 1,
                 autoreset: str = AutoresetMode.NEXT_STEP.value) -> None:
        """Prepare.

        Args, apart from those of `CoverageEnv`:
            num_envs: how many robots.
            threads: how many cores to use.
            autoreset: 'NextStep', 'SameStep' or 'Disabled', as `gymnasium.vector.AutoresetMode` explains.

        Raises:
            RumbaError: as for `CoverageEnv`, or there is no such way to reset.
        """
        self._task = task_of(floors, num_envs, settings, robot, threads)
        modes = [mode.value for mode in AutoresetMode]
        if autoreset not in modes:
            raise ConfigError(f'autoreset is {autoreset!r}: must be {" or ".join(modes)}')
        self._autoreset = AutoresetMode(autoreset)
        self.metadata = {'render_modes': RENDER_MODES, 'render_fps': FRAMES, 'autoreset_mode': self._autoreset}
        self.num_envs = num_envs
        self.single_observation_space = spaces.observations(self._task.config)
        self.single_action_space = spaces.actions(self._task.config)
        self.observation_space = gymnasium.vector.utils.batch_space(self.single_observation_space, num_envs)
        self.action_space = gymnasium.vector.utils.batch_space(self.single_action_space, num_envs)
        self.render_mode = checked(render_mode)
        self._ended = np.zeros(num_envs, np.bool_)
        self._seen: Seen = {}

    def reset(self, *, seed: Union[int, Sequence[Optional[int]], None] = None,
              options: Optional[Dict[str, Any]] = None) -> Tuple[Seen, Dict[str, Any]]:
        """Begin episodes: with a seed s, robot i gets the seed s + i.

        The option `reset_mask`, bool (num_envs), names the robots that begin; the others stay as they are.
        """
        super().reset(seed=None)
        seeds = self._seeds(seed)
        mask = (options or {}).get('reset_mask')
        if mask is None:
            self._ended[:] = False
            self._seen = self._task.reset(seeds)
        else:
            which = np.flatnonzero(mask)
            self._ended[which] = False
            self._seen = _replaced(self._seen, which, self._task.reset([seeds[index] for index in which], which))
        return self._seen, {'coverage': self._task.worlds.coverage}

    def _seeds(self, seed: Union[int, Sequence[Optional[int]], None]) -> List[Optional[int]]:
        """A seed for each robot."""
        if seed is None:
            return [None] * self.num_envs
        if isinstance(seed, (int, np.integer)):
            return [int(seed) + index for index in range(self.num_envs)]
        if len(seed) != self.num_envs:
            raise ConfigError(f'there are {len(seed)} seeds: must be {self.num_envs}, one for each robot')
        return list(seed)

    def step(self, actions: Array) -> Tuple[Seen, Array, Array, Array, Dict[str, Any]]:
        """Let each robot act for a step; episodes that ended begin again as `autoreset` says.

        Raises:
            RumbaError: an action is none, no episode has begun, or one has ended and nobody has reset it.
        """
        ended = self._ended if self._autoreset is AutoresetMode.NEXT_STEP else np.zeros(self.num_envs, np.bool_)
        if ended.any():
            outcome = self._task.step(np.asarray(actions), ~ended)
            self._seen = self._begin_again(np.flatnonzero(ended), self._task.look(np.flatnonzero(~ended)))
        else:
            outcome = self._task.step(np.asarray(actions))
            self._seen = self._task.look()
        info: Dict[str, Any] = {}
        terminated, truncated = outcome.terminated & ~ended, outcome.truncated & ~ended
        self._ended = terminated | truncated
        if self._autoreset is AutoresetMode.SAME_STEP and self._ended.any():
            info = {'final_obs': self._seen, '_final_obs': self._ended, '_final_info': self._ended,
                    'final_info': {'coverage': outcome.coverage, '_coverage': self._ended,
                                   'is_success': outcome.succeeded, '_is_success': self._ended}}
            which = np.flatnonzero(self._ended)
            self._seen = _replaced(self._seen, which, self._task.reset([None] * len(which), which))
        info.update(coverage=self._task.worlds.coverage, is_success=outcome.succeeded & ~ended, reward=outcome.parts)
        return self._seen, outcome.reward, terminated, truncated, info

    def _begin_again(self, which: Array, seen: Seen) -> Seen:
        """Begin episodes with some robots; returns what all see, if the others see `seen`."""
        begun = self._task.reset([None] * len(which), which)
        return {name: np.insert(rows, which - np.arange(len(which)), begun[name], axis=0)
                for name, rows in seen.items()}

    def render(self) -> Optional[Tuple[Array, ...]]:
        """The worlds as they are now: for each uint8 (rows, columns, 3)."""
        if self.render_mode is None:
            return None
        worlds = self._task.worlds
        return tuple(picture(worlds[index]) for index in range(len(worlds)))


def _replaced(seen: Seen, which: Array, rows: Seen) -> Seen:
    """What all robots see, if some of them see `rows` now; the arrays are new ones."""
    after = {name: old.copy() for name, old in seen.items()}
    for name, new in rows.items():
        after[name][which] = new
    return after
