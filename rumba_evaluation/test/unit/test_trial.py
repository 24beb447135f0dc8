"""A mission in process takes the time, the way and the charge that can be worked out by hand."""

import dataclasses
import math

import pytest
from evaluations import know_manners
from rooms import room

from rumba_cleaning.control import observe
from rumba_cleaning.mission.mission import State
from rumba_evaluation.trials.cases import ANYWHERE, Conditions
from rumba_evaluation.trials.trial import Trial
from rumba_sim.model.errors import StrategyError, WorldError
from rumba_sim.model.geometry import Pose
from rumba_sim.model.robot_config import RobotConfig

ROBOT = RobotConfig()
BRUSH_SPEED = 0.17 * 0.3  # [m^2/s] width of the brush, cleaning speed


@pytest.fixture(autouse=True)
def _manners(monkeypatch):
    know_manners(monkeypatch)


def hall(**kwargs):
    """A long room, with a robot at its left end that looks along it."""
    return room(8.0, 1.0, start=Pose(0.5, 0.5, 0.0), **kwargs)


def ran(plan, strategy, seconds=math.inf, **kwargs):
    """A trial after so many seconds, or at its end."""
    trial = Trial(plan, strategy, **kwargs)
    while not trial.is_over and trial.working_time < seconds - 0.05:
        trial.step()
    return trial


def test_ideal_time_is_the_area_in_reach_by_brush_and_speed():
    plan = hall()
    area = plan.reachable(0.5, 0.5, ROBOT.drive.radius, ROBOT.brush.width).sum() * plan.resolution ** 2
    result = Trial(plan, 'wait').result()
    assert result.area == pytest.approx(area) and result.ideal_time == pytest.approx(area / BRUSH_SPEED)


def test_straight_on_at_cleaning_speed_coverage_grows_as_t():
    """The brush sweeps whole cells that it touches: 4 rows of 5 cm."""
    trial = ran(hall(), 'ahead', 20.0)
    result = trial.result()
    gain = 4 * 0.05 * 0.3 / result.area  # [1/s]
    begins_after = 0.1 + 0.3 / 0.9 / 2.0  # [s] the first update begins the mission; speeding up
    for percent in (2, 5, 10, 15):
        late = result.time_to(percent) - (percent / 100.0 / gain + begins_after)
        assert abs(late) < 0.05 / 0.3 + 0.1, percent  # a cell, an update
        assert result.multiple_to(percent) == result.time_to(percent) / result.ideal_time
    assert result.time_to(len(result.curve) + 1) == math.inf
    assert result.coverage == pytest.approx((20.0 - begins_after) * gain, rel=0.02)
    assert result.distance == pytest.approx((20.0 - begins_after) * 0.3, abs=0.01) and result.turns == 0.0


def test_turns_count_to_either_side_and_charge_is_load_times_time():
    result = ran(hall(), 'turn', 120.0).result()
    assert result.turns == pytest.approx(120.0 / (2.0 * math.pi), rel=0.01) and result.distance == 0.0
    battery, wheels = ROBOT.battery, 0.5 * ROBOT.drive.wheel_base * 1.0  # [m/s] of each wheel at 1 rad/s
    load = battery.idle_current + battery.wheel_current_slow + (
        battery.wheel_current - battery.wheel_current_slow) * wheels / battery.wheel_speed
    assert result.charge_used == pytest.approx(load * 120.0 / 3600.0, rel=0.01)
    assert 16.0 < result.energy / result.charge_used < 17.7  # [V] of a full battery
    assert math.isnan(result.energy_per_area)


def test_the_drain_of_the_battery_is_not_in_the_energy():
    slow, fast = (ran(hall(), 'turn', 10.0, conditions=Conditions(drain=drain)) for drain in (1.0, 50.0))
    assert fast.result().charge_used == pytest.approx(slow.result().charge_used, rel=0.01)
    left = [trial.world.robots['rumba'].battery.state_of_charge for trial in (slow, fast)]
    assert (1.0 - left[1]) == pytest.approx(50.0 * (1.0 - left[0]), rel=0.01)


def test_a_robot_looks_ten_times_a_second_and_knows_of_its_dock_at_once():
    trial = ran(room(3.0, 2.0, dock=Pose(2.82, 1.0, 0.0)), 'wait', 0.3)
    assert trial.missions[0].state is State.UNDOCKING
    free = ran(hall(), 'wait', 0.4)
    assert [one.dt for one in free.missions[0]._cleaning.seen] == [0.1, 0.1, 0.1]
    assert free.world.tick == 1 + 4 * 5


def test_observe_tells_what_the_sensors_tell():
    trial = ran(hall(), 'ahead', 30.0)
    seen, robot = observe(trial.world, 'rumba', 0.1), trial.world.robots['rumba']
    assert seen.pose == robot.pose and seen.bumper == (True, True) and not seen.is_docked
    assert list(seen.cliffs) == [False] * 4 and seen.state_of_charge == robot.battery.state_of_charge < 1.0
    assert trial.result().collisions == 1


