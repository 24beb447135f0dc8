"""A mission leaves the dock, cleans, charges when it must, never strands without need, and returns to the dock."""

import itertools
import math
import re

import pytest
from drivers import context_of, run, with_box
from missions import DOCK, PLAN, mission, percent_swept, states, until
from rooms import RADIUS, crooked, quiet, room

from rumba_cleaning.behaviour import STOP, Observation, Status
from rumba_cleaning.belief.swept import Swept
from rumba_cleaning.control import observe, steps
from rumba_cleaning.mission.mission import Mission
from rumba_cleaning.mission.stages import State
from rumba_cleaning.outcome import Outcome
from rumba_sim.model.common.errors import ConfigError, StrategyError
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.simulation.world import World


def test_it_undocks_cleans_and_comes_home():
    world, behaviour = mission()
    home = [State.RETURNING, State.DOCKING]
    found = states(behaviour, world)
    assert found in [[State.UNDOCKING, State.CLEANING, *tries * home, State.IDLE] for tries in (1, 2)]
    assert behaviour.status is Status.SUCCEEDED
    assert world.robots['rumba'].is_docked
    assert world.floor.coverage >= 0.98
    assert (behaviour.message, behaviour.outcome) == ('98.0 % swept', Outcome.SUCCEEDED)
    assert (behaviour.charges, behaviour.charging_time) == (0, 0.0)


def test_brushes_are_down_only_while_it_cleans():
    world, behaviour = mission()
    for _, command in steps(behaviour, world):
        assert command.brushes_up or behaviour.state is State.CLEANING


def test_it_charges_when_it_must_and_goes_on_where_it_left_off():
    world, behaviour = mission(drain=30.0)
    coverage, least, charge_back = [], 1.0, []
    for observation, _ in steps(behaviour, world, seconds=6000.0):
        least = min(least, observation.state_of_charge)
        if behaviour.state is State.CHARGING:
            coverage.append(world.floor.coverage)
            charge_back.append(observation.state_of_charge)
    assert behaviour.status is Status.SUCCEEDED
    assert behaviour.charges >= 1
    assert behaviour.charging_time == pytest.approx(0.1 * len(charge_back), abs=1.0)
    assert 0.0 < least < 0.5
    assert max(charge_back) > 0.94
    assert 0.2 < coverage[0] < 0.97
    assert world.floor.coverage >= 0.98


@pytest.mark.thorough(except_for=['100.0'])
@pytest.mark.parametrize('drain', [5.0, 20.0, 60.0, 100.0])
def test_it_never_strands_however_fast_the_battery_runs_down(drain):
    world, behaviour = mission(drain=drain)
    least = min(observation.state_of_charge for observation, _ in steps(behaviour, world, seconds=20000.0))
    assert least > 0.0
    assert world.robots['rumba'].is_docked


def test_a_battery_that_brings_nothing_is_not_charged_for_ever():
    world, behaviour = mission(drain=600.0)
    run(behaviour, world, seconds=20000.0)
    assert behaviour.status is Status.FAILED
    assert '3 charges brought no more: the battery does not last' in behaviour.message
    assert behaviour.outcome is Outcome.BATTERY_LOW


def test_an_almost_empty_battery_is_charged_before_it_leaves():
    world, behaviour = mission(charge=0.1, drain=60.0)
    assert states(behaviour, world, 9000.0)[:3] == [State.CHARGING, State.UNDOCKING, State.CLEANING]


def test_far_from_home_with_little_charge_it_goes_home_first():
    world, behaviour = mission(start=Pose(0.4, 0.4, 0.0), charge=0.06, drain=20.0)
    assert states(behaviour, world, 9000.0)[:4] == [State.CLEANING, State.RETURNING, State.DOCKING, State.CHARGING]
    assert behaviour.status is Status.SUCCEEDED


def test_without_a_dock_it_ends_where_it_is():
    world, behaviour = mission(crooked(), start=Pose(0.4, 0.4, 0.0))
    assert states(behaviour, world) == [State.CLEANING, State.IDLE]
    assert behaviour.status is Status.SUCCEEDED
    assert world.floor.coverage >= 0.98


