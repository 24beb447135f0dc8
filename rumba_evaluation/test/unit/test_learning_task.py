"""The task of the learning environment, without Gymnasium: what robots see, and what they are rewarded for."""

import math
import subprocess
import sys

import numpy as np
import pytest
from rooms import room

from rumba_evaluation.learning.baselines import Bouncing, Random
from rumba_evaluation.learning.coverage_task import MOVES, CoverageTask
from rumba_evaluation.learning.picture import BODY, FLOOR, SWEPT, WALL, picture
from rumba_evaluation.learning.rooms import room as numbered
from rumba_evaluation.learning.rooms import rooms
from rumba_evaluation.learning.task_config import TaskConfig
from rumba_sim.model.common.config import from_mapping, updated
from rumba_sim.model.common.errors import CommandError, ConfigError, WorldError
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.settings.robot_config import RobotConfig

STEADY = updated(RobotConfig(), {'odometry': {'scale_error': 0.0, 'noise': 0.0, 'floor_traction': 1.0},
                                 'laser': {'noise': 0.0}}, 'test')
HALL = room(8.0, 5.0, 0.05, start=Pose(1.5, 1.0, 0.0), dock=Pose(7.8, 4.0, 0.0))
AHEAD, STILL = np.array([[1.0, 0.0, 1.0]]), np.array([[0.0, 0.0, 1.0]])
ROOMS = rooms(0, 4)


def task(floors=(HALL,), robots=1, robot=STEADY, **settings):
    """A task; robots start where the plan says, unless it says otherwise."""
    found = CoverageTask(floors, robots, from_mapping(TaskConfig, {'start': 'dock', **settings}, 'test'), robot)
    found.reset(range(robots))
    return found


def reward_of(found, action, steps):
    """Sum of the rewards of an action that is repeated, and the last outcome."""
    total = 0.0
    for _ in range(steps):
        outcome = found.step(action)
        total += outcome.reward[0]
    return total, outcome


def place(found, x, y, theta):
    """Put the robot elsewhere."""
    found.worlds[0].teleport('rumba', Pose(x, y, theta))


def test_sweeping_straight_ahead_is_worth_one_in_each_step_less_its_time():
    found = task(actions='continuous', reward={'time': 0.25})
    reward_of(found, AHEAD, 10)  # up to its speed
    total, outcome = reward_of(found, AHEAD, 100)
    assert total == pytest.approx(100 * 0.75, rel=0.02)
    assert not outcome.terminated[0] and not outcome.truncated[0]
    assert outcome.coverage[0] == found.worlds[0].floor.coverage


def test_brushes_that_are_lifted_sweep_nothing():
    total, outcome = reward_of(task(reward={'time': 0.25}), np.array([[1.0, 0.0, -1.0]]), 40)
    assert total == -10.0 and outcome.coverage[0] == 0.0


def test_a_bump_costs_once_while_the_robot_stays_there():
    found = task(reward={'bump': 3.0, 'time': 0.0, 'swept': 0.0})
    place(found, 7.0, 1.0, 0.0)
    assert reward_of(found, AHEAD, 40)[0] == -3.0


def test_the_target_ends_an_episode_and_is_worth_something():
    found = task(target=0.01, reward={'finish': 7.0, 'time': 0.0, 'swept': 0.0})
    steps = 0
    while True:
        steps, outcome = steps + 1, found.step(AHEAD)
        if outcome.terminated[0]:
            break
        assert outcome.reward[0] == 0.0 and outcome.coverage[0] < 0.01
    assert outcome.reward[0] == 7.0 and outcome.coverage[0] >= 0.01 and 5 < steps < 100


def test_a_fall_ends_an_episode_and_costs():
    found = task([room(4.0, 3.0, cliff=(2.0, 0.0, 4.0, 3.0), start=Pose(1.5, 1.5, 0.0))],
                 reward={'fall': 9.0, 'time': 0.0, 'swept': 0.0})
    seen = found.look()
    while not seen['cliff'].any():
        assert not found.step(AHEAD).terminated[0]
        seen = found.look()
    total, outcome = reward_of(found, AHEAD, 4)
    while not outcome.terminated[0]:
        outcome = found.step(AHEAD)
    assert outcome.reward[0] == -9.0 and total >= -9.0


