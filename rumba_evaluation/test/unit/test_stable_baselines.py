"""The environment as stable-baselines3 takes it."""

import numpy as np
import pytest

from rumba_sim.model.common.errors import RumbaError

pytest.importorskip('stable_baselines3', reason='stable-baselines3 is optional: pip install stable-baselines3')
from stable_baselines3 import PPO  # noqa: E402
from stable_baselines3.common.vec_env import VecMonitor  # noqa: E402

from rumba_evaluation.learning.stable_baselines import CoverageVecEnv  # noqa: E402
from rumba_evaluation.learning.vector_environment import CoverageVectorEnv  # noqa: E402

SHORT = {'time_limit': 1.0, 'maps': 1, 'map_size': 8}


def played(seed, steps=25):
    """Rewards, ends and infos of three robots that drive straight ahead."""
    robots = CoverageVecEnv(3, floors=range(3), settings=SHORT)
    robots.seed(seed)
    seen = [robots.reset()]
    rows = []
    for _ in range(steps):
        after, *row = robots.step(np.tile([1.0, 0.0, 1.0], (3, 1)))
        seen.append(after)
        rows.append(row)
    return seen, rows


def test_it_plays_what_the_environment_of_gymnasium_plays():
    seen, rows = played(seed=7)
    robots = CoverageVectorEnv(3, floors=range(3), settings=SHORT, autoreset='SameStep')
    expected, _ = robots.reset(seed=7)
    for (reward, ended, infos), before in zip(rows, seen):
        np.testing.assert_array_equal(before['ranges'], expected['ranges'])
        expected, rewards, terminated, truncated, info = robots.step(np.tile([1.0, 0.0, 1.0], (3, 1)))
        np.testing.assert_array_equal(reward, rewards.astype(np.float32))
        np.testing.assert_array_equal(ended, terminated | truncated)
        for index in np.flatnonzero(ended):
            assert infos[index]['coverage'] == info['final_info']['coverage'][index]
            np.testing.assert_array_equal(infos[index]['terminal_observation']['ranges'],
                                          info['final_obs']['ranges'][index])


def test_an_episode_ends_by_the_time_limit_and_says_so():
    _, rows = played(seed=1)
    ends = [step for step, (_, ended, _) in enumerate(rows) if ended.any()]
    assert ends == [9, 19]
    assert all(info['TimeLimit.truncated'] and not info['is_success'] for info in rows[9][2])
    assert 'terminal_observation' not in rows[8][2][0]


def test_the_policy_gets_only_what_it_asked_for():
    robots = CoverageVecEnv(2, seen=('bumper',), floors=range(2), settings=SHORT)
    assert list(robots.observation_space.spaces) == ['bumper'] and list(robots.reset()) == ['bumper']
    with pytest.raises(RumbaError, match="a robot does not see 'speed': it sees "):
        CoverageVecEnv(2, seen=('speed',), floors=range(2))


def test_it_has_pictures_if_they_are_asked_for():
    robots = CoverageVecEnv(2, floors=range(2), settings=SHORT, render_mode='rgb_array')
    robots.reset()
    assert [picture.shape[2] for picture in robots.get_images()] == [3, 3]
    assert CoverageVecEnv(2, floors=range(2), settings=SHORT).get_images() == [None, None]


def test_ppo_learns_with_it():
    robots = VecMonitor(CoverageVecEnv(4, floors=range(2), settings={'time_limit': 1.0, 'actions': 'discrete'}))
    model = PPO('MultiInputPolicy', robots, n_steps=16, batch_size=32, n_epochs=1, seed=1, device='cpu')
    model.learn(256)
    assert model.num_timesteps == 256 and len(model.ep_info_buffer) == 24