def test_without_a_dock_a_low_battery_ends_it():
    world, behaviour = mission(crooked(), start=Pose(0.4, 0.4, 0.0), drain=60.0)
    run(behaviour, world)
    assert behaviour.status is Status.FAILED
    assert behaviour.message.endswith('% swept: the battery is low, and no path leads to a dock')
    assert behaviour.outcome is Outcome.BATTERY_LOW
    assert world.robots['rumba'].battery.state_of_charge > 0.0


def test_a_dock_that_no_path_leads_to_counts_as_none():
    plan = room(4.0, 3.0, boxes=[(2.4, 0.0, 2.6, 3.0)], dock=DOCK, start=Pose(1.0, 1.0, 0.0))
    world, behaviour = mission(plan)
    assert State.RETURNING not in states(behaviour, world)
    assert behaviour.status is Status.SUCCEEDED
    assert world.floor.coverage >= 0.98


def test_if_another_robot_occupies_the_dock_the_message_says_so_and_how_much_is_swept():
    world, behaviour = mission(start=Pose(0.4, 0.4, 0.0), target=0.3)
    world.spawn('rumba2', DOCK, brushes_up=True)
    run(behaviour, world)
    assert (behaviour.status, behaviour.state) == (Status.FAILED, State.STRANDED)
    assert re.fullmatch(r'3\d\.\d % swept: 3 attempts to dock failed: something keeps the robot from the contacts',
                        behaviour.message)
    assert behaviour.outcome is Outcome.BLOCKED


def test_an_empty_battery_strands_it():
    world, behaviour = mission()
    for number, _ in enumerate(steps(behaviour, world)):
        if number == 200:
            world.robots['rumba'].state['charge'] = 0.0
    assert (behaviour.status, behaviour.state, behaviour.message) == (
        Status.FAILED, State.STRANDED, 'the battery is empty')
    assert behaviour.outcome is Outcome.BATTERY_EMPTY


def test_moved_while_charging_it_goes_on():
    world, behaviour = mission(drain=30.0)
    carried = False
    for _ in steps(behaviour, world, seconds=9000.0):
        if behaviour.state is State.CHARGING and not carried:
            carried = True
            world.teleport('rumba', Pose(0.5, 2.7, 1.0))
    assert carried
    assert behaviour.status is Status.SUCCEEDED
    assert world.robots['rumba'].is_docked


def test_moved_while_cleaning_it_cleans_the_rest():
    world, behaviour = mission()
    for number, _ in enumerate(steps(behaviour, world)):
        if number in (300, 700):
            world.teleport('rumba', Pose(0.5, 2.7, 1.0) if number == 300 else Pose(3.5, 2.5, 0.0))
    assert behaviour.status is Status.SUCCEEDED
    assert world.floor.coverage >= 0.97


def test_what_the_map_does_not_show_is_cleaned_around():
    truth = with_box(PLAN, (1.8, 1.2, 2.2, 1.6))
    world, behaviour = mission(truth=truth)
    run(behaviour, world, seconds=3000.0)
    assert (behaviour.status, behaviour.outcome) == (Status.SUCCEEDED, Outcome.SUCCEEDED)
    of_map, beside = map(float, re.fullmatch(r'(.*) % swept, (.*) % of what lies beside obstacles',
                                             behaviour.message).groups())
    assert 90.0 < of_map < 98.0 <= beside  # of its map it misses a box
    assert world.robots['rumba'].is_docked
    assert world.floor.coverage >= 0.98  # of what can be reached in truth


@pytest.mark.thorough
def test_two_robots_clean_one_floor_without_harm():
    world, first = mission()
    world.spawn('rumba2', Pose(0.5, 0.5, 0.0), brushes_up=True)
    second = Mission(context_of(PLAN, world, seed=2), 'boustrophedon', 0.9)
    both = itertools.zip_longest(steps(first, world, 'rumba', 3000.0), steps(second, world, 'rumba2', 3000.0))
    for _ in both:
        a, b = (world.robots[name].pose for name in ('rumba', 'rumba2'))
        assert math.hypot(a.x - b.x, a.y - b.y) >= 2.0 * RADIUS - 1e-6
    assert world.floor.coverage >= 0.97