def test_an_empty_battery_ends_an_episode():
    found = task(robot=updated(STEADY, {'battery': {'drain': 2000.0}}, 'test'))
    charge, steps = 1.0, 0
    while not found.step(AHEAD).terminated[0]:
        seen, steps = found.look()['battery'][0, 0], steps + 1
        assert seen < charge and steps < 100
        charge = seen
    assert found.look()['battery'][0, 0] == 0.0


@pytest.mark.parametrize('hold, steps', [(1, 30), (3, 10)])
def test_the_time_limit_cuts_an_episode_off(hold, steps):
    found = task(time_limit=3.0, hold=hold)
    assert [bool(found.step(AHEAD).truncated[0]) for _ in range(steps)] == [False] * (steps - 1) + [True]
    assert found.worlds[0].time == pytest.approx(3.0)


def test_one_long_step_is_several_short_ones():
    long, short = task(hold=10), task()
    total, _ = reward_of(short, AHEAD, 10)
    assert long.step(AHEAD).reward[0] == pytest.approx(total)
    assert long.worlds[0].digest() == short.worlds[0].digest()


def test_no_reward_is_out_of_the_range_that_is_told():
    found = CoverageTask(ROOMS, 20, from_mapping(TaskConfig, {'target': 0.02, 'time_limit': 20.0}, 'test'))
    found.reset(range(20))
    driver, rewards = Random(20, 3), []
    for _ in range(300):
        outcome = found.step(driver.act({}))
        rewards.extend(outcome.reward)
        ended = np.flatnonzero(outcome.terminated | outcome.truncated)
        if len(ended):
            found.reset([None] * len(ended), ended)
    assert found.lowest_reward <= min(rewards) < -0.5 and 50.0 < max(rewards) <= found.highest_reward


# --- what robots see ------------------------------------------------------------------------------------------------

def test_a_robot_sees_walls_bumper_dock_battery_and_its_way():
    found = task(beams=8)
    place(found, 1.0, 2.0, math.pi / 2.0)  # faces +y: 3 m ahead, 1 m to the left, 2 m behind, 7 m to the right
    seen = found.look()
    np.testing.assert_allclose(seen['ranges'][0, ::2] * 8.0, [2.0, 7.0, 3.0, 1.0], atol=1e-6)
    assert seen['bumper'].tolist() == [[0.0, 0.0]] and seen['cliff'].tolist() == [[0.0, 0.0, 0.0, 0.0]]
    assert seen['battery'].tolist() == [[1.0]] and not seen['dock'].any()
    reward_of(found, AHEAD, 20)
    x, y, cos, sin, v, w = found.look()['odometry'][0]
    # The origin of the odometry is where the robot began, at heading 0.
    assert (y, cos, sin, w) == (0.0, 1.0, 0.0, 0.0) and v == pytest.approx(0.3, abs=0.03)
    assert x == pytest.approx(found.worlds[0].robots['rumba'].pose.y - 2.0, abs=0.002) and x > 0.5
    place(found, 7.0, 4.05, 0.0)  # before the dock, a little to the left of its axis
    assert found.look()['dock'][0].reshape(3, 3).tolist() == 3 * [[0.0, 0.0, 1.0]]
    place(found, 7.815, 2.0, 0.8)  # the wall touches it on the right
    reward_of(found, AHEAD, 6)
    assert found.look()['bumper'].tolist() == [[0.0, 1.0]]


def test_a_range_without_a_wall_is_one_and_one_that_is_too_near_is_zero():
    found = task(beams=4, robot=updated(STEADY, {'laser': {'range_max': 2.0, 'range_min': 1.2}}, 'test'))
    place(found, 1.0, 2.6, 0.0)
    np.testing.assert_allclose(found.look()['ranges'], [[0.0, 1.0, 1.0, 1.0]])


def test_a_laser_that_does_not_see_all_around_keeps_its_field_of_view_and_tells_nothing_from_too_near():
    exact = {'noise': 0.0, 'relative_noise': 0.0, 'dropouts': 0.0}
    robot = updated(STEADY, {'laser': {'model': 'urg04lx', **exact}}, 'test')
    found = task(beams=24, robot=robot)
    place(found, 1.0, 2.6, 0.0)
    laser = found.worlds[0].config.laser
    assert math.degrees(23 * laser.increment) == pytest.approx(230.0, abs=5.0)
    ranges = found.look()['ranges'][0]
    assert ranges.shape == (24,) and ranges[12] == 1.0 and (ranges > 0.0).all() and (ranges < 1.0).any()


