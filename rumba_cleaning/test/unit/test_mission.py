"""A mission leaves the dock, cleans, charges when it must, never strands where it need not, and comes home."""

import itertools
import math
import re

import pytest
from drivers import context_of, run, with_box
from rooms import RADIUS, crooked, quiet, room

from rumba_cleaning.behaviour import STOP, Behaviour, Command, Observation, Status
from rumba_cleaning.behaviours.bounded import Bounded
from rumba_cleaning.control import steps
from rumba_cleaning.mission.battery_watch import BatteryWatch
from rumba_cleaning.mission.mission import Mission, State
from rumba_sim.model.errors import ConfigError, StrategyError
from rumba_sim.model.geometry import Pose
from rumba_sim.model.world import World

DOCK = Pose(4.0 - RADIUS - 0.01, 1.2, 0.0)
PLAN = crooked(dock=DOCK)


def mission(plan=PLAN, truth=None, start=None, charge=1.0, strategy='boustrophedon', target=0.98, **battery):
    """A world after its first tick, and a robot that begins a mission."""
    world = World(truth or plan, quiet(battery=battery))
    world.spawn('rumba', start, charge, brushes_up=True)
    world.step()
    return world, Mission(context_of(plan, world), strategy, target)


def states(behaviour, world, seconds=4000.0):
    """The states of a mission, one after the other."""
    return [state for state, _ in itertools.groupby(
        behaviour.state for _ in steps(behaviour, world, seconds=seconds))]


def test_it_undocks_cleans_and_comes_home():
    world, behaviour = mission()
    assert states(behaviour, world) == [State.UNDOCKING, State.CLEANING, State.RETURNING, State.DOCKING, State.IDLE]
    assert behaviour.status is Status.SUCCEEDED
    assert world.robots['rumba'].is_docked
    assert world.floor.coverage >= 0.98
    assert behaviour.message == '98.0 % swept'
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
    assert behaviour.message.endswith('% swept: the battery is low, and no way leads to a dock')
    assert world.robots['rumba'].battery.state_of_charge > 0.0


def test_a_dock_that_no_way_leads_to_is_as_none():
    plan = room(4.0, 3.0, boxes=[(2.4, 0.0, 2.6, 3.0)], dock=DOCK, start=Pose(1.0, 1.0, 0.0))
    world, behaviour = mission(plan)
    assert State.RETURNING not in states(behaviour, world)
    assert behaviour.status is Status.SUCCEEDED
    assert world.floor.coverage >= 0.98


def test_where_another_robot_keeps_the_dock_it_says_so_and_how_much_is_swept():
    world, behaviour = mission(start=Pose(0.4, 0.4, 0.0), target=0.3)
    world.spawn('rumba2', DOCK, brushes_up=True)
    run(behaviour, world)
    assert (behaviour.status, behaviour.state) == (Status.FAILED, State.STRANDED)
    assert re.fullmatch(r'3\d\.\d % swept: 3 attempts to dock failed: something keeps the robot from the contacts',
                        behaviour.message)


def test_an_empty_battery_strands_it():
    world, behaviour = mission()
    for number, _ in enumerate(steps(behaviour, world)):
        if number == 200:
            world.robots['rumba'].state['charge'] = 0.0
    assert (behaviour.status, behaviour.state, behaviour.message) == (
        Status.FAILED, State.STRANDED, 'the battery is empty')


def test_carried_off_while_charging_it_goes_on():
    world, behaviour = mission(drain=30.0)
    carried = False
    for _ in steps(behaviour, world, seconds=9000.0):
        if behaviour.state is State.CHARGING and not carried:
            carried = True
            world.teleport('rumba', Pose(0.5, 2.7, 1.0))
    assert carried
    assert behaviour.status is Status.SUCCEEDED
    assert world.robots['rumba'].is_docked


def test_carried_off_while_cleaning_it_cleans_the_rest():
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
    assert behaviour.status is Status.SUCCEEDED
    assert world.robots['rumba'].is_docked
    assert world.floor.coverage >= 0.98  # of what can be reached in truth


