"""The environment rumba/Coverage-v0 for stable-baselines3, which takes no vector environment of Gymnasium.

    from rumba_evaluation.learning.stable_baselines import CoverageVecEnv
    model = PPO('MultiInputPolicy', CoverageVecEnv(64, settings={'actions': 'discrete'}))
"""

from typing import Any, Dict, List, Optional, Sequence

import numpy as np

from rumba_evaluation.learning.coverage_task import Seen
from rumba_evaluation.learning.spaces import AutoresetMode, gymnasium
from rumba_evaluation.learning.vector_environment import CoverageVectorEnv
from rumba_sim.model.common.errors import ConfigError, quoted
from rumba_sim.model.kernel import Array

try:
    from stable_baselines3.common.vec_env import VecEnv
except ImportError:
    raise ImportError('this needs stable-baselines3: pip install stable-baselines3') from None


class CoverageVecEnv(VecEnv):
    """Many robots, each in a world of its own; an episode that ends begins again in the same step."""

    def __init__(self, num_envs: int, seen: Optional[Sequence[str]] = None, **arguments: Any) -> None:
        """Prepare.

        Args:
            num_envs: how many robots.
            seen: names of what the policy gets of what a robot sees, such as 'ranges'; None for all of it.
            arguments: those of `CoverageVectorEnv`, but for `autoreset`.

        Raises:
            RumbaError: as for `CoverageVectorEnv`, or a robot sees nothing of that name.
        """
        self._robots = CoverageVectorEnv(num_envs, autoreset=AutoresetMode.SAME_STEP.value, **arguments)
        spaces = self._robots.single_observation_space
        self._names = list(spaces if seen is None else seen)
        for name in self._names:
            if name not in spaces.keys():
                raise ConfigError(f'a robot does not see {quoted(name)}: it sees {", ".join(spaces)}')
        self.render_mode = self._robots.render_mode
        super().__init__(num_envs, gymnasium.spaces.Dict({name: spaces[name] for name in self._names}),
                         self._robots.single_action_space)
        self._actions: Array = np.empty(0)

    def _chosen(self, seen: Seen) -> Seen:
        return {name: seen[name] for name in self._names}

    def reset(self) -> Seen:
        """Begin all episodes, with the seeds that `seed` has set."""
        seen, info = self._robots.reset(seed=self._seeds)
        self._reset_seeds()
        self.reset_infos = [{'coverage': float(coverage)} for coverage in info['coverage']]
        return self._chosen(seen)

    def step_async(self, actions: Array) -> None:
        """Take an action for each robot; `step_wait` carries them out."""
        self._actions = actions

    def step_wait(self) -> Any:
        """Let each robot act for a step: what they see, rewards float32 (robots), who ended bool (robots), and infos.

        `terminal_observation` is what a robot saw at the end of its episode. `TimeLimit.truncated` is whether only the
        time was up. `coverage` and `is_success` are those of the episode that ended, if it did.

        Raises:
            RumbaError: an action is none, or no episode has begun.
        """
        seen, reward, terminated, truncated, info = self._robots.step(self._actions)
        ended = terminated | truncated
        infos: List[Dict[str, Any]] = [
            {'coverage': float(coverage), 'is_success': bool(success)}
            for coverage, success in zip(info['coverage'], info['is_success'])]
        for index in np.flatnonzero(ended):
            infos[index].update({
                'coverage': float(info['final_info']['coverage'][index]),
                'terminal_observation': {name: info['final_obs'][name][index] for name in self._names},
                'TimeLimit.truncated': bool(truncated[index] and not terminated[index])})
        return self._chosen(seen), reward.astype(np.float32), ended, infos

    def close(self) -> None:
        """Let go of the robots."""
        self._robots.close()

    def get_images(self) -> Sequence[Optional[Array]]:
        """A picture of each world, uint8 (rows, columns, 3); None without a `render_mode`."""
        return self._robots.render() or [None] * self.num_envs

    def get_attr(self, attr_name: str, indices: Any = None) -> List[Any]:
        """An attribute of the vector environment, once for each of the robots: they share it."""
        return [getattr(self._robots, attr_name)] * len(list(self._get_indices(indices)))

    def set_attr(self, attr_name: str, value: Any, indices: Any = None) -> None:
        """Robots have no attributes of their own.

        Raises:
            AttributeError: always.
        """
        raise AttributeError(f'{attr_name} cannot be set: robots have no attributes of their own')

    def env_method(self, method_name: str, *method_args: Any, indices: Any = None, **method_kwargs: Any) -> List[Any]:
        """Robots have no methods of their own.

        Raises:
            AttributeError: always.
        """
        raise AttributeError(f'{method_name} cannot be called: robots have no methods of their own')

    def env_is_wrapped(self, wrapper_class: Any, indices: Any = None) -> List[bool]:
        """Whether a robot's environment is wrapped: none is."""
        return [False] * len(list(self._get_indices(indices)))