def test_restarted_it_forgets_what_was_swept_and_begins_again():
    world, behaviour = mission()
    until(behaviour, world, 0.4)
    behaviour.restart()
    assert (behaviour.status, behaviour.message) == (Status.RUNNING, '')
    run(behaviour, world, seconds=1.0)
    assert percent_swept(behaviour) < 5.0
    run(behaviour, world)
    assert behaviour.status is Status.SUCCEEDED


def test_at_the_end_it_answers_stop():
    world, behaviour = mission(target=0.2)
    run(behaviour, world)
    assert behaviour.step(Observation(0.1, world.robots['rumba'].pose)) == STOP


def test_it_stops_its_part_when_it_is_stopped():
    world, behaviour = mission()
    run(behaviour, world, seconds=20.0)
    assert behaviour.state is State.CLEANING
    ends = []
    behaviour._cleaning.terminate = lambda: ends.append('cleaning')
    behaviour.stop()
    behaviour.stop()
    assert ends == ['cleaning']


def test_a_mission_whose_strategy_has_done_its_job_below_the_target_comes_home_and_is_no_success():
    world, behaviour = mission(start=Pose(0.6, 0.6, 0.0), strategy='spiral')
    run(behaviour, world)
    assert world.robots['rumba'].is_docked
    assert (behaviour.status, behaviour.outcome) == (Status.FAILED, Outcome.INCOMPLETE)
    assert re.fullmatch(r'\d+\.\d % swept, the target is 98\.0 %: (a spot|something) .*', behaviour.message)


def test_a_fall_ends_a_mission_and_is_a_failure():
    world, behaviour = mission(plan=crooked(), start=Pose(0.6, 0.6, 0.0))
    run(behaviour, world, seconds=5.0)
    world.robots['rumba'].state['fallen'] = 1
    run(behaviour, world, seconds=5.0)
    assert (behaviour.status, behaviour.outcome, behaviour.state) == (
        Status.FAILED, Outcome.FALLEN, State.STRANDED)
    assert behaviour.message == 'a wheel hangs over a cliff: the robot must be put elsewhere'


def test_once_all_is_swept_a_target_of_all_is_met_at_once(monkeypatch):
    """Although the account of a robot may err, no more than all can be swept."""
    plan = room(2.0, 1.5, start=Pose(0.5, 0.5, 0.0))
    world = World(plan, quiet())
    world.spawn('rumba')
    behaviour = Mission(context_of(plan, world), 'boustrophedon', 1.0)
    until(behaviour, world, 0.01)
    monkeypatch.setattr(Swept, 'coverage', 1.0)
    behaviour.step(observe(world, 'rumba', 0.1))
    assert behaviour.outcome is Outcome.SUCCEEDED


def test_the_context_that_it_is_made_with_keeps_its_target():
    context = context_of(PLAN, World(PLAN), target_coverage=0.7)
    config = context.config
    one, other = Mission(context, 'bounce', 0.5), Mission(context, 'spiral', 0.6)
    assert (one.strategy, other.strategy) == ('bounce', 'spiral')
    assert context.config is config and context.target_coverage == 0.7


@pytest.mark.thorough(except_for=['boustrophedon'])
@pytest.mark.parametrize('strategy', ['bounce', 'boustrophedon'])
def test_the_same_mission_is_the_same_bit_for_bit(strategy):
    digests = set()
    for _ in range(2):
        world, behaviour = mission(strategy=strategy, target=0.5)
        run(behaviour, world)
        digests.add(world.digest())
    assert len(digests) == 1


@pytest.mark.parametrize('target', [-0.1, 1.1, math.nan])
def test_a_target_out_of_range_is_refused(target):
    with pytest.raises(ConfigError, match='target_coverage is .*: must be 0 to 1'):
        mission(target=target)


def test_an_unknown_strategy_is_refused_with_those_that_are_known():
    with pytest.raises(StrategyError, match="unknown strategy 'zigzag': known are .*boustrophedon.*spiral"):
        mission(strategy='zigzag')
