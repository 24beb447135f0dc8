"""Trajectories: files of them, and how far one is from another."""

import math
from typing import Dict, List, NamedTuple, Sequence, Tuple

import numpy as np

from rumba_localisation.logs.entry import LogError
from rumba_sim.model.common.geometry import Pose, compose, inverse, wrap_angle
from rumba_sim.model.kernel import Array

Trajectory = Sequence[Tuple[float, Pose]]  # stamps [s] and poses [m, rad]
NEAR = 0.02  # [s] by which stamps of the same pose may differ
WAY = 1.0  # [m] of the reference, over which relative errors are measured


class Errors(NamedTuple):
    """How far a trajectory is from its reference."""

    absolute: float  # [m] RMS of positions, both from the same first pose
    aligned: float  # [m] the same after the best rigid alignment (Sturm et al. 2012, absolute trajectory error)
    largest: float  # [m] of the positions, from the same first pose
    relative: float  # [m] RMS of the errors of movements over WAY (Kuemmerle et al. 2009)
    turn: float  # [rad] the same for their turns
    poses: int  # that were compared


def save(path: str, trajectory: Trajectory) -> None:
    """Write a trajectory in the format of TUM, which `evo` reads: stamp x y z qx qy qz qw.

    Raises:
        LogError: it cannot be written.
    """
    lines = [f'{stamp:.6f} {pose.x:.6f} {pose.y:.6f} 0 0 0 {math.sin(0.5 * pose.theta):.9f} '
             f'{math.cos(0.5 * pose.theta):.9f}\n' for stamp, pose in trajectory]
    try:
        with open(path, 'w', encoding='ascii') as file:
            file.writelines(lines)
    except OSError as error:
        raise LogError(f'{path}: cannot be written: {error.strerror}') from error


def load(path: str) -> List[Tuple[float, Pose]]:
    """Read a trajectory in the format of TUM.

    Raises:
        LogError: it cannot be read, or a line has not eight numbers.
    """
    found = []
    try:
        with open(path, encoding='ascii', errors='replace') as file:
            for number, line in enumerate(file, 1):
                words = line.split('#')[0].split()
                if not words:
                    continue
                try:
                    stamp, x, y, _, qx, qy, qz, qw = map(float, words)
                except ValueError:
                    raise LogError(f'{path}, line {number}: must be eight numbers: stamp x y z qx qy qz qw') from None
                theta = math.atan2(2.0 * (qw * qz + qx * qy), 1.0 - 2.0 * (qy * qy + qz * qz))
                found.append((stamp, Pose(x, y, theta)))
    except OSError as error:
        raise LogError(f'{path}: cannot be read: {error.strerror}') from error
    return found


def compared(trajectory: Trajectory, reference: Trajectory) -> Errors:
    """How far a trajectory is from a reference, at the stamps that both have.

    Raises:
        LogError: they have fewer than two stamps in common.
    """
    pairs = _pairs(trajectory, reference)
    if len(pairs) < 2:
        raise LogError(f'the reference has {len(pairs)} of the stamps of the trajectory: must be two at least')
    first = compose(pairs[0][1], inverse(pairs[0][0]))  # the same first pose
    found = np.array([compose(first, pose)[:2] for pose, _ in pairs])
    true = np.array([pose[:2] for _, pose in pairs])
    away = np.hypot(*(found - true).T)
    moves, turns = _relative(pairs)
    return Errors(_rms(away), _rms(np.hypot(*(_aligned(found, true) - true).T)), float(away.max()), _rms(moves),
                  _rms(turns), len(pairs))


def _pairs(trajectory: Trajectory, reference: Trajectory) -> List[Tuple[Pose, Pose]]:
    """Poses of both with the same stamp."""
    known: Dict[int, Tuple[float, Pose]] = {round(stamp / NEAR): (stamp, pose) for stamp, pose in reference}
    found = []
    for stamp, pose in trajectory:
        near = [known[key] for key in (round(stamp / NEAR) + off for off in (0, -1, 1)) if key in known]
        best = min(near, key=lambda each: abs(each[0] - stamp), default=None)
        if best is not None and abs(best[0] - stamp) <= NEAR:
            found.append((pose, best[1]))
    return found


def _relative(pairs: List[Tuple[Pose, Pose]]) -> Tuple[Array, Array]:
    """Errors of the movements over WAY: of the places [m] and of the turns [rad]."""
    moves, turns, begin = [], [], pairs[0]
    for pair in pairs[1:]:
        true = compose(inverse(begin[1]), pair[1])
        if math.hypot(true.x, true.y) < WAY:
            continue
        error = compose(inverse(true), compose(inverse(begin[0]), pair[0]))
        moves.append(math.hypot(error.x, error.y))
        turns.append(wrap_angle(error.theta))
        begin = pair
    return np.array(moves or [0.0]), np.array(turns or [0.0])


def _aligned(points: Array, others: Array) -> Array:
    """Points (any, 2), moved and turned so that they are as near to others as they can be (Umeyama 1991)."""
    middle, other = points.mean(axis=0), others.mean(axis=0)
    covariance = (points - middle).T @ (others - other)
    angle = math.atan2(covariance[0, 1] - covariance[1, 0], covariance[0, 0] + covariance[1, 1])
    cos, sin = math.cos(angle), math.sin(angle)
    return np.asarray((points - middle) @ np.array([[cos, sin], [-sin, cos]]) + other)


def _rms(numbers: Array) -> float:
    return float(np.sqrt(np.mean(np.square(numbers))))
