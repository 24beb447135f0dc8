"""Poses that satisfy measurements of one from another as well as possible (a pose graph)."""

from typing import List, NamedTuple, Tuple

import numpy as np
from scipy import sparse
from scipy.sparse import linalg

from rumba_sim.model.kernel import Array

ITERATIONS, CLOSE = 20, 1e-6  # at most, and the largest change [m, rad] after which there is no need for another
DOUBTFUL = 9.0  # squared error in units of its covariance, at which a measurement counts half; as for 3 sigma


class Link(NamedTuple):
    """A measurement: where a pose is in the frame of another."""

    one: int  # index of the pose that defines the frame
    other: int
    measured: Tuple[float, float, float]  # x, y [m], heading [rad]
    information: Array  # float64 (3, 3), inverse of its covariance, in the frame of the one
    is_robust: bool = False  # whether it may be wrong: it counts less the more the others contradict it


def optimised(poses: Array, links: List[Link]) -> Array:
    """Move poses so that the squared errors of all links are least (Gauss-Newton); the first pose stays.

    A Tutorial on Graph-Based SLAM (Grisetti, Kuemmerle, Stachniss, Burgard 2010).

    Args:
        poses: float64 (any, 3) x, y [m], heading [rad].
        links: at least one for each pose but the first, so that all are connected.

    Returns:
        float64 (any, 3)
    """
    one, other = (np.array([link[end] for link in links]) for end in (0, 1))
    measured = np.array([link.measured for link in links])
    information = np.array([link.information for link in links])
    is_robust = np.array([link.is_robust for link in links])
    poses = poses.copy()
    for _ in range(ITERATIONS):
        errors, left, right = _linearised(poses[one], poses[other], measured)
        squares = np.einsum('ki,kij,kj->k', errors, information, errors)
        weights = np.where(is_robust, 1.0 / (1.0 + squares / DOUBTFUL), 1.0)[:, np.newaxis, np.newaxis] * information
        change = _solved(len(poses), one, other, errors, left, right, weights)
        poses -= change
        if np.abs(change).max() < CLOSE:
            break
    return poses


def _linearised(one: Array, other: Array, measured: Array) -> Tuple[Array, Array, Array]:
    """Errors (links, 3), and their derivatives with respect to both poses (links, 3, 3)."""
    cos, sin = np.cos(one[:, 2]), np.sin(one[:, 2])
    by = other - one
    errors = np.stack([cos * by[:, 0] + sin * by[:, 1], cos * by[:, 1] - sin * by[:, 0], by[:, 2]], axis=1) - measured
    errors[:, 2] = (errors[:, 2] + np.pi) % (2.0 * np.pi) - np.pi
    right = np.zeros((len(one), 3, 3))
    right[:, 0, 0], right[:, 0, 1], right[:, 1, 0], right[:, 1, 1], right[:, 2, 2] = cos, sin, -sin, cos, 1.0
    left = -right
    left[:, 0, 2] = cos * by[:, 1] - sin * by[:, 0]
    left[:, 1, 2] = -cos * by[:, 0] - sin * by[:, 1]
    return errors, left, right


def _solved(count: int, one: Array, other: Array, errors: Array, left: Array, right: Array, weights: Array) -> Array:
    """The change (count, 3) that solves the normal equations; 0 for the first pose."""
    ends, sides = (one, other), (left, right)
    blocks, rows, columns = [], [], []
    vector = np.zeros((count, 3))
    for first, side in zip(ends, sides):
        weighted = np.einsum('kji,kjl->kil', side, weights)
        np.add.at(vector, first, np.einsum('kil,kl->ki', weighted, errors))
        for second, beside in zip(ends, sides):
            blocks.append(np.einsum('kil,klj->kij', weighted, beside).ravel())
            rows.append(np.broadcast_to((3 * first[:, None] + np.arange(3))[:, :, None], (len(one), 3, 3)).ravel())
            columns.append(np.broadcast_to((3 * second[:, None] + np.arange(3))[:, None, :], (len(one), 3, 3)).ravel())
    matrix = sparse.csc_matrix((np.concatenate(blocks), (np.concatenate(rows), np.concatenate(columns))),
                               shape=(3 * count, 3 * count))
    change = np.zeros(3 * count)
    change[3:] = linalg.spsolve(matrix[3:, 3:], vector.ravel()[3:])
    return change.reshape(count, 3)
