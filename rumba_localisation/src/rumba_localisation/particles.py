"""Weighted particles: how many are needed, which are drawn, and what they say."""

import math
from typing import NamedTuple, Tuple

import numpy as np

from rumba_localisation.localiser_config import LocaliserConfig
from rumba_sim.model.kernel import Array

WIDTH, SECTORS = 0.5, 36  # [m] side, and number of sectors of headings, of the bins of the histogram; as in amcl
MOST = 1 << 20  # bins along a side
NEAR = np.array([0.75, 0.5])  # [m], [rad] from the middle of a cluster: particles of the same hypothesis


class Cluster(NamedTuple):
    """Particles of one hypothesis."""

    mean: Array  # float64 (3) [m, m, rad]
    covariance: Array  # float64 (3, 3)
    share: float  # [0..1] of the weight of all


def weights(logarithms: Array) -> Array:
    """Weights that sum to 1, from their logarithms."""
    found = np.exp(logarithms - logarithms.max())
    return np.asarray(found / found.sum())


def effective(share: Array) -> float:
    """Number of particles of equal weight that would say as much (Kong, Liu, Wong 1994)."""
    return float(1.0 / np.sum(share ** 2))


def enough(bins: int, config: LocaliserConfig) -> int:
    """How many particles are enough if they fill so many bins of the histogram (Fox 2003, equation 13)."""
    if bins < 2:
        return config.min_particles
    spread = 2.0 / (9.0 * (bins - 1))
    needed = (bins - 1) / (2.0 * config.kld_err) * (1.0 - spread + math.sqrt(spread) * config.kld_z) ** 3
    return int(min(max(needed, config.min_particles), config.max_particles))


def drawn(poses: Array, share: Array, config: LocaliserConfig, generator: np.random.Generator) -> Array:
    """Draw particles by their weights until there are enough for the bins that they fill (KLD-sampling, Fox 2003).

    Args:
        poses: float64 (any, 3).
        share: float64 (any), weights, sum 1.

    Returns:
        float64 (between min_particles and max_particles, 3), of equal weight.
    """
    ends, count, needed = np.cumsum(share)[:-1], 0, config.min_particles
    chosen = np.empty(0, np.int64)
    while count < needed:
        more = np.searchsorted(ends, generator.random(needed - count), side='right')
        chosen = np.concatenate([chosen, more])
        count, needed = len(chosen), enough(len(np.unique(bins_of(poses[chosen]))), config)
    return np.asarray(poses[chosen])


def bins_of(poses: Array) -> Array:
    """Number of the bin of the histogram in which each pose lies: int64 (any)."""
    across = np.floor(poses[:, :2] / WIDTH).astype(np.int64) % MOST
    turned = np.floor(np.mod(poses[:, 2], 2.0 * math.pi) / (2.0 * math.pi / SECTORS)).astype(np.int64)
    return np.asarray((across[:, 0] * MOST + across[:, 1]) * SECTORS + turned)


def heaviest(poses: Array, share: Array) -> Cluster:
    """The cluster around the bin with the largest weight."""
    mean, covariance = mean_and_covariance(poses, share)
    if _are_near(poses, mean, 0.5).all():  # then they are near each other, and the mean of any bin is near them all
        return Cluster(mean, covariance, float(share.sum()))
    _, where = np.unique(bins_of(poses), return_inverse=True)
    is_best = where == np.argmax(np.bincount(where, weights=share))
    middle, _ = mean_and_covariance(poses[is_best], share[is_best])
    is_near = _are_near(poses, middle, 1.0)
    return Cluster(*mean_and_covariance(poses[is_near], share[is_near]), float(share[is_near].sum()))


def _are_near(poses: Array, middle: Array, scale: float) -> Array:
    """Which poses are within NEAR, times a scale, of the middle of a cluster: bool (any)."""
    off = np.abs(wrapped(poses[:, 2] - middle[2]))
    return np.asarray(
        (np.hypot(poses[:, 0] - middle[0], poses[:, 1] - middle[1]) < scale * NEAR[0]) & (off < scale * NEAR[1]))


def mean_and_covariance(poses: Array, share: Array) -> Tuple[Array, Array]:
    """Weighted mean (3) and covariance (3, 3) of poses that are close to one another."""
    share = share / share.sum()
    first = poses[np.argmax(share), 2]
    flat = np.concatenate([poses[:, :2], wrapped(poses[:, 2:] - first)], axis=1)
    mean = share @ flat
    apart = flat - mean
    covariance = (apart * share[:, None]).T @ apart
    mean[2] = wrapped(mean[2] + first)
    return mean, covariance


def wrapped(angles: Array) -> Array:
    """The same directions in [-pi, pi)."""
    return np.mod(angles + math.pi, 2.0 * math.pi) - math.pi