def test_two_robots_clean_one_floor_without_harm():
    world, first = mission()
    world.spawn('rumba2', Pose(0.5, 0.5, 0.0), brushes_up=True)
    second = Mission(context_of(PLAN, world, seed=2), 'boustrophedon', 0.9)
    both = itertools.zip_longest(steps(first, world, 'rumba', 3000.0), steps(second, world, 'rumba2', 3000.0))
    for _ in both:
        a, b = (world.robots[name].pose for name in ('rumba', 'rumba2'))
        assert math.hypot(a.x - b.x, a.y - b.y) >= 2.0 * RADIUS - 1e-6
    assert world.floor.coverage >= 0.97


def test_it_may_end_at_any_moment_and_begin_anew():
    world, behaviour = mission()
    for number, _ in enumerate(steps(behaviour, world)):
        if number == 400:
            break
    behaviour.terminate()
    behaviour.initialise()
    run(behaviour, world)
    assert behaviour.status is Status.SUCCEEDED


def test_at_the_end_it_answers_stop():
    world, behaviour = mission(target=0.2)
    run(behaviour, world)
    assert behaviour.update(Observation(0.1, world.robots['rumba'].pose)) == STOP


def test_the_same_mission_is_the_same_bit_for_bit():
    digests = set()
    for _ in range(2):
        world, behaviour = mission(strategy='bounce', target=0.5)
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


# --- the battery ----------------------------------------------------------------------------------------------------

def test_the_way_home_is_counted_in_charge():
    world, behaviour = mission()
    context = context_of(PLAN, world)
    watch = BatteryWatch(context)
    near, far = watch.needed(Pose(3.0, 1.2, 0.0)), watch.needed(Pose(0.4, 0.4, 0.0))
    rate = (0.19 + 1.0 + 0.5) / (2.7 * 3600.0)
    assert context.config.reserve + 40.0 * rate <= near < far
    assert far - near > rate * 2.5 / context.config.transit_speed


def test_a_charge_that_falls_faster_counts():
    world, _ = mission()
    watch = BatteryWatch(context_of(PLAN, world))
    before = watch.needed(DOCK)
    for tick in range(101):
        watch.update(Observation(0.1, DOCK, state_of_charge=1.0 - 0.001 * tick))
    assert watch.needed(DOCK) - 0.05 == pytest.approx(0.01 * (before - 0.05) / ((0.19 + 1.0 + 0.5) / 9720.0), rel=0.05)


def test_no_way_home_needs_more_than_any_battery_has():
    plan = room(4.0, 3.0, boxes=[(2.4, 0.0, 2.6, 3.0)], dock=DOCK, start=Pose(1.0, 1.0, 0.0))
    world, _ = mission(plan)
    assert BatteryWatch(context_of(plan, world)).needed(Pose(1.0, 1.0, 0.0)) == math.inf


# --- bounds ---------------------------------------------------------------------------------------------------------

class Forever(Behaviour):
    """Goes ahead."""

    def update(self, observation):
        """Ahead."""
        self.message = 'ahead'
        return Command(0.1, 0.0)


def test_what_does_not_end_is_given_up_after_its_time():
    bounded = Bounded(Forever(), 5.0)
    answers = [bounded.update(Observation(0.1, DOCK)) for _ in range(60)]
    assert answers.index(STOP) == 50
    assert (bounded.status, bounded.message) == (Status.FAILED, 'not done after 5 s: ahead')


def test_what_runs_out_of_charge_is_given_up():
    bounded = Bounded(Forever(), 5.0)
    assert bounded.update(Observation(0.1, DOCK, state_of_charge=0.0)) == STOP
    assert (bounded.status, bounded.message) == (Status.FAILED, 'the battery is empty')


def test_begun_anew_it_has_all_its_time_again():
    bounded = Bounded(Forever(), 5.0)
    for _ in range(60):
        bounded.update(Observation(0.1, DOCK))
    bounded.initialise()
    assert bounded.update(Observation(0.1, DOCK)) != STOP
    assert bounded.status is Status.RUNNING
