"""The charge that the way to the dock needs is counted from paths and from the rate of discharge."""

import math

import pytest
from drivers import context_of
from missions import DOCK, PLAN, mission
from rooms import room

from rumba_cleaning.behaviour import Observation
from rumba_cleaning.mission.battery_watch import BatteryWatch
from rumba_sim.model.geometry import Pose


def test_the_charge_that_the_way_to_the_dock_needs_grows_with_its_length():
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
        watch.measure(Observation(0.1, DOCK, state_of_charge=1.0 - 0.001 * tick))
    assert watch.needed(DOCK) - 0.05 == pytest.approx(0.01 * (before - 0.05) / ((0.19 + 1.0 + 0.5) / 9720.0), rel=0.05)


def test_without_a_path_to_the_dock_no_charge_is_enough():
    plan = room(4.0, 3.0, boxes=[(2.4, 0.0, 2.6, 3.0)], dock=DOCK, start=Pose(1.0, 1.0, 0.0))
    world, _ = mission(plan)
    assert BatteryWatch(context_of(plan, world)).needed(Pose(1.0, 1.0, 0.0)) == math.inf
