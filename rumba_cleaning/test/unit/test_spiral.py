"""spiral sweeps a round spot without a gap, and ends if something is in the way."""

import math

import numpy as np
import pytest
from drivers import context_of, drive_by_hand, guarded, run
from rooms import RADIUS, quiet, room

from rumba_cleaning.behaviour import Status
from rumba_cleaning.belief.context import Context
from rumba_cleaning.cleaning_config import CleaningConfig
from rumba_cleaning.edges.guard import Guard
from rumba_cleaning.mission.mission import Mission
from rumba_cleaning.strategies.spiral import SIZE, Spiral
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.kernel.sweeping.samples import PASS
from rumba_sim.model.simulation.world import World

PLAN = room(4.0, 4.0, 0.02)


def spiral(pose):
    """A world after a spiral that began at a pose, and the spiral."""
    world = World(PLAN, quiet())
    world.spawn('rumba', pose)
    behaviour = Spiral(context_of(PLAN, world))
    run(behaviour, world, seconds=120.0)
    return world, behaviour


def assert_has_no_gap(world):
    """All of the spot is swept, but for what is as near to its rim as the last turn may end."""
    swept = world.floor.sweep.samples >= PASS
    y, x = np.indices(swept.shape) * PLAN.sample_pitch
    disc = np.hypot(x - x[swept].mean(), y - y[swept].mean()) < SIZE - 0.15
    assert np.count_nonzero(disc & ~swept) < 0.01 * np.count_nonzero(disc)
    assert world.floor.cleaned_area == pytest.approx(math.pi * SIZE ** 2, rel=0.35)


def test_a_spot_is_swept_without_a_gap():
    world, behaviour = spiral(Pose(2.0, 2.0, 0.0))
    assert behaviour.status is Status.SUCCEEDED
    assert behaviour.message == 'a spot of 1.2 m is swept'
    assert_has_no_gap(world)


def test_slowed_by_the_guard_it_leaves_no_gap_either():
    world = World(PLAN, quiet())
    world.spawn('rumba', Pose(2.0, 2.0, 0.0))
    mine = Context.without_map(world.config, CleaningConfig())
    behaviour = Spiral(mine)
    for _ in guarded(Guard(mine), world, behaviour.step, 120.0):
        if behaviour.status is not Status.RUNNING:
            break
    assert behaviour.message == 'a spot of 1.2 m is swept'
    assert_has_no_gap(world)


def test_it_ends_if_something_is_in_the_way():
    world, behaviour = spiral(Pose(4.0 - RADIUS - 0.2, 2.0, 0.0))
    assert behaviour.status is Status.SUCCEEDED
    assert behaviour.message.startswith('something is in the way 0.')
    assert world.robots['rumba'].bumps == 1


def test_restarted_it_begins_in_the_middle():
    world = World(PLAN, quiet())
    world.spawn('rumba', Pose(2.0, 2.0, 0.0))
    behaviour = Spiral(context_of(PLAN, world))
    run(behaviour, world, seconds=20.0)
    behaviour.restart()
    run(behaviour, world, seconds=1.0)
    assert behaviour.status is Status.RUNNING
    assert abs(world.robots['rumba'].twist.w) > 1.5  # as tight as it can


def test_driven_elsewhere_by_a_person_it_begins_a_new_spot_there():
    world = World(PLAN, quiet())
    world.spawn('rumba', Pose(2.0, 2.0, 0.0))
    behaviour = Spiral(context_of(PLAN, world))
    run(behaviour, world, seconds=20.0)
    drive_by_hand(behaviour, world, 0.2, 0.0, 3.0)
    run(behaviour, world, seconds=1.0)
    assert abs(world.robots['rumba'].twist.w) > 1.5  # as tight as it can
    run(behaviour, world, seconds=120.0)
    assert behaviour.message == 'a spot of 1.2 m is swept'


@pytest.mark.thorough(except_for=['0.4'])
@pytest.mark.parametrize('away', [0.3, 0.4, 0.5])
def test_beside_stairs_it_ends_before_them_and_the_robot_comes_home(away):
    plan = room(4.0, 3.0, 0.02, cliff=(0.0, 2.0, 4.0, 3.0), dock=Pose(4.0 - RADIUS - 0.01, 1.0, 0.0))
    for heading in np.linspace(-3.0, 3.0, 7):
        world = World(plan, quiet())
        world.spawn('rumba', Pose(1.5, 2.0 - away, float(heading)), brushes_up=True)
        behaviour = Mission(context_of(plan, world), 'spiral', 0.99)
        run(behaviour, world)
        assert not world.robots['rumba'].has_fallen and world.robots['rumba'].is_docked
        assert 'something is in the way 0.' in behaviour.message
