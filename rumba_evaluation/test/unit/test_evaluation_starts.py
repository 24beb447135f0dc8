"""Robots start anywhere on the floor that they can reach, and do not overlap."""

import itertools
import math

import numpy as np
import pytest
from rooms import RADIUS, distances, room

from rumba_evaluation.trials.starts import anywhere
from rumba_sim.model.common.errors import WorldError
from rumba_sim.model.common.geometry import Pose
from rumba_sim.model.settings.robot_config import RobotConfig
from rumba_sim.model.simulation.world import World

ORIGIN = Pose(0.5, 0.5, 0.0)


def drawn(plan, count=1, seed=1):
    """Random poses."""
    return anywhere(plan, RobotConfig(), ORIGIN, count, np.random.default_rng(seed))


def test_robots_fit_where_they_are_put():
    plan = room(3.0, 2.0, boxes=[(1.4, 0.0, 1.6, 1.4)])
    poses = drawn(plan, 8)
    assert (distances(plan, [pose[:2] for pose in poses]) >= RADIUS).all()
    for first, second in itertools.combinations(poses, 2):
        assert math.hypot(first.x - second.x, first.y - second.y) >= 2.0 * RADIUS
    world = World(plan)
    for index, pose in enumerate(poses):
        world.spawn(str(index), pose)


def test_starts_cover_all_of_the_floor_and_all_headings():
    poses = [pose for seed in range(200) for pose in drawn(room(3.0, 1.0), seed=seed)]
    xs, thetas = np.array([pose.x for pose in poses]), np.array([pose.theta for pose in poses])
    assert RADIUS <= xs.min() < 0.35 and 2.65 < xs.max() <= 3.0 - RADIUS
    assert thetas.min() < -3.0 and thetas.max() > 3.0 and abs(thetas.mean()) < 0.4
    assert abs(np.mean(xs) - 1.5) < 0.2


def test_no_robot_starts_where_it_cannot_drive_to_or_over_a_cliff():
    plan = room(4.0, 1.0, boxes=[(2.0, 0.0, 2.1, 1.0)], cliff=(0.8, 0.0, 1.2, 0.4))
    for seed in range(50):
        [pose] = drawn(plan, seed=seed)
        assert pose.x < 2.0 and not (0.8 - RADIUS < pose.x < 1.2 + RADIUS and pose.y < 0.4)


def test_too_many_robots_are_refused():
    with pytest.raises(WorldError, match='room: no room for another robot beside [1-9]'):
        drawn(room(1.0, 1.0), 20)
