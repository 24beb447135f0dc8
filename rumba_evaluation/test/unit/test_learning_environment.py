"""The environment rumba/Coverage-v0, by the rules of Gymnasium, alone and for many robots."""

import copy
import pickle

import numpy as np
import pytest

from rumba_sim.model.common.errors import RumbaError

gymnasium = pytest.importorskip('gymnasium', minversion='1.1', reason="Gymnasium is optional: pip install 'gymnasium'")
from gymnasium.utils.env_checker import check_env  # noqa: E402

from rumba_evaluation.learning.baselines import Bouncing  # noqa: E402

NAME = 'rumba_evaluation.learning.environment:rumba/Coverage-v0'
SHORT = {'time_limit': 1.0, 'maps': 1, 'map_size': 8}


def vector(robots=3, **arguments):
    """Many robots at once."""
    return gymnasium.make_vec(NAME, num_envs=robots, vectorization_mode='vector_entry_point',
                              **{'floors': range(3), 'settings': SHORT, **arguments})


def alone(**arguments):
    """One robot."""
    return gymnasium.make(NAME, **{'floors': range(3), 'settings': SHORT, **arguments})


def assert_same(seen, other):
    """What two robots see is the same."""
    assert seen.keys() == other.keys()
    for name, rows in seen.items():
        np.testing.assert_array_equal(rows, other[name], name)


@pytest.mark.filterwarnings('ignore:.*Box observation space.*infinity')
@pytest.mark.parametrize('settings', [{}, {'maps': 2, 'actions': 'discrete', 'hold': 3}])
def test_it_keeps_the_rules_of_gymnasium(settings):
    check_env(alone(settings=settings, render_mode='rgb_array').unwrapped)


@pytest.mark.parametrize('settings', [SHORT, {**SHORT, 'actions': 'discrete'}])
def test_each_of_many_robots_plays_what_it_plays_alone(settings):
    many, each = vector(settings=settings), [alone(settings=settings) for _ in range(3)]
    seen, _ = many.reset(seed=5)
    many.action_space.seed(1)
    ended = [False] * 3
    for index, robot in enumerate(each):
        assert_same({name: rows[index] for name, rows in seen.items()}, robot.reset(seed=5 + index)[0])
    for _ in range(25):
        actions = many.action_space.sample()
        seen, reward, terminated, truncated, info = many.step(actions)
        assert many.observation_space.contains(seen)
        for index, robot in enumerate(each):
            if ended[index]:  # the vector environment begins again in the step after the end
                expected = (robot.reset()[0], 0.0, False, False, {'coverage': 0.0, 'is_success': False})
            else:
                expected = robot.step(actions[index])
            assert_same({name: rows[index] for name, rows in seen.items()}, expected[0])
            assert (reward[index], terminated[index], truncated[index]) == expected[1:4]
            assert info['coverage'][index] == expected[4]['coverage']
            assert info['is_success'][index] == expected[4]['is_success']
            assert sum(part[index] for part in info['reward'].values()) == expected[1]
            ended[index] = expected[2] or expected[3]
    assert len({float(rows.sum()) for rows in seen['ranges']}) == 3


def test_a_robot_may_begin_again_in_the_step_in_which_its_episode_ends():
    same, other = vector(autoreset='SameStep'), vector()
    assert_same(same.reset(seed=2)[0], other.reset(seed=2)[0])
    actions = np.ones((3, 3), np.float32)
    for step in range(1, 11):
        seen, _, _, truncated, info = same.step(actions)
        expected, _, _, _, expected_info = other.step(actions)
        assert truncated.all() == (step == 10) == ('final_obs' in info)
    assert_same(info['final_obs'], expected)
    np.testing.assert_array_equal(info['final_info']['coverage'], expected_info['coverage'])
    assert (info['coverage'] == 0.0).all() and (expected_info['coverage'] > 0.0).all()
    assert_same(seen, other.step(actions)[0])