# --- how it ends --------------------------------------------------------------------------------------------------

def test_it_is_given_up_after_so_many_times_t():
    trial = ran(hall(), 'wait', conditions=Conditions(bound=0.1))
    result = trial.result()
    assert result.outcome == 'time out' and result.message == '0.0 % swept; at it'
    assert 0.0 <= result.time - 0.1 * result.ideal_time < 0.1


def test_a_failure_is_a_result():
    result = ran(hall(), 'give_up').result()
    assert (result.outcome, result.message, result.curve, result.docked) == ('failed', '0.0 % swept: no,\nnever', (), 0)


def test_a_target_of_nothing_is_met_at_once():
    assert ran(hall(), 'ahead', conditions=Conditions(target=0.0)).result().outcome == 'succeeded'


def test_charging_time_is_told_apart():
    plan = room(2.0, 1.5, dock=Pose(1.82, 0.75, 0.0))
    trial = ran(plan, 'boustrophedon', conditions=Conditions(drain=60.0, bound=100.0), seed=1)
    result, [mission] = trial.result(), trial.missions
    assert result.charges == mission.charges > 0 and result.charging_time > 30.0
    assert result.charging_time == pytest.approx(mission.charging_time, abs=0.3 * result.charges)
    assert trial.working_time == pytest.approx(result.time - result.charging_time)
    assert all(seconds <= trial.working_time for seconds in result.curve)


def test_at_the_dock_the_charger_feeds_the_loads():
    trial = Trial(room(2.0, 1.5, dock=Pose(1.82, 0.75, 0.0)), 'wait')
    trial.world.robots['rumba'].state['charge'] *= 0.1
    for _ in range(100):
        trial.step()
    result = trial.result()
    assert trial.missions[0].state is State.CHARGING and result.docked == 1
    assert (result.charge_used, result.energy) == (0.0, 0.0) and trial.working_time == pytest.approx(0.0, abs=0.11)


def test_boustrophedon_cleans_a_room_and_comes_home():
    result = ran(room(2.0, 1.5, dock=Pose(1.82, 0.75, 0.0)), 'boustrophedon').result()
    assert result.outcome == 'succeeded' and result.docked == 1 and not result.penetrated
    assert result.coverage > 0.98 and result.multiple_to(90) < 2.0


@pytest.mark.parametrize('x, penetrated', [(0.1740, False), (0.1725, True)])
def test_a_body_in_a_wall_is_noticed(x, penetrated):
    trial = Trial(hall(), 'wait')
    trial.world.robots['rumba'].state['x'] = x
    trial.step()
    assert trial.result().penetrated == penetrated


def test_a_fall_is_noticed():
    result = ran(hall(cliff=(2.0, 0.0, 4.0, 1.0)), 'ahead', 10.0).result()
    assert result.penetrated and result.distance < 2.0


# --- robots and seeds ---------------------------------------------------------------------------------------------

def test_robots_are_summed_up_but_t_is_that_of_the_floor():
    one, two = (ran(hall(), 'turn', 10.0, robots=count).result() for count in (1, 2))
    assert two.ideal_time == one.ideal_time and two.time == one.time
    assert two.turns == pytest.approx(2.0 * one.turns, rel=1e-3)
    assert two.message == 'rumba: 0.0 % swept; at it; rumba2: 0.0 % swept; at it'


def test_time_is_charging_time_only_while_all_robots_charge():
    trial = Trial(hall(), 'wait', robots=2)
    for robot in trial.world.robots.values():
        robot.state['charge'] *= 0.5
    for charging, expected in ((0, 0.1), (1, 0.2), (2, 0.2)):
        for mission in trial.missions[:charging]:
            mission.state = State.CHARGING
        trial.step()
        assert trial.working_time == pytest.approx(expected)


def test_a_seed_gives_one_run_and_another_gives_another():
    first, again, other = (dataclasses.astuple(ran(room(2.0, 1.5), 'bounce', 60.0, seed=seed).result())
                           for seed in (5, 5, 6))
    assert first == again != other


def test_anywhere_is_where_the_seed_says():
    plan = room(4.0, 3.0)
    starts = [Trial(plan, 'wait', Conditions(start=ANYWHERE), seed).world.robots['rumba'].pose
              for seed in (1, 1, 2, 3, 4)]
    assert starts[0] == starts[1] and len(set(starts)) == 4


def test_robots_in_one_world_draw_their_own_turns():
    first, second = Trial(hall(), 'bounce', robots=2).contexts
    assert first.generator.random() != second.generator.random()


def test_what_cannot_be_is_refused():
    with pytest.raises(StrategyError, match="unknown strategy 'tidy': known are .*bounce"):
        Trial(hall(), 'tidy')
    with pytest.raises(WorldError, match='no room for another robot'):
        Trial(room(1.0, 0.5), 'wait', robots=4)