def test_maps_are_as_many_and_as_large_as_asked_for():
    found = task(maps=3, map_size=10, map_pitch=0.1, map_factor=2.0)
    place(found, 0.5, 2.0, 0.0)
    maps = found.look()['maps']
    assert maps.shape == (1, 6, 10, 10) and maps.dtype == np.uint8
    # 0.5 m behind is the wall: the rows from the middle on to which that is.
    assert [int((maps[0, 2 * scale, 5:, 5] > 130).sum()) for scale in range(3)] == [0, 2, 4]


def test_discrete_actions_are_moves():
    for number, (v, w) in enumerate(MOVES):
        found = task(actions='discrete')
        place(found, 4.0, 2.5, 0.0)
        reward_of(found, np.array([number]), 10)
        twist = found.worlds[0].robots['rumba'].twist
        assert twist.v == pytest.approx(0.3 * v, abs=1e-9) and twist.w == pytest.approx(1.9 * w, abs=1e-9)
        assert not found.worlds[0].robots['rumba'].brushes_up


# --- seeds ----------------------------------------------------------------------------------------------------------

VARIED = {'variation': {'acceleration': 0.3, 'traction': 0.1, 'odometry': 0.5, 'laser': 0.5, 'capacity': 0.2,
                        'charge': 0.5}, 'start': 'anywhere', 'maps': 1}


def played(robots, seeds, which):
    """All that one of several robots sees and gets, over several episodes."""
    found = CoverageTask(ROOMS, robots, from_mapping(TaskConfig, {**VARIED, 'time_limit': 4.0}, 'test'))
    seen = found.reset(seeds)
    driver, record = Random(1, 5), []
    for _ in range(100):
        record.append({name: rows[which].tolist() for name, rows in seen.items()})
        outcome = found.step(np.repeat(driver.act(seen), robots, axis=0))
        record.append((outcome.reward[which], outcome.coverage[which]))
        seen = found.look()
        if outcome.truncated[which]:
            seen = {name: rows.copy() for name, rows in seen.items()}
            for name, rows in found.reset([None] * robots, np.arange(robots)).items():
                seen[name] = rows
    return record


def test_a_seed_is_a_run_whoever_else_is_there():
    alone = played(1, [7], 0)
    assert played(3, [1, 7, 3], 1) == alone
    assert played(3, [1, 7, 3], 2) != alone


def test_robots_vary_as_the_settings_say_and_only_then():
    configs = {}
    for settings in ({}, VARIED):
        found = CoverageTask(ROOMS[:1], 6, from_mapping(TaskConfig, settings, 'test'))
        found.reset(range(6))
        configs[len(settings)] = [found.worlds[index].config for index in range(6)]
        charges = found.look()['battery'][:, 0]
    assert len(set(configs[0])) == 1 and len(set(configs[len(VARIED)])) == 6
    for config in configs[len(VARIED)]:
        assert abs(config.drive.acceleration / 0.9 - 1.0) <= 0.3
        assert 0.9 * 0.98 <= config.odometry.floor_traction <= 0.98
        assert config.odometry.noise / 0.002 == pytest.approx(config.odometry.scale_error / 0.01)
        assert 0.8 * 2.7 <= config.battery.capacity <= 2.7 and config.laser.beams == 24
    assert len(set(charges)) == 6 and charges.min() >= 0.5 and charges.max() < 1.0


def test_bounce_sweeps_more_than_chance():
    coverage = {}
    for driver in (Bouncing(8, 1), Random(8, 1)):
        found = CoverageTask(ROOMS, 8)
        seen = found.reset(range(8))
        for _ in range(1200):
            outcome = found.step(driver.act(seen))
            seen = found.look()
        coverage[type(driver)] = outcome.coverage.mean()
    assert coverage[Bouncing] > 0.25 > 2.0 * coverage[Random] > 0.0


# --- rooms and pictures ---------------------------------------------------------------------------------------------

def test_a_number_is_a_room_in_which_most_of_the_floor_can_be_cleaned():
    several = rooms(5, 12)
    assert len({plan.occupancy.tobytes() for plan in several}) == 12
    numbered.cache_clear()
    for plan, again in zip(several, rooms(5, 12)):
        assert plan is not again and np.array_equal(plan.occupancy, again.occupancy) and plan.dock == again.dock
        found = CoverageTask([plan], 1, from_mapping(TaskConfig, {'start': 'dock'}, 'test'))
        found.reset([0])
        assert found.worlds[0].robots['rumba'].pose == plan.dock
        assert found.worlds[0].floor.reachable_area > 4.0
        found.step(STILL)
        assert found.worlds[0].robots['rumba'].is_docked


