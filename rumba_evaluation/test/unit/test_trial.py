"""A mission in process needs the time, distance and charge that can be calculated by hand."""

import dataclasses
import math
import pathlib

import numpy as np
import pytest
from evaluations import register_simple_strategies
from rooms import room

from rumba_cleaning.control import observe
from rumba_cleaning.mission.stages import State
from rumba_cleaning.outcome import Outcome
from rumba_evaluation.trials.cases import ANYWHERE, Conditions
from rumba_evaluation.trials.trial import Trial
from rumba_sim.model.common.config import updated
from rumba_sim.model.common.errors import ConfigError, StrategyError, WorldError
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.maps import map_file
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation.obstacle import Obstacle

ROBOT = RobotConfig()
STUDIO = pathlib.Path(__file__).resolve().parents[3] / 'rumba_sim' / 'maps' / 'studio.yaml'
BRUSH_SPEED = 0.17 * 0.3  # [m^2/s] width of the brush, cleaning speed


@pytest.fixture(autouse=True)
def _simple_strategies(monkeypatch):
    register_simple_strategies(monkeypatch)


def hall(**kwargs):
    """A long room with a robot at its left end that faces right."""
    return room(8.0, 1.0, start=Pose(0.5, 0.5, 0.0), **kwargs)


def ran(plan, strategy, seconds=math.inf, **kwargs):
    """A trial that ran for a time [s], or to its end."""
    trial = Trial(plan, strategy, **kwargs)
    while not trial.is_over and trial.working_time < seconds - 0.05:
        trial.step()
    return trial


def test_ideal_time_is_reachable_area_by_width_of_the_brush_and_speed():
    half = 0.5 * ROBOT.brush.width
    rim = 2.0 * (ROBOT.drive.radius - half)
    area = (8.0 - rim) * (1.0 - rim) - (4.0 - math.pi) * half ** 2
    result = Trial(hall(), 'wait').result()
    assert result.area == pytest.approx(area, rel=0.005)
    assert result.ideal_time == pytest.approx(result.area / BRUSH_SPEED)


def test_coverage_grows_linearly_while_the_robot_drives_straight_on():
    trial = ran(hall(), 'ahead', 20.0)
    result = trial.result()
    gain = ROBOT.brush.width * 0.3 / result.area  # [1/s]
    begins_after = 0.1 + 0.3 / 0.9 / 2.0  # [s] the first step begins the mission; acceleration
    for percent in (2, 5, 10, 15):
        late = result.time_to(percent) - (percent / 100.0 / gain + begins_after)
        assert abs(late) < 0.3, percent  # a stride, a step, an error of 1 %
        assert result.multiple_to(percent) == result.time_to(percent) / result.ideal_time
    assert result.time_to(len(result.curve) + 1) == math.inf
    assert result.coverage == pytest.approx((20.0 - begins_after) * gain, rel=0.02)
    assert result.distance == pytest.approx((20.0 - begins_after) * 0.3, abs=0.01) and result.turns == 0.0


def test_turns_to_both_sides_are_added_up_and_charge_is_load_times_time():
    result = ran(hall(), 'turn', 120.0).result()
    assert result.turns == pytest.approx(120.0 / (2.0 * math.pi), rel=0.01) and result.distance == 0.0
    battery, wheels = ROBOT.battery, 0.5 * ROBOT.drive.wheel_base * 1.0  # [m/s] of each wheel at 1 rad/s
    load = battery.idle_current + battery.wheel_current_slow + (
        battery.wheel_current - battery.wheel_current_slow) * wheels / battery.wheel_speed
    assert result.charge_used == pytest.approx(load * 120.0 / 3600.0, rel=0.01)
    assert 16.0 < result.energy / result.charge_used < 17.7  # [V] of a full battery
    assert math.isnan(result.energy_per_area)


def test_the_energy_does_not_depend_on_the_drain_of_the_battery():
    slow, fast = (ran(hall(), 'turn', 10.0, conditions=Conditions(drain=drain)) for drain in (1.0, 50.0))
    assert fast.result().charge_used == pytest.approx(slow.result().charge_used, rel=0.01)
    left = [trial.world.robots['rumba'].battery.state_of_charge for trial in (slow, fast)]
    assert (1.0 - left[1]) == pytest.approx(50.0 * (1.0 - left[0]), rel=0.01)


