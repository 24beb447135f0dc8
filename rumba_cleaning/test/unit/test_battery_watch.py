"""The charge that the way to the dock needs is counted from paths and from the rate of discharge."""

import math

import numpy as np
import pytest
from drivers import context_of
from missions import DOCK, PLAN, mission
from rooms import room

from rumba_cleaning.behaviour import Observation
from rumba_cleaning.behaviours.dock import approach
from rumba_cleaning.executors import BeforeNextStep
from rumba_cleaning.mission.battery_watch import BatteryWatch
from rumba_sim.model.common.geometry import Pose

HERE = Pose(1.0, 1.0, 0.0)


def test_the_charge_that_the_way_to_the_dock_needs_grows_with_its_length():
    world, behaviour = mission()
    context = context_of(PLAN, world)
    watch = BatteryWatch(context)
    assert watch.has_home
    near, far = watch.needed(Pose(3.0, 1.2, 0.0)), watch.needed(Pose(0.4, 0.4, 0.0))
    rate = (0.19 + 1.0 + 0.5) / (2.7 * 3600.0)
    assert context.config.reserve + 40.0 * rate <= near < far
    assert far - near > rate * 2.5 / context.config.transit_speed


def test_what_is_enough_for_the_longest_way_is_enough_anywhere_and_less_is_not():
    context = context_of(PLAN, mission()[0])
    watch = BatteryWatch(context)
    nodes = np.argwhere(context.ground.fits)
    needed = [watch.needed(Pose(x, y, 0.0)) for x, y in context.ground.points(nodes).tolist()]
    assert watch.is_enough_anywhere(max(needed)) and not watch.is_enough_anywhere(max(needed) - 1e-6)


def test_a_charge_that_falls_faster_counts():
    world, _ = mission()
    watch = BatteryWatch(context_of(PLAN, world))
    before = watch.needed(DOCK)
    for tick in range(101):
        watch.measure(Observation(0.1, DOCK, state_of_charge=1.0 - 0.001 * tick))
    assert watch.needed(DOCK) - 0.05 == pytest.approx(0.01 * (before - 0.05) / ((0.19 + 1.0 + 0.5) / 9720.0), rel=0.05)


def test_without_a_path_to_the_dock_no_charge_is_enough():
    plan = room(4.0, 3.0, boxes=[(2.4, 0.0, 2.6, 3.0)], dock=DOCK, start=Pose(1.0, 1.0, 0.0))
    world, _ = mission(plan)
    watch = BatteryWatch(context_of(plan, world))
    assert watch.needed(Pose(1.0, 1.0, 0.0)) == math.inf and watch.needed(Pose(3.0, 1.0, 0.0)) < 1.0
    assert watch.is_enough_anywhere(1.0)  # where a path leads there
    assert not BatteryWatch(context_of(room(4.0, 3.0), world)).is_enough_anywhere(1.0)


def test_a_path_that_an_obstacle_barred_is_found_once_the_obstacle_is_forgotten():
    plan = room(4.0, 3.0, boxes=[(2.4, 0.0, 2.6, 2.5)], dock=DOCK, start=Pose(1.0, 1.0, 0.0))
    context = context_of(plan, mission(plan)[0])
    context.ground.mark(2.5, 2.75, 0.1)
    watch = BatteryWatch(context)
    assert watch.needed(Pose(1.0, 1.0, 0.0)) == math.inf
    watch.look(Pose(1.0, 1.0, 0.0))
    assert watch.needed(Pose(1.0, 1.0, 0.0)) == math.inf and not watch.is_looking
    context.ground.forget()
    watch.look(Pose(1.0, 1.0, 0.0))
    assert watch.needed(Pose(1.0, 1.0, 0.0)) < 1.0


def test_no_step_waits_while_paths_are_measured_again():
    plan = room(4.0, 3.0, boxes=[(2.4, 0.0, 2.6, 2.5)], dock=DOCK, start=HERE)
    planners = BeforeNextStep()
    context = context_of(plan, mission(plan)[0])
    context.executor = planners
    context.ground.mark(2.5, 2.75, 0.1)
    watch = BatteryWatch(context)
    assert not watch.is_ready
    planners.work()
    assert watch.is_ready and watch.needed(HERE) == math.inf
    context.ground.forget()
    watch.look(HERE)
    assert watch.is_looking and watch.needed(HERE) == math.inf  # as before, without waiting
    planners.work()
    watch.look(HERE)
    assert not watch.is_looking and watch.needed(HERE) < 1.0


@pytest.mark.parametrize('first', [0.9001, 0.905, 0.91])
def test_a_battery_that_reports_whole_percents_is_not_taken_for_an_empty_one(first):
    watch = BatteryWatch(context_of(PLAN, mission()[0]))
    before = watch.needed(DOCK) - 0.05
    rate = (0.19 + 1.0 + 0.5) / 9720.0
    for tick in range(8000):
        charge = math.ceil(100.0 * (first - 0.5 * rate * tick)) / 100.0
        watch.measure(Observation(0.5, DOCK, state_of_charge=charge))
        assert watch.needed(DOCK) - 0.05 <= 1.3 * before
    assert watch.needed(DOCK) - 0.05 == pytest.approx(before, rel=0.02)


def test_the_way_to_the_dock_is_taken_to_be_longer_than_its_length_by_turns_and_detours():
    watch = BatteryWatch(context_of(PLAN, mission()[0]))
    rate, home = (0.19 + 1.0 + 0.5) / 9720.0, approach(watch._context)
    far = watch.needed(Pose(home.x - 2.0, home.y, 0.0)) - watch.needed(home)
    assert far == pytest.approx(1.6 * 2.0 / 0.45 * rate, rel=0.03)


def test_a_charge_that_falls_more_slowly_than_usual_does_not_make_the_robot_bold():
    watch = BatteryWatch(context_of(PLAN, mission()[0]))
    before = watch.needed(HERE)
    for tick in range(5001):
        watch.measure(Observation(0.1, HERE, state_of_charge=1.0 - 0.00001 * tick))
    assert watch.needed(HERE) == before