def test_a_picture_shows_walls_floor_what_is_swept_and_the_robot():
    found = task()
    reward_of(found, AHEAD, 60)
    x, y, _ = found.worlds[0].robots['rumba'].pose
    pixels = picture(found.worlds[0])
    pitch = (8.0 + 0.1) / pixels.shape[1]

    def at(x, y):
        return tuple(pixels[pixels.shape[0] - 1 - int((y + 0.05) / pitch), int((x + 0.05) / pitch)])
    assert pixels.dtype == np.uint8 and at(-0.03, 2.0) == WALL and at(x - 0.1, y) == BODY
    assert at(2.2, 1.0) == SWEPT and at(2.2, 3.0) == FLOOR


@pytest.mark.parametrize('arguments, message', [
    ({'floors': ()}, 'no floor'), ({'robots': 0}, 'robots is 0'), ({'time_limt': 3.0}, "did you mean 'time_limit'"),
    ({'reward': {'bump': -1.0}}, 'reward/bump is -1.0: must be 0 to 1000'),
    ({'actions': 'both'}, 'must be continuous or discrete')])
def test_settings_that_make_no_task_are_refused(arguments, message):
    with pytest.raises(ConfigError, match=message):
        task(**arguments)


@pytest.mark.parametrize('actions, action, message', [
    ('discrete', [6], 'action 6: must be 0 to 5'), ('discrete', [-1], 'action -1: must be 0 to 5'),
    ('discrete', [1.0], 'actions are of type float64: must be whole numbers'),
    ('discrete', [[1]], r'the shape of actions is \(1, 1\): must be \(1,\), for 1 robots'),
    ('continuous', [[1.0, 0.0]], r'the shape of actions is \(1, 2\): must be \(1, 3\), for 1 robots'),
    ('continuous', [['a', 'b', 'c']], 'must be numbers'),
    ('continuous', [[math.nan, 0.0, 0.0]], 'action nan: is not a finite number')])
def test_an_action_that_is_none_is_refused_and_changes_nothing(actions, action, message):
    found = task(actions=actions)
    before = found.worlds[0].digest()
    with pytest.raises(CommandError, match=message):
        found.step(np.array(action))
    assert found.worlds[0].digest() == before


def test_a_step_before_reset_is_refused():
    with pytest.raises(WorldError, match='no episode has begun: call reset first'):
        CoverageTask([HALL]).step(AHEAD)


def test_a_robot_whose_episode_has_ended_cannot_act_until_it_begins_again():
    found = task(time_limit=0.1, robots=2)
    assert found.step(np.repeat(AHEAD, 2, axis=0)).truncated.all()
    found.reset([None], np.array([1]))
    with pytest.raises(WorldError, match='the episode of robot 0 has ended'):
        found.step(np.repeat(AHEAD, 2, axis=0))
    outcome = found.step(np.repeat(AHEAD, 2, axis=0), np.array([False, True]))
    assert outcome.reward[0] == 0.0 and outcome.truncated.tolist() == [True, True]


def test_the_parts_of_a_reward_tell_where_it_comes_from():
    found = task(reward={'time': 0.25, 'finish': 7.0}, target=0.02)
    while not found.ended[0]:
        outcome = found.step(AHEAD)
        assert sum(part[0] for part in outcome.parts.values()) == outcome.reward[0]
        assert outcome.parts['time'].tolist() == [-0.25] and outcome.parts['bump'].tolist() == [0.0]
        assert outcome.parts['finish'][0] == 7.0 * outcome.succeeded[0]
    assert outcome.succeeded[0] and outcome.parts['swept'][0] > 0.0 == outcome.parts['fall'][0]


def test_rooms_are_made_when_an_episode_is_there():
    numbered.cache_clear()
    found = CoverageTask(range(100))
    assert numbered.cache_info().currsize == 0
    for _ in range(5):
        found.reset([None])
    assert 1 <= numbered.cache_info().currsize <= 5


def test_without_gymnasium_the_message_says_what_to_install():
    code = 'import sys; sys.modules["gymnasium"] = None\nimport rumba_evaluation.learning.environment'
    done = subprocess.run([sys.executable, '-c', code], stderr=subprocess.PIPE, universal_newlines=True)
    assert done.stderr.splitlines()[-1] == (
        "ImportError: the learning environment needs Gymnasium 1.1 or later: pip install 'gymnasium>=1.1'")