def test_a_robot_observes_ten_times_a_second_and_knows_at_once_that_it_is_docked():
    trial = ran(room(3.0, 2.0, dock=Pose(2.82, 1.0, 0.0)), 'wait', 0.3)
    assert trial.missions[0].state is State.UNDOCKING
    free = ran(hall(), 'wait', 0.4)
    assert [one.dt for one in free.missions[0]._cleaning.seen] == [0.1, 0.1, 0.1]
    assert free.world.tick == 1 + 4 * 5


def test_an_observation_has_the_values_of_the_sensors():
    trial = ran(hall(), 'ahead', 30.0)
    seen, robot = observe(trial.world, 'rumba', 0.1), trial.world.robots['rumba']
    assert seen.pose == robot.pose and seen.bumper == (True, True) and not seen.is_docked
    assert list(seen.cliffs) == [False] * 4 and seen.state_of_charge == np.float32(robot.battery.state_of_charge) < 1.0
    assert trial.result().collisions == 1


# --- how it ends --------------------------------------------------------------------------------------------------

def test_a_trial_ends_at_the_bound_of_the_working_time():
    trial = ran(hall(), 'wait', conditions=Conditions(bound=0.1))
    result = trial.result()
    assert result.outcome is Outcome.TIMED_OUT and result.message == '0.0 % swept; working'
    assert 0.0 <= result.time - 0.1 * result.ideal_time < 0.1


def test_a_failure_is_a_result():
    result = ran(hall(), 'give_up').result()
    assert (result.outcome, result.message) == (Outcome.FAILED, '0.0 % swept: no,\nnever')
    assert (result.curve, result.docked) == ((), 0)


def test_a_target_of_zero_is_met_at_once():
    assert ran(hall(), 'ahead', conditions=Conditions(target=0.0)).result().outcome is Outcome.SUCCEEDED


def test_charging_time_is_no_working_time():
    plan = room(2.0, 1.5, dock=Pose(1.82, 0.75, 0.0))
    trial = ran(plan, 'boustrophedon', conditions=Conditions(drain=60.0, bound=100.0), seed=1)
    result, [mission] = trial.result(), trial.missions
    assert result.charges == mission.charges > 0 and result.charging_time > 30.0
    assert result.charging_time == pytest.approx(mission.charging_time, abs=0.3 * result.charges)
    assert trial.working_time == pytest.approx(result.time - result.charging_time)
    assert all(seconds <= trial.working_time for seconds in result.curve)


def test_on_the_dock_the_loads_use_no_charge_of_the_battery():
    trial = Trial(room(2.0, 1.5, dock=Pose(1.82, 0.75, 0.0)), 'wait')
    trial.world.robots['rumba'].state['charge'] *= 0.1
    for _ in range(100):
        trial.step()
    result = trial.result()
    assert trial.missions[0].state is State.CHARGING and result.docked == 1
    assert (result.charge_used, result.energy) == (0.0, 0.0) and trial.working_time == pytest.approx(0.0, abs=0.11)


def test_boustrophedon_cleans_a_room_and_comes_home():
    result = ran(room(2.0, 1.5, dock=Pose(1.82, 0.75, 0.0)), 'boustrophedon').result()
    assert result.outcome is Outcome.SUCCEEDED and result.docked == 1 and not result.penetrated
    assert result.coverage > 0.98 and result.multiple_to(90) < 2.0


@pytest.mark.parametrize('x, penetrated', [(0.1740, False), (0.1725, True)])
def test_a_body_in_a_wall_is_reported(x, penetrated):
    trial = Trial(hall(), 'wait')
    trial.world.robots['rumba'].state['x'] = x
    trial.step()
    assert trial.result().penetrated == penetrated


@pytest.mark.parametrize('gap, penetrated', [(0.0, False), (-0.002, True)])
def test_a_body_in_an_obstacle_is_reported(gap, penetrated):
    trial = Trial(hall(), 'wait', obstacles=[Obstacle('leg', Pose(2.0, 0.5, 0.0), height=0.05, radius=0.1)])
    trial.world.robots['rumba'].state['x'] = 2.0 - 0.1 - ROBOT.drive.radius - gap
    trial.step()
    assert trial.result().penetrated == penetrated