def test_without_autoreset_the_mask_says_who_begins_again():
    many = vector(autoreset='Disabled')
    many.reset(seed=2)
    for _ in range(10):
        before, _, _, truncated, _ = many.step(np.ones((3, 3), np.float32))
    assert truncated.all()
    first = alone()
    seen, _ = many.reset(seed=[7, 8, 9], options={'reset_mask': np.array([False, True, False])})
    assert_same({name: rows[1] for name, rows in seen.items()}, first.reset(seed=8)[0])
    for index in (0, 2):
        assert_same({name: rows[index] for name, rows in seen.items()},
                    {name: rows[index] for name, rows in before.items()})
    with pytest.raises(RumbaError, match='the episode of robot 0 has ended: call reset before it acts again'):
        many.step(np.ones((3, 3), np.float32))
    many.reset(options={'reset_mask': np.array([True, False, True])})
    assert not many.step(np.ones((3, 3), np.float32))[3].any()


@pytest.mark.parametrize('copied', [copy.deepcopy, lambda made: pickle.loads(pickle.dumps(made))])
@pytest.mark.parametrize('make, arguments', [(alone, {}), (vector, {}), (vector, {'threads': 2})])
def test_a_copy_in_the_middle_of_an_episode_goes_on_as_the_environment_does(make, arguments, copied):
    first = make(**arguments)
    first.reset(seed=4)
    first.action_space.seed(1)
    actions = [first.action_space.sample() for _ in range(18)]
    for action in actions[:5]:
        first.step(action)
    second = copied(first.unwrapped)
    for number, action in enumerate(actions[5:10 if make is alone else None]):
        seen, *rest = first.step(action)
        other, *others = second.step(action)
        assert_same(seen, other)
        np.testing.assert_equal(rest, others)


def test_threads_change_nothing():
    records = []
    for threads in (1, 2):
        many = vector(5, threads=threads)
        seen, _ = many.reset(seed=1)
        for _ in range(15):
            seen, reward, *_ = many.step(np.ones((5, 3), np.float32))
        records.append((seen, reward))
    assert_same(records[0][0], records[1][0])
    np.testing.assert_array_equal(records[0][1], records[1][1])


def test_a_scripted_program_drives_it():
    many, driver = vector(2, settings={'time_limit': 60.0}), Bouncing(2)
    seen, _ = many.reset(seed=1)
    for _ in range(400):
        seen, _, _, _, info = many.step(driver.act(seen).astype(np.float32))
    assert (info['coverage'] > 0.05).all()


def test_it_draws_pictures_if_asked_to():
    robot, many = alone(render_mode='rgb_array'), vector(render_mode='rgb_array')
    robot.reset(seed=1)
    many.reset(seed=1)
    pixels = robot.render()
    assert pixels.dtype == np.uint8 and pixels.ndim == 3 and pixels.shape[2] == 3
    assert len(many.render()) == 3
    np.testing.assert_array_equal(many.render()[0], pixels)


@pytest.mark.parametrize('make, arguments, message', [
    (alone, {'settings': {'time_limt': 1.0}}, "settings: time_limt is unknown: did you mean 'time_limit'"),
    (alone, {'robot': {'drive': {'max_speed': -1}}}, 'robot: drive/max_speed is -1.0'),
    (alone, {'floors': ['/nowhere/map.yaml']}, '/nowhere/map.yaml'),
    (vector, {'autoreset': 'never'}, "autoreset is 'never': must be NextStep or SameStep or Disabled"),
    (vector, {'robots': 0}, 'robots is 0')])
def test_what_it_cannot_be_made_of_is_one_line(make, arguments, message):
    with pytest.raises(RumbaError) as error:
        make(**arguments)
    assert message in str(error.value) and '\n' not in str(error.value)


def test_seeds_are_as_many_as_robots():
    with pytest.raises(RumbaError, match='there are 2 seeds: must be 3'):
        vector().reset(seed=[1, 2])
