"""Particles: how many, which are drawn, and what they say."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rumba_localisation import particles
from rumba_localisation.localiser_config import LocaliserConfig

CONFIG = LocaliserConfig(min_particles=10, max_particles=5000)


@pytest.mark.parametrize('bins, quantile', [(6, 15.086), (11, 23.209), (101, 135.807)])
def test_enough_particles_are_those_of_the_chi_square_distribution(bins, quantile):
    """n = chi-square quantile (99 %, bins - 1) / (2 err): table of any book; the formula approximates it."""
    assert particles.enough(bins, CONFIG) == pytest.approx(quantile / (2.0 * CONFIG.kld_err), rel=0.01)


def test_the_number_of_particles_has_bounds():
    assert particles.enough(1, CONFIG) == 10 and particles.enough(10 ** 6, CONFIG) == 5000


def test_weights_sum_to_one_whatever_their_size():
    assert particles.weights(np.array([-5000.0, -5000.0 + math.log(3.0)])) == pytest.approx([0.25, 0.75])


@pytest.mark.parametrize('share, expected', [([0.25] * 4, 4.0), ([1.0, 0.0], 1.0), ([0.5, 0.25, 0.25], 8.0 / 3.0)])
def test_the_effective_number_of_particles(share, expected):
    assert particles.effective(np.array(share)) == pytest.approx(expected)


def test_drawing_keeps_the_mean_of_the_weights():
    generator = np.random.default_rng(4)
    poses = generator.uniform((0.0, 0.0, -3.0), (8.0, 6.0, 3.0), (400, 3))
    share = particles.weights(-((poses[:, 0] - 2.0) ** 2))
    mean = np.zeros(3)
    for _ in range(30):
        drawn = particles.drawn(poses, share, CONFIG, generator)
        mean += drawn.mean(axis=0) / 30.0
    assert mean == pytest.approx(share @ poses, abs=0.06)
    assert share @ poses != pytest.approx(poses.mean(axis=0), abs=1.0)


def test_fewer_are_drawn_where_all_are_together():
    generator = np.random.default_rng(5)
    apart = generator.uniform((0.0, 0.0, -3.0), (30.0, 30.0, 3.0), (2000, 3))
    together = np.array([3.25, 3.25, 0.1]) + 0.01 * generator.standard_normal((2000, 3))
    share = np.full(2000, 1.0 / 2000.0)
    assert len(particles.drawn(together, share, CONFIG, generator)) == 10
    assert len(particles.drawn(apart, share, CONFIG, generator)) > 1000


@given(st.floats(-math.pi, math.pi))
def test_mean_and_covariance_do_not_depend_on_where_angles_are_cut(middle):
    off = np.array([-0.3, 0.1, 0.2])
    poses = np.stack([[1.0, 2.0, 3.0], [5.0, 5.0, 8.0], middle + off], axis=1)
    mean, covariance = particles.mean_and_covariance(poses, np.array([2.0, 1.0, 1.0]))
    assert mean[:2] == pytest.approx([1.75, 5.75])
    assert particles.wrapped(mean[2] - middle + 0.075) == pytest.approx(0.0, abs=1e-9)
    assert covariance[0, 0] == pytest.approx(0.6875) and covariance[2, 2] == pytest.approx(0.051875 - 0.0)


def test_the_heaviest_cluster_counts_by_weight_not_by_number():
    few, many = np.tile([1.0, 1.0, 3.1], (10, 1)), np.tile([5.0, 1.0, -3.1], (90, 1))
    cluster = particles.heaviest(np.concatenate([few, many]), np.array([0.06] * 10 + [0.4 / 90.0] * 90))
    assert cluster.mean == pytest.approx([1.0, 1.0, 3.1]) and cluster.share == pytest.approx(0.6)