CLIFF = (2.0, 0.0, 4.0, 1.0)


def test_a_fall_ends_the_trial():
    trial = ran(hall(cliff=CLIFF), 'ahead', 2.0)
    trial.world.robots['rumba'].state['x'] = 2.5  # pushed: by itself it stops at the edge
    while not trial.is_over:
        trial.step()
    result = trial.result()
    assert result.outcome is Outcome.FALLEN and not result.penetrated and result.distance < 2.0
    assert result.message.startswith('fell over a cliff; ') and result.message.endswith(' % swept; working')
    assert result.time < 10.0 and trial.is_over


def test_a_robot_that_has_not_fallen_goes_on_when_another_has():
    trial = Trial(hall(cliff=CLIFF), 'ahead', Conditions(bound=1.0), robots=2)
    trial.world.robots['rumba'].state['x'] = 2.5  # pushed over the edge
    trial.world.robots['rumba2'].state['x'] = 5.0  # beyond the cliff
    while not trial.is_over:
        trial.step()
    first, second = trial.world.robots.values()
    assert first.has_fallen and not second.has_fallen
    result = trial.result()
    assert result.outcome is Outcome.FALLEN
    assert trial.working_time == pytest.approx(result.ideal_time, abs=0.1)
    assert result.message.startswith('rumba: fell over a cliff; ') and '; rumba2: 1' in result.message
    seen = [len(mission._cleaning.seen) for mission in trial.missions]
    assert 5 * seen[0] < seen[1]  # a fallen robot gets no commands


@pytest.mark.parametrize('ends, outcome', [
    ([], Outcome.TIMED_OUT), ([(0, 'fail', Outcome.NO_PATH)], Outcome.TIMED_OUT),
    ([(0, 'succeed', Outcome.SUCCEEDED), (1, 'fail', Outcome.BATTERY_EMPTY)], Outcome.BATTERY_EMPTY),
    ([(0, 'fail', Outcome.NO_PATH), (1, 'fail', Outcome.FAILED)], Outcome.NO_PATH),
    ([(0, 'succeed', Outcome.INCOMPLETE), (1, 'fail', Outcome.FAILED)], Outcome.FAILED),
    ([(0, 'succeed', Outcome.SUCCEEDED), (1, 'succeed', Outcome.INCOMPLETE)], Outcome.INCOMPLETE),
    ([(0, 'succeed', Outcome.SUCCEEDED), (1, 'succeed', Outcome.SUCCEEDED)], Outcome.SUCCEEDED)])
def test_of_several_robots_the_first_with_the_worst_end_gives_the_outcome(ends, outcome):
    trial = Trial(hall(), 'wait', robots=2)
    for number, method, code in ends:
        getattr(trial.missions[number], method)('end', code)
    assert trial.result().outcome is outcome and trial.is_over == (len(ends) == 2)


# --- robots and seeds ---------------------------------------------------------------------------------------------

def test_results_are_sums_over_the_robots_but_t_belongs_to_the_floor():
    one, two = (ran(hall(), 'turn', 10.0, robots=count).result() for count in (1, 2))
    assert two.ideal_time == one.ideal_time and two.time == one.time
    assert two.turns == pytest.approx(2.0 * one.turns, rel=1e-3)
    assert two.message == 'rumba: 0.0 % swept; working; rumba2: 0.0 % swept; working'


def test_time_counts_as_charging_time_only_while_all_robots_charge():
    trial = Trial(hall(), 'wait', robots=2)
    for robot in trial.world.robots.values():
        robot.state['charge'] *= 0.5
    for charging, expected in ((0, 0.1), (1, 0.2), (2, 0.2)):
        for mission in trial.missions[:charging]:
            mission.state = State.CHARGING
        trial.step()
        assert trial.working_time == pytest.approx(expected)


def test_runs_of_the_same_seed_are_equal_and_of_another_seed_differ():
    first, again, other = (dataclasses.astuple(ran(room(2.0, 1.5), 'bounce', 60.0, seed=seed).result())
                           for seed in (5, 5, 6))
    assert first == again != other


def test_a_start_anywhere_depends_on_the_seed():
    plan = room(4.0, 3.0)
    starts = [Trial(plan, 'wait', Conditions(start=ANYWHERE), seed).world.robots['rumba'].pose
              for seed in (1, 1, 2, 3, 4)]
    assert starts[0] == starts[1] and len(set(starts)) == 4


