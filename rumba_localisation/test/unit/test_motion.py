"""Particles follow the odometry, with the errors of the motion model."""

import math

import numpy as np
import pytest

from rumba_localisation.localiser_config import LocaliserConfig
from rumba_localisation.motion import moved, noise
from rumba_sim.model.common.geometry import Pose

EXACT = LocaliserConfig(odom_alpha1=0.0, odom_alpha2=0.0, odom_alpha3=0.0, odom_alpha4=0.0)
HERE = np.array([[2.0, 1.0, 0.5 * math.pi]])


@pytest.mark.parametrize('after, expected', [
    (Pose(1.0, 0.0, 0.0), (2.0, 2.0, 0.5 * math.pi)), (Pose(-0.5, 0.0, 0.0), (2.0, 0.5, 0.5 * math.pi)),
    (Pose(0.3, 0.4, 0.2), (1.6, 1.3, 0.5 * math.pi + 0.2)), (Pose(0.0, 0.0, -1.0), (2.0, 1.0, 0.5 * math.pi - 1.0)),
    (Pose(-0.3, 0.1, 0.4), (1.9, 0.7, 0.5 * math.pi + 0.4))])
def test_without_errors_a_particle_moves_as_the_odometry(after, expected):
    found = moved(HERE, Pose(0.0, 0.0, 0.0), after, EXACT, noise(1, np.random.default_rng(1)))
    assert found[0] == pytest.approx(expected)


@pytest.mark.parametrize('config, after, spread', [
    ({'odom_alpha1': 0.04}, Pose(0.0, 0.0, 1.0), (0.0, 0.0, 0.2 / math.sqrt(2.0))),
    ({'odom_alpha2': 0.04}, Pose(1.0, 0.0, 0.0), (0.2 / math.sqrt(2.0), 0.0, 0.2)),
    ({'odom_alpha3': 0.01}, Pose(0.5, 0.0, 0.0), (0.0, 0.05, 0.0)),
    ({'odom_alpha4': 0.01}, Pose(0.0, 0.0, 1.0), (0.0, 0.1 / math.sqrt(2.0), 0.0))])
def test_each_error_spreads_the_particles_as_it_says(config, after, spread):
    exact = {f'odom_alpha{number}': 0.0 for number in (1, 2, 3, 4)}
    found = moved(np.tile(HERE, (40000, 1)), Pose(0.0, 0.0, 0.0), after, LocaliserConfig(**{**exact, **config}),
                  noise(40000, np.random.default_rng(2)))
    ahead = found if after.theta == 0.0 else _along_first_turn(found, 0.5 * after.theta)
    assert ahead.std(axis=0) == pytest.approx(spread, abs=0.016)


def test_with_the_same_errors_a_way_in_parts_is_as_uncertain_as_the_whole():
    config, errors = LocaliserConfig(), noise(4000, np.random.default_rng(3))
    far = moved(np.tile(HERE, (4000, 1)), Pose(0.0, 0.0, 0.0), Pose(2.0, 0.0, 0.0), config, errors)
    near = np.tile(HERE, (4000, 1))
    for number in range(20):
        near = moved(near, Pose(0.1 * number, 0.0, 0.0), Pose(0.1 * number + 0.1, 0.0, 0.0), config, errors)
    assert near[:, 2].std() == pytest.approx(far[:, 2].std())
    assert near[:, 2].std() == pytest.approx(2.0 * math.sqrt(config.odom_alpha2), rel=0.05)


def _along_first_turn(poses, turn):
    """Positions in a frame whose y axis is the direction in which a turning robot would move."""
    off = poses[:, :2] - HERE[0, :2]
    cos, sin = math.cos(turn), math.sin(turn)
    return np.stack([cos * off[:, 0] + sin * off[:, 1], -sin * off[:, 0] + cos * off[:, 1], poses[:, 2]], axis=1)
