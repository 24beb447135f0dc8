"""wall_follow keeps the wall to its right, all the way around, and never falls from a cliff."""

import math

import numpy as np
import pytest
from drivers import context_of, run
from rooms import RADIUS, crooked, quiet, room

from rumba_cleaning.behaviour import Status
from rumba_cleaning.control import steps
from rumba_cleaning.strategies.wall_follow import WallFollow
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.simulation.world import World


def following(plan, pose, seconds=400.0):
    """The poses on the way, and the behaviour at its end."""
    world = World(plan, quiet())
    world.spawn('rumba', pose)
    behaviour = WallFollow(context_of(plan, world))
    poses = [observation.pose for observation, _ in steps(behaviour, world, seconds=seconds)]
    return world, behaviour, poses


def test_it_goes_once_around_a_room_near_the_wall():
    plan = room(4.0, 3.0)
    world, behaviour, poses = following(plan, Pose(2.0, 1.5, 0.3))
    assert behaviour.status is Status.SUCCEEDED
    assert behaviour.message.startswith('once around, 1')
    touched = next(index for index, pose in enumerate(poses) if plan.clearance_at(pose.x, pose.y) < RADIUS + 0.02)
    away = [plan.clearance_at(pose.x, pose.y) - RADIUS for pose in poses[touched:]]
    assert np.quantile(away, 0.9) < 0.2
    angles = np.unwrap([math.atan2(pose.y - 1.5, pose.x - 2.0) for pose in poses[touched:]])
    assert angles[-1] - angles[0] == pytest.approx(2.0 * math.pi, abs=0.6)  # counter-clockwise: the wall to the right


def test_it_gets_out_of_corners_and_past_pillars():
    _, behaviour, poses = following(crooked(), Pose(2.0, 1.2, -1.0), 600.0)
    assert behaviour.status is Status.SUCCEEDED
    assert max(pose.x for pose in poses) - min(pose.x for pose in poses) > 2.0


@pytest.mark.parametrize('heading', np.linspace(-3.0, 3.0, 7))
def test_it_does_not_fall_from_a_cliff(heading):
    plan = room(4.0, 3.0, cliff=(1.5, 1.0, 2.5, 2.0), start=Pose(0.5, 0.5, 0.0))
    world, _, _ = following(plan, Pose(1.0, 0.6, heading), 200.0)
    assert not world.robots['rumba'].has_fallen


def test_if_the_wall_ends_it_looks_for_another():
    plan = room(6.0, 4.0)
    world = World(plan, quiet())
    world.spawn('rumba', Pose(0.3, 2.0, math.pi))
    behaviour = WallFollow(context_of(plan, world))
    run(behaviour, world, seconds=3.0)
    world.teleport('rumba', Pose(3.0, 2.0, 0.0))
    run(behaviour, world, seconds=30.0)
    pose = world.robots['rumba'].pose
    assert plan.clearance_at(pose.x, pose.y) < RADIUS + 0.25