def test_robots_of_one_world_have_random_numbers_of_their_own():
    first, second = Trial(hall(), 'bounce', robots=2).contexts
    assert first.generator.random() != second.generator.random()


def test_an_unknown_strategy_and_too_many_robots_are_refused():
    with pytest.raises(StrategyError, match="unknown strategy 'tidy': known are .*bounce"):
        Trial(hall(), 'tidy')
    with pytest.raises(WorldError, match='no room for another robot'):
        Trial(room(1.0, 0.5), 'wait', robots=4)


def test_a_result_has_the_digest_of_its_last_tick():
    first, second, other = (ran(hall(), 'ahead', 5.0, seed=seed) for seed in (1, 1, 2))
    assert first.result().digest == second.result().digest == first.world.digest() != other.result().digest
    assert first.result().ticks == first.world.tick


@pytest.mark.thorough
def test_a_mission_by_a_pose_that_is_localised_meets_its_target_and_one_by_odometry_is_lost():
    """The floor is the studio's, where the laser sees furniture and odometry drifts by metres."""
    plan = map_file.load(STUDIO)
    outcomes = {}
    for pose in ('localised', 'odometry'):
        trial = Trial(plan, 'boustrophedon', Conditions(pose=pose, target=0.5), seed=4)
        while not trial.is_over:
            trial.step()
        outcomes[pose] = trial.result()
    assert outcomes['localised'].outcome is Outcome.SUCCEEDED and outcomes['localised'].coverage >= 0.5
    assert outcomes['localised'].docked == 1
    assert outcomes['odometry'].coverage < outcomes['localised'].coverage


def test_a_robot_that_makes_its_map_must_start_at_its_dock():
    with pytest.raises(ConfigError, match='^start is .anywhere.: must be dock with pose slam, or robots do not know '
                                          'where their dock is$'):
        Conditions(start=ANYWHERE, pose='slam')


def test_robots_without_a_map_do_not_know_what_they_miss_and_are_no_team():
    plan = room(8.0, 1.0, start=Pose(0.5, 0.5, 0.0))
    trial = ran(plan, 'spiral', conditions=Conditions(pose='mapless', target=0.5), robots=2)
    assert [mission.outcome for mission in trial.missions] == [Outcome.SUCCEEDED] * 2
    assert trial.result().outcome is Outcome.INCOMPLETE and not trial.contexts[0].mates.reports
    assert ran(plan, 'spiral', conditions=Conditions(pose='mapless', target=0.01)).result().outcome is Outcome.SUCCEEDED


def test_a_mission_without_a_map_is_not_bounded_by_t_but_ends_by_itself():
    trial = Trial(room(1.0, 1.0), 'bounce', Conditions(pose='mapless', bound=0.1))
    for _ in range(100):
        trial.step()
    assert not trial.is_over and trial.working_time > 0.1 * trial.ideal_time


def test_a_robot_that_makes_its_map_is_not_shown_the_floor():
    plan = room(3.0, 2.0, 0.02, boxes=[(1.5, 0.0, 1.6, 1.2)], dock=Pose(0.21, 1.0, math.pi))
    known = Trial(plan, 'explore_and_clean', Conditions(pose='slam')).contexts[0].plan
    assert known is not plan
    assert 0.3 < known.free.sum() / plan.free.sum() < 0.95


def test_a_pose_of_no_known_kind_is_refused():
    with pytest.raises(ConfigError, match='^pose is .dreamt.: must be one of truth, localised, odometry, slam, '
                                          'mapless$'):
        Conditions(pose='dreamt')


@pytest.mark.parametrize('model', ['ideal', 'lds01'])
def test_a_trial_has_the_laser_of_its_conditions_and_otherwise_the_robot_that_it_is_given(model):
    robot = updated(ROBOT, {'laser': {'x': 0.1, 'beams': 90}, 'battery': {'drain': 3.0}}, 'test')
    config = Trial(hall(), 'wait', Conditions(laser_model=model, drain=2.0), robot=robot).world.config
    assert (config.laser.model, config.laser.x, config.battery.drain) == (model, 0.1, 2.0)
    assert config.laser.beams == (90 if model == 'ideal' else 360)
